//@pass ground_blockers "Ground: blockers" draw=model size=128x128 format=r32f doc="Height of the lowest surface over the ground: 1 at the ground, 0 where there is none"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "lighting/shadows/ground.glsl"

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    if (ALPHA_MODE == ALPHA_BLEND || (FEATURES & FEATURE_TRANSMISSION) != 0u) discard;
    color = vec4(1.0 - (fragment.position_ws.y - ground_height()) / ground_width(), 0.0, 0.0, 1.0);
}
