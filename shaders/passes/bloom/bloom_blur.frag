//@pass bloom_blur "Bloom: blur" size=1/8 when=BLOOM doc="Mean of ever wider blurs of the light"
#version 460
#include "pass.glsl"
#include "passes/bloom/levels.glsl"

uniform sampler2D bloom_wide;

void main() {
    int coarsest = coarsest_level();
    vec3 sum = float(max(coarsest - 2, 0)) * textureLod(bloom_wide, uv, 0.0).rgb;
    for (int level = 1; level <= min(coarsest, 2); ++level) sum += tent_filtered(uv, level);
    color = vec4(sum / float(coarsest), 1.0);
}
