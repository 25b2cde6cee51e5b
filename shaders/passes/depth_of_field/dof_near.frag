//@pass dof_near "Depth of field: foreground" size=1/2 doc="Blurred light of what is in front of the focus, times its opacity, and opacity"
#version 460
#include "pass.glsl"
#include "lens.glsl"

uniform sampler2D dof_near_raw;

// A tent of 3 x 3 texels, which hides the samples' noise: see passes/bloom/levels.glsl.
vec4 smoothed() {
    vec2 offset = 0.5 / vec2(textureSize(dof_near_raw, 0));
    vec4 sum = texture(dof_near_raw, uv - offset) + texture(dof_near_raw, uv + offset);
    offset.x = -offset.x;
    return 0.25 * (sum + texture(dof_near_raw, uv - offset) + texture(dof_near_raw, uv + offset));
}

void main() { color = smoothed(); }
