//@pass meshlets "Meshlets" draw=model to=picture cull=none doc="The model in groups of 32 triangles, which leave it one after the other"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

// The color of the group, brighter where the surface faces the eye. As it is exposed, whatever the exposure is.
void main() {
    float facing = abs(dot(normalize(fragment.normal_ws), normalize(fragment.to_eye_ws)));
    color = vec4(fragment.color.rgb * (0.3 + 0.7 * facing) / frame.exposure, 1.0);
}
