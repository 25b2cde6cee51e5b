//@pass bloom_wide "Bloom: wide blur" size=1/32 when=BLOOM doc="Mean of the blurs of mip level 3 and above"
#version 460
#include "pass.glsl"
#include "passes/bloom/levels.glsl"

// The part of the bloom that is wide, at a low resolution. bloom.frag adds the narrower levels; common/bloom.glsl has the limits.

void main() {
    int coarsest = coarsest_level();
    vec3 sum = vec3(0.0);
    for (int level = 3; level <= min(coarsest, 12); ++level) sum += tent_filtered(uv, level);
    color = vec4(sum / float(max(coarsest - 2, 1)), 1.0);
}
