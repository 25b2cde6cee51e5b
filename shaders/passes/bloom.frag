//@pass bloom "Bloom" to=picture off doc="Light that a lens scatters around what is bright: a mean of ever wider blurs"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "common/pixel.glsl"

// A lens scatters a part of all light, so no threshold is needed: the picture is mixed with blurs of itself, and its mean
// stays the same (Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare").

uniform sampler2D picture;
uniform sampler2D bloom_source;

uniform Bloom {
    float bloom_strength;      //@ui "Bloom" 0..1 = 0.12
    int bloom_levels;          //@ui "Bloom width" 2..8 = 6
};

// A level of the blur. A tent filter of 3 x 3 texels, weights 1 2 1, hides the texels of the level (Jimenez 2014).
vec3 blurred(int level) {
    vec2 texel = 1.0 / vec2(textureSize(bloom_source, level));
    vec3 sum = vec3(0.0);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            float weight = float((2 - abs(x)) * (2 - abs(y))) / 16.0;
            sum += weight * textureLod(bloom_source, uv + vec2(x, y) * texel, float(level)).rgb;
        }
    }
    return sum;
}

void main() {
    vec4 scene = texture(picture, uv);
    int levels = clamp(bloom_levels, 1, textureQueryLevels(bloom_source));
    vec3 blur = vec3(0.0);
    for (int level = 0; level < min(levels, 12); ++level) blur += blurred(level);
    blur *= bloom_strength / float(levels);
    color.rgb = scene.rgb * (1.0 - bloom_strength) + blur / frame.exposure;
    // Outside the model, scattered light covers the background in proportion to its brightness. Alpha's flags stay.
    float cover = saturate(max(blur.r, max(blur.g, blur.b)));
    color.a = scene.a + max(cover - coverage_of(scene.a), 0.0);
}
