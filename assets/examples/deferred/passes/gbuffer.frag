//@pass gbuffer "G-buffer: base color, metallic" draw=model also=gbuffer_normal,gbuffer_emission,gbuffer_distance:rgba32f doc="The material of the nearest surface: base color (linear RGB) and metallic (alpha), and three images more"
#version 460
#include "ibl/maps/octahedral.glsl"
#include "passes/gbuffer.glsl"

// The material of the nearest surface in four images at once.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;             // rgb: linear base color. a: metallic, 0 dielectric .. 1 metal
layout(location = 1) out vec4 gbuffer_normal;    // rgb: shading normal, world space, unit; 0 where the lighting pass has nothing to light. a: perceptual roughness
layout(location = 2) out vec4 gbuffer_emission;  // rgb: emitted radiance, cd/m^2. a: occlusion of the texture, 1 unoccluded
layout(location = 3) out vec4 gbuffer_distance;  // r: meters from the eye, of which the lighting pass computes the position. g: index of refraction. ba: geometric normal, octahedral

void main() {
    color = vec4(0.0);
    gbuffer_normal = vec4(0.0);
    gbuffer_emission = vec4(0.0);
    gbuffer_distance = vec4(0.0);
    if (!is_deferred()) return;
    Surface s = gbuffer_surface(fragment);
    color = vec4(s.base_color, s.metallic);
    gbuffer_normal = vec4(s.n, s.roughness);
    gbuffer_emission = vec4(s.emissive, s.occlusion);
    gbuffer_distance = vec4(length(fragment.to_eye_ws), s.ior, octahedral_point(s.ng));
}
