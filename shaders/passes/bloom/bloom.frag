//@pass bloom "Bloom" size=1/8 when=BLOOM doc="Mean of ever wider blurs of the light"
#version 460
#include "pass.glsl"
#include "passes/bloom/levels.glsl"

// The mean of blurs of the light, each twice as wide as the one before (Jimenez 2014). common/bloom.glsl adds it to the picture, and has its
// limits.

uniform sampler2D bloom_wide;

void main() {
    int coarsest = coarsest_level();
    vec3 sum = float(max(coarsest - 2, 0)) * textureLod(bloom_wide, uv, 0.0).rgb;
    for (int level = 1; level <= min(coarsest, 2); ++level) sum += tent_filtered(uv, level);
    color = vec4(sum / float(coarsest), 1.0);
}
