//@pass normals "Normals" draw=model to=picture doc="The normal of each vertex as a line"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

// The direction as a color, as it is exposed, whatever the exposure is.
void main() { color = vec4((0.5 + 0.5 * normalize(fragment.normal_ws)) / frame.exposure, 1.0); }
