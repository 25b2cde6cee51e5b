//@pass gbuffer_emission "G-buffer: emission, occlusion" draw=model format=rgba16f doc="Emitted radiance in cd/m^2 and baked occlusion (alpha) of the nearest surface"
#version 460
#include "passes/gbuffer/gbuffer.glsl"

// rgb: emitted radiance, cd/m^2. a: occlusion of the texture, 1 unoccluded.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(0.0);
    if (!is_deferred()) return;
    Surface s = gbuffer_surface(fragment);
    color = vec4(s.emissive, s.occlusion);
}
