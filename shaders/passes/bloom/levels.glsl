// The mip levels of bloom_light.frag: the first `bloom_levels` after level 0 are blurred, and their mean is the bloom.
#ifndef BLOOM_LEVELS_GLSL
#define BLOOM_LEVELS_GLSL

#include "user/params.glsl"

uniform sampler2D bloom_light;

// The last level that counts, at least 1. Small pictures have fewer.
int last_level() { return clamp(bloom_levels, 1, max(textureQueryLevels(bloom_light) - 1, 1)); }

// A level under a tent of 3 x 3 texels, weights 1 2 1, which hides its texels (Jimenez 2014, "Next Generation Post Processing in
// Call of Duty: Advanced Warfare"). Four blended texels at half a texel's distance have these weights. `uv`: 0..1 in the image.
vec3 under_tent(vec2 uv, int level) {
    vec2 half_texel = 0.5 / vec2(textureSize(bloom_light, level));
    float lod = float(level);
    vec3 sum = textureLod(bloom_light, uv - half_texel, lod).rgb + textureLod(bloom_light, uv + half_texel, lod).rgb;
    half_texel.x = -half_texel.x;
    sum += textureLod(bloom_light, uv - half_texel, lod).rgb + textureLod(bloom_light, uv + half_texel, lod).rgb;
    return 0.25 * sum;
}

#endif
