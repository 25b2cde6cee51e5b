//@pass ground_blockers "Ground: blockers" draw=model size=128x128 format=rg32f mips doc="Red: 1 under a surface; green: the height of the lowest one over the ground, in widths of the ground"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "lighting/shadows/ground.glsl"
#include "material/opaque.glsl"

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    discard_see_through(fragment);
    color = vec4(1.0, (fragment.position_ws.y - ground_height()) / ground_width(), 0.0, 1.0);
}
