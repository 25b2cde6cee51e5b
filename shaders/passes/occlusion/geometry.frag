//@pass geometry "Normals and distance" draw=model size=1/2 format=rgba32f when=AMBIENT_OCCLUSION doc="World-space normal of the surface, and its distance along the camera's axis"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/material.glsl"

// rgb: normal, world space, unit, towards the eye. a: meters along the camera's axis; 0 where there is nothing.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    if (ALPHA_MODE == ALPHA_BLEND) discard;
    if (ALPHA_MODE == ALPHA_MASK) {
        Surface surface = make_surface(fragment, safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0)));
        if (surface.coverage < material.alpha_cutoff) discard;
    }
    // Without normal maps: what hides the sky is the geometry. A mesh without normals has those of its facets.
    vec3 facet = safe_normalize(cross(dFdy(fragment.position_ws), dFdx(fragment.position_ws)), vec3(0.0));
    vec3 n = safe_normalize(fragment.normal_ws, facet);
    n = dot(n, fragment.to_eye_ws) < 0.0 ? -n : n;
    float distance_m = -(frame.view_from_world * vec4(fragment.position_ws, 1.0)).z;
    color = vec4(n, distance_m);
}
