// Light that leaves the surface after more than one reflection between its facets. F D V has only the first reflection,
// so without this term a rough white metal loses about half of the light.
#ifndef BRDF_ENERGY_MULTISCATTER_GLSL
#define BRDF_ENERGY_MULTISCATTER_GLSL

#include "brdf/energy/albedo.glsl"
#include "brdf/models.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

// Limits the factors of the series of reflections, sum over k of (F (1 - E))^k = 1 / (1 - F (1 - E)), to those that physics allows. No surface
// reflects more than it receives, so F is at most 1. 0.999: an E of 0, which a D of 0 has.
void limit_series(inout vec3 f_avg, inout float lost) {
    f_avg = min(f_avg, 1.0);
    lost = min(lost, 0.999);
}

// F of all further orders: after each reflection E_avg of the light leaves and the rest hits another facet. The first of
// them lies behind one reflection that lost its light between the facets, hence the square (Hill 2018, "A Multi-Faceted
// Exploration", a correction of Kulla & Conty 2017, whose term has one F_avg less):
//
//   F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg))        F_avg = 1 -> 1: a white metal loses nothing
//
// The quotient is the sum of a geometric series, so it holds for F_avg (1 - E_avg) < 1 only. A base color above 1, which user_surface
// or COLOR_0 can give, would reach its pole: at roughness 1, where E_avg = 0.41, a base color of 1.73.
vec3 multiple_fresnel(vec3 f_avg, float lost_avg) {
    limit_series(f_avg, lost_avg);
    return f_avg * f_avg * (1.0 - lost_avg) / (1.0 - f_avg * lost_avg);
}

// The lobe of a white metal (Kulla & Conty 2017, after Kelemen & Szirmay-Kalos 2001), symmetric in l and v:
//
//   f_ms = (1 - E(l)) (1 - E(v)) / (pi (1 - E_avg))       integral of f_ms NoL dl = 1 - E(v), the missing energy
//
// A mirror loses nothing (0 / 0); 1e-5 is below the loss at MIN_ALPHA.
float f_kulla_conty(float lost_l, float lost_v, float lost_mean) { return lost_l * lost_v / (PI * max(lost_mean, 1e-5)); }

// Albedo of multiple scattering towards v (Fdez-Aguera 2019, derived for uniform lighting):
//
//   F_ms E_ms = F_ss E_ss F_avg / (1 - F_avg (1 - E)) (1 - E)     single = F_ss E_ss; F = 1 -> 1 - E
vec3 fdez_aguera_albedo(vec3 single, vec3 f_avg, float lost) {
    limit_series(f_avg, lost);
    return single * f_avg * lost / (1.0 - f_avg * lost);
}

// Albedo of the selected model. single: albedo of one reflection; lost_mean: of the mean over directions.
vec3 multiple_albedo(vec3 single, vec3 f_avg, Dfg dfg, float lost_mean) {
    if (MULTI_SCATTER == FDEZ_AGUERA) return fdez_aguera_albedo(single, f_avg, dfg.lost);
    if (MULTI_SCATTER == KULLA_CONTY) return multiple_fresnel(f_avg, lost_mean) * dfg.lost;
    return vec3(0.0);
}

vec3 dielectric_multiple_albedo(Surface s, Dfg dfg) {
    return multiple_albedo(dielectric_albedo(s, dfg), s.dielectric_average, dfg, s.mean_dfg.lost);
}

vec3 metal_multiple_albedo(Surface s, Dfg dfg) {
    return multiple_albedo(metal_albedo(s, dfg), s.metal_average, dfg, s.mean_dfg.lost);
}

// The multiple-scattering lobe, 1/sr. lost_l: what the single-scattering lobe towards the light lacks.
vec3 f_multiple(Surface s, float lost_l) {
    if (MULTI_SCATTER == KULLA_CONTY) return s.multiple * f_kulla_conty(lost_l, s.dfg.lost, s.mean_dfg.lost);
    return s.multiple;
}

// Total reflectance of the dielectric boundary, single and multiple scattering, in the direction of `dfg`, or on
// average for s.mean_dfg. The rest enters.
float boundary_albedo(Surface s, Dfg dfg) {
    return min(max_component(dielectric_albedo(s, dfg) + dielectric_multiple_albedo(s, dfg)), 1.0);
}

// Computes what does not depend on a light, among it s.multiple: F_ms of Kulla & Conty, or the whole lobe of
// Fdez-Aguera. Call it after the last change of the material and its normal, before lighting. `v`: towards the eye,
// unit.
void complete_surface(inout Surface s, vec3 v) {
    s.dielectric_average = dielectric_mean(s, F_MEAN_WEIGHTS);
    s.metal_average = metal_mean(s, F_MEAN_WEIGHTS);
    s.dfg = dfg_towards_eye(s, v);
    s.mean_dfg = dfg_mean(table_roughness(s), s.dfg);
    s.multiple = vec3(0.0);
    if (MULTI_SCATTER == KULLA_CONTY) {
        vec3 f_dielectric = multiple_fresnel(s.dielectric_average, s.mean_dfg.lost);
        s.multiple = mix(f_dielectric, multiple_fresnel(s.metal_average, s.mean_dfg.lost), s.metallic);
    } else if (MULTI_SCATTER == FDEZ_AGUERA) {
        s.multiple = mix(dielectric_multiple_albedo(s, s.dfg), metal_multiple_albedo(s, s.dfg), s.metallic) / PI;
    }
    s.boundary = boundary_albedo(s, s.dfg);
    s.mean_boundary = boundary_albedo(s, s.mean_dfg);
}

#endif
