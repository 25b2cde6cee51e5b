//@pass gbuffer_distance "G-buffer: distance, index of refraction" draw=model format=rg32f doc="Meters from the eye, and the index of refraction (green) of the nearest surface"
#version 460
#include "passes/gbuffer/gbuffer.glsl"

// r: meters from the eye, of which the lighting pass computes the position. g: index of refraction of the dielectric.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(0.0);
    if (!is_deferred()) return;
    Surface s = gbuffer_surface(fragment);
    color = vec4(length(fragment.to_eye_ws), s.ior, 0.0, 0.0);
}
