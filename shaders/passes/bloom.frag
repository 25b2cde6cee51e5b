//@pass bloom "Bloom" to=picture off doc="Light that a lens scatters around what is bright: a mean of ever wider blurs"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "common/pixel.glsl"

// A lens scatters a part of all light, so no threshold is needed: the picture is mixed with blurs of itself, and its mean stays the
// same (Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare").

uniform sampler2D picture;
uniform sampler2D bloom_blur;

uniform Bloom {
    float bloom_strength;      //@ui "Bloom" 0..1 = 0.12
};

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec3 blur = bloom_strength * texture(bloom_blur, uv).rgb;
    color.rgb = scene.rgb * (1.0 - bloom_strength) + blur / frame.exposure;
    // Beside the model, scattered light hides the background as far as it is bright. The flags of alpha stay.
    float cover = saturate(max(blur.r, max(blur.g, blur.b)));
    color.a = scene.a + max(cover - coverage_of(scene.a), 0.0);
}
