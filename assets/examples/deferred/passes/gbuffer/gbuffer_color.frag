//@pass gbuffer_color "G-buffer: base color, metallic" draw=model format=rgba16f doc="Base color (linear RGB) and metallic (alpha) of the nearest surface"
#version 460
#include "passes/gbuffer/gbuffer.glsl"

// rgb: linear base color. a: metallic, 0 dielectric .. 1 metal.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(0.0);
    if (!is_deferred()) return;
    Surface s = gbuffer_surface(fragment);
    color = vec4(s.base_color, s.metallic);
}
