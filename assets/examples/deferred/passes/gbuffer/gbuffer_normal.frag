//@pass gbuffer_normal "G-buffer: normal, roughness" draw=model format=rgba16f doc="World-space shading normal and perceptual roughness (alpha) of the nearest surface"
#version 460
#include "passes/gbuffer/gbuffer.glsl"

// rgb: shading normal, world space, unit; 0 where there is no surface that the lighting pass can light. a: perceptual roughness.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(0.0);
    if (!is_deferred()) return;
    Surface s = gbuffer_surface(fragment);
    color = vec4(s.n, s.roughness);
}
