// The mip levels of bloom_light.frag. Levels 1 to `bloom_levels` are blurred, and their mean is the bloom.
#ifndef BLOOM_LEVELS_GLSL
#define BLOOM_LEVELS_GLSL

#include "user/params.glsl"

uniform sampler2D bloom_light;

// The coarsest level of the bloom. Small pictures have fewer levels, but at least 1 counts.
int coarsest_level() { return clamp(bloom_levels, 1, max(textureQueryLevels(bloom_light) - 1, 1)); }

// A level, filtered by a tent of 3 x 3 texels with the weights 1 2 1, which hides its texels (Jimenez 2014, "Next Generation Post
// Processing in Call of Duty: Advanced Warfare"). Four bilinear samples at half a texel's distance have these weights. `uv`: 0..1 in the
// image.
vec3 tent_filtered(vec2 uv, int level) {
    // The image of a very small picture has level 0 only.
    int last = min(level, textureQueryLevels(bloom_light) - 1);
    vec2 half_texel = 0.5 / vec2(textureSize(bloom_light, last));
    float lod = float(last);
    vec3 sum = textureLod(bloom_light, uv - half_texel, lod).rgb + textureLod(bloom_light, uv + half_texel, lod).rgb;
    half_texel.x = -half_texel.x;
    sum += textureLod(bloom_light, uv - half_texel, lod).rgb + textureLod(bloom_light, uv + half_texel, lod).rgb;
    return 0.25 * sum;
}

#endif
