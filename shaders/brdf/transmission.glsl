// Light that enters the surface and leaves it on the other side: l and v see different faces.
#ifndef BRDF_TRANSMISSION_GLSL
#define BRDF_TRANSMISSION_GLSL

#include "brdf/ndf.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

// A wall with two faces close together bends no ray, but the facets of both do. Facets of an index of 1 bend nothing,
// those of 1.5 as much as they reflect: KHR_materials_transmission leaves how much open, and this line through both is
// that of Khronos's glTF Sample Renderer (applyIorToRoughness). ior 0: infinite.
float transmission_roughness(float roughness, float ior) {
    return ior > 0.0 ? roughness * saturate(2.0 * ior - 2.0) : roughness;
}

// The l of a light behind the surface, mirrored into the half space of v: there the lobe that passes through is the one
// that would be reflected, and F has its h (KHR_materials_transmission). In front, l itself.
vec3 unfolded(vec3 n, vec3 l) { return l - 2.0 * min(dot(n, l), 0.0) * n; }

// f = (1 - F) D V base_color with h = (v + l') / |v + l'|, l' the mirrored l (KHR_materials_transmission, specular BTDF).
// f_dielectric: F at v . h; of a color the largest component counts (KHR_materials_specular).
//
// Volumes refract (lighting/transmission.glsl); the light of a lamp inside or behind them is taken as through a wall.
vec3 f_transmitted(Surface s, float n_dot_l, float n_dot_v, float n_dot_h, float sin2_h, vec3 f_dielectric) {
    float alpha = alpha_from_roughness(transmission_roughness(s.roughness, s.ior));
    float lobe = d_specular(n_dot_h, sin2_h, alpha) * v_specular(n_dot_l, n_dot_v, alpha);
    return s.base_color * ((1.0 - max_component(f_dielectric)) * lobe);
}

#endif
