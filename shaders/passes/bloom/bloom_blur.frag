//@pass bloom_blur "Bloom: blur" size=1/8 when=BLOOM doc="Mean of ever wider blurs of the light"
#version 460
#include "pass.glsl"

uniform sampler2D bloom_light;

uniform BloomBlur {
    int bloom_levels;          //@ui "Bloom width" 2..8 = 5
};

// A level of the light under a tent of 3 x 3 texels, weights 1 2 1, which hides its texels (Jimenez 2014, "Next Generation Post
// Processing in Call of Duty: Advanced Warfare"). Four blended texels at half a texel's distance have these weights.
vec3 blurred(float level) {
    vec2 half_texel = 0.5 * exp2(level) / vec2(textureSize(bloom_light, 0));
    vec3 sum = textureLod(bloom_light, uv - half_texel, level).rgb + textureLod(bloom_light, uv + half_texel, level).rgb;
    half_texel.x = -half_texel.x;
    sum += textureLod(bloom_light, uv - half_texel, level).rgb + textureLod(bloom_light, uv + half_texel, level).rgb;
    return 0.25 * sum;
}

void main() {
    int levels = clamp(bloom_levels, 1, textureQueryLevels(bloom_light) - 1);
    vec3 sum = vec3(0.0);
    for (int level = 1; level <= min(levels, 12); ++level) sum += blurred(float(level));
    color = vec4(sum / float(levels), 1.0);
}
