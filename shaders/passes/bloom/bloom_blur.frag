//@pass bloom_blur "Bloom: blur" size=1/8 when=BLOOM doc="Mean of ever wider blurs of the light"
#version 460
#include "pass.glsl"
#include "passes/bloom/levels.glsl"

uniform sampler2D bloom_wide;

void main() {
    int last = last_level();
    vec3 sum = float(max(last - 2, 0)) * textureLod(bloom_wide, uv, 0.0).rgb;
    for (int level = 1; level <= min(last, 2); ++level) sum += under_tent(uv, level);
    color = vec4(sum / float(last), 1.0);
}
