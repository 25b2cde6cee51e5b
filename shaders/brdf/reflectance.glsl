// F of a Surface: of its dielectric and its metal, by the selected equations, with the thin film.
#ifndef BRDF_REFLECTANCE_GLSL
#define BRDF_REFLECTANCE_GLSL

#include "interface.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/layers/iridescence.glsl"
#include "brdf/models.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"

// Edge tint for metals whose n and k are not given (see complex_ior).
const vec3 EDGE_TINT = vec3(0.5);

const bool HAS_FILM = (FEATURES & FEATURE_IRIDESCENCE) != 0u;

// Whether the tables take F by its samples (brdf/energy/dfg.glsl), since it is not f_schlick.
const bool DIELECTRIC_IS_SAMPLED = FRESNEL_DIELECTRIC != SCHLICK_DIELECTRIC || HAS_FILM;
const bool METAL_IS_SAMPLED = FRESNEL_METAL != SCHLICK_METAL || HAS_FILM;
const bool F_IS_SAMPLED = DIELECTRIC_IS_SAMPLED || METAL_IS_SAMPLED;

// How far the exact F (Walter et al. 2007, eq. 22) has risen from F0 to 1: (F(c) - F(1)) / (1 - F(1)). It replaces (1 - c)^5 in
// Schlick 1994, eq. 15, so that KHR_materials_specular's color and factor keep their meaning. c = 1 -> 0, c = 0 -> 1.
//
// The index is the one that has the surface's F0, its largest component, before the specular factor. It is s.ior where
// the color is white. Materials converted from specular-glossiness have an infinite ior and give F0 by the color; F of
// that ior is 1 at all angles and has no rise. No finite index has F0 = 1, so F0 is limited to 0.999. 1e-4: a factor of 0.
float exact_rise(Surface s, float c) {
    float f0 = min(max_component(s.f0) / max(s.f90, 1e-4), 0.999);
    return saturate((f_dielectric_exact(ior_from_f0(f0), c) - f0) / (1.0 - f0));
}

// F of the thin film over a base of reflectance f0. Under a clear coat, the medium above the film is the coat, with an
// index of 1.5 (KHR_materials_iridescence, "Clearcoat"); a partial coat counts as an index in between.
vec3 film_fresnel(Surface s, vec3 f0, float c) {
    float outside = (FEATURES & FEATURE_CLEARCOAT) != 0u ? mix(1.0, 1.5, s.clearcoat) : 1.0;
    return f_film(f0, s.iridescence_ior, s.iridescence_nm, outside, c);
}

// F of the dielectric: F0 + (F90 - F0) rise (KHR_materials_specular), with the film's F mixed in by its factor
// (KHR_materials_iridescence).
vec3 dielectric_fresnel(Surface s, float c) {
    vec3 f90 = vec3(s.f90);
    vec3 fresnel = FRESNEL_DIELECTRIC == EXACT_DIELECTRIC ? mix(s.f0, f90, exact_rise(s, c)) : f_schlick(s.f0, f90, c);
    if (HAS_FILM) fresnel = mix(fresnel, film_fresnel(s, s.f0, c), s.iridescence);
    return fresnel;
}

// n and k of the metal: the model's, or those that its color gives (Gulbrandsen 2014).
void metal_ior(Surface s, out vec3 n, out vec3 k) {
    n = s.conductor_n;
    k = s.conductor_k;
    if ((FEATURES & FEATURE_CONDUCTOR) == 0u) complex_ior(s.base_color, EDGE_TINT, n, k);
}

// Reflectance of the metal at normal incidence: the base color (glTF 2.0, appendix B.3.1), or F(1) of n and k (Born & Wolf 1999,
// section 14.4).
vec3 metal_f0(Surface s) {
    if (FRESNEL_METAL == SCHLICK_METAL) return s.base_color;
    vec3 n, k;
    metal_ior(s, n, k);
    return f_conductor(n, k, 1.0);
}

// F of the metal by the selected equation (brdf/fresnel.glsl has the sources), with the film's mixed in.
vec3 metal_fresnel(Surface s, float c) {
    vec3 f0 = metal_f0(s);
    vec3 fresnel;
    if (FRESNEL_METAL == SCHLICK_METAL) {
        fresnel = f_schlick(f0, vec3(1.0), c);
    } else {
        vec3 n, k;
        metal_ior(s, n, k);
        fresnel = FRESNEL_METAL == F82_METAL ? f_82(f0, f_conductor(n, k, COS_82), c) : f_conductor(n, k, c);
    }
    if (HAS_FILM) fresnel = mix(fresnel, film_fresnel(s, f0, c), s.iridescence);
    return fresnel;
}

// Quadrature: the sum of w_j F(c_j) over F_COSINES. The rest of `total`, total - sum of w_j, is the weight of c = 1.
vec3 sampled_dielectric(Surface s, vec4 weights, float total) {
    vec3 sum = dielectric_fresnel(s, F_COSINES.x) * weights.x + dielectric_fresnel(s, F_COSINES.y) * weights.y;
    sum += dielectric_fresnel(s, F_COSINES.z) * weights.z + dielectric_fresnel(s, F_COSINES.w) * weights.w;
    return sum + dielectric_fresnel(s, 1.0) * (total - dot(weights, vec4(1.0)));
}

vec3 sampled_metal(Surface s, vec4 weights, float total) {
    vec3 sum = metal_fresnel(s, F_COSINES.x) * weights.x + metal_fresnel(s, F_COSINES.y) * weights.y;
    sum += metal_fresnel(s, F_COSINES.z) * weights.z + metal_fresnel(s, F_COSINES.w) * weights.w;
    return sum + metal_fresnel(s, 1.0) * (total - dot(weights, vec4(1.0)));
}

// The same for f_schlick and a total of 1. It is linear in f0 and f90: its two functions of c are all constants.
vec3 schlick_mean(vec3 f0, vec3 f90, vec4 weights) {
    const vec3 F0 = vec3(1.0, 0.0, 0.0);
    const vec3 F90 = vec3(0.0, 1.0, 0.0);
    vec3 both = f_schlick(F0, F90, F_COSINES.x) * weights.x + f_schlick(F0, F90, F_COSINES.y) * weights.y;
    both += f_schlick(F0, F90, F_COSINES.z) * weights.z + f_schlick(F0, F90, F_COSINES.w) * weights.w;
    both += f_schlick(F0, F90, 1.0) * (1.0 - dot(weights, vec4(1.0)));
    return f0 * both.x + f90 * both.y;
}

// The mean of F with these weights of F_COSINES; the rest of 1 is the weight of c = 1.
vec3 dielectric_mean(Surface s, vec4 weights) {
    return DIELECTRIC_IS_SAMPLED ? sampled_dielectric(s, weights, 1.0) : schlick_mean(s.f0, vec3(s.f90), weights);
}

vec3 metal_mean(Surface s, vec4 weights) {
    return METAL_IS_SAMPLED ? sampled_metal(s, weights, 1.0) : schlick_mean(s.base_color, vec3(1.0), weights);
}

#endif
