//@pass dof_far "Depth of field: background" size=1/2 doc="Blurred light of what is not in front of the focus, and coverage"
#version 460
#include "pass.glsl"
#include "lens.glsl"

uniform sampler2D dof_far_raw;

// A tent of 3 x 3 texels, which hides the samples' noise: see passes/bloom/levels.glsl.
vec4 smoothed() {
    vec2 offset = 0.5 / vec2(textureSize(dof_far_raw, 0));
    vec4 sum = texture(dof_far_raw, uv - offset) + texture(dof_far_raw, uv + offset);
    offset.x = -offset.x;
    return 0.25 * (sum + texture(dof_far_raw, uv - offset) + texture(dof_far_raw, uv + offset));
}

void main() { color = smoothed(); }
