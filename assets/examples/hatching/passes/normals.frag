//@pass normals "Normals" draw=model format=rgba16f doc="World-space normals of the model"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/opaque.glsl"

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    discard_holes(fragment);
    color = vec4(safe_normalize(fragment.normal_ws, vec3(0.0)), 1.0);
}
