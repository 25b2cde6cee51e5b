// Transmission through the surface: l and v are on opposite sides.
#ifndef BRDF_LAYERS_TRANSMISSION_GLSL
#define BRDF_LAYERS_TRANSMISSION_GLSL

#include "brdf/energy/albedo.glsl"
#include "brdf/models.glsl"
#include "brdf/ndf.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

// A thin wall does not deflect the mean ray, but the facets of both faces scatter it. With index 1 they do not deflect
// light at all; with 1.5 they scatter as much as in reflection. KHR_materials_transmission does not specify the amount.
// This line through both points is that of Khronos's glTF Sample Renderer (applyIorToRoughness). ior 0: infinite.
float transmission_roughness(float roughness, float ior) {
    return ior > 0.0 ? roughness * saturate(2.0 * ior - 2.0) : roughness;
}

// f = (1 - F) D V base_color with h = (v + l') / |v + l'|, l' the l of a light behind the surface, mirrored into the
// hemisphere of v (mirrored_to_front; KHR_materials_transmission, specular BTDF). f_dielectric: F at v . h. A colored F counts by its largest component (KHR_materials_specular).
//
// With multiple scattering, light that the lobe loses between the facets is transmitted in the end, so the lobe is divided
// by its albedo for F = 1, towards v (as Turquin 2019, "Practical multiple scattering compensation for microfacet models",
// scales reflections). Without, it is lost, as in glTF. 1e-3: a D of 0. What is seen through the surface
// keeps as much (lighting/albedo.glsl).
//
// Volumes refract what is seen through them (lighting/transmission.glsl), but light from a source inside or behind a
// volume is transmitted as through a thin wall.
vec3 f_transmitted(Surface s, float n_dot_l, float n_dot_v, float n_dot_h, float sin2_h, vec3 f_dielectric) {
    float roughness = transmission_roughness(s.roughness, s.ior);
    float alpha = alpha_from_roughness(roughness);
    float lobe = d_specular(n_dot_h, sin2_h, alpha) * v_specular(n_dot_l, n_dot_v, alpha);
    if (MULTI_SCATTER != SINGLE_SCATTER) lobe /= max(dfg_at(n_dot_v, roughness).e, 1e-3);
    return s.base_color * ((1.0 - max_component(f_dielectric)) * lobe);
}

#endif
