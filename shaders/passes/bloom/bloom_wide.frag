//@pass bloom_wide "Bloom: wide blur" size=1/32 when=BLOOM doc="Mean of the blurs that need no more texels than this"
#version 460
#include "pass.glsl"
#include "passes/bloom/levels.glsl"

// The third and all further levels of the light.

void main() {
    int last = last_level();
    vec3 sum = vec3(0.0);
    for (int level = 3; level <= min(last, 12); ++level) sum += under_tent(uv, level);
    color = vec4(sum / float(max(last - 2, 1)), 1.0);
}
