//@pass geometry "Distance" draw=model size=1/2 format=r32f when=AMBIENT_OCCLUSION doc="Distance of the surface along the camera's axis, meters"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "material/opaque.glsl"

// Meters along the camera's axis; 0 where there is nothing, or where light passes through (material/opaque.glsl).

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    discard_see_through(fragment);
    // gl_FragCoord.w is 1 / w, and w is the distance.
    color = vec4(1.0 / gl_FragCoord.w, 0.0, 0.0, 0.0);
}
