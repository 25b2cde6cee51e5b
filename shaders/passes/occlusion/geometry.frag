//@pass geometry "Distance" draw=model size=1/2 format=r32f when=AMBIENT_OCCLUSION doc="Distance of the surface along the camera's axis, meters"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/material.glsl"

// Meters along the camera's axis; 0 where there is nothing.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    if (ALPHA_MODE == ALPHA_BLEND) discard;
    if (ALPHA_MODE == ALPHA_MASK) {
        Surface surface = make_surface(fragment, safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0)));
        if (surface.coverage < material.alpha_cutoff) discard;
    }
    // gl_FragCoord.w is 1 / w, and w is the distance.
    color = vec4(1.0 / gl_FragCoord.w, 0.0, 0.0, 0.0);
}
