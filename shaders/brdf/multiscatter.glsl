// Light that leaves the surface after more than one reflection between its facets. F D V has only the first reflection,
// so without this term a rough white metal loses about half of the light.
#ifndef BRDF_MULTISCATTER_GLSL
#define BRDF_MULTISCATTER_GLSL

#include "brdf/energy.glsl"
#include "brdf/models.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"

// F of all further orders: after each reflection E_avg of the light leaves and the rest hits another facet (Kulla &
// Conty 2017, after Jakob et al. 2014):
//
//   F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg))        F_avg = 1 -> 1: a white metal loses nothing
vec3 multiple_fresnel(vec3 f_avg, float lost_avg) {
    return f_avg * f_avg * (1.0 - lost_avg) / (1.0 - f_avg * lost_avg);
}

// The lobe of a white metal (Kulla & Conty 2017, after Kelemen & Szirmay-Kalos 2001), symmetric in l and v:
//
//   f_ms = (1 - E(l)) (1 - E(v)) / (pi (1 - E_avg))       integral of f_ms NoL dl = 1 - E(v), the missing energy
//
// dfg_l, dfg_v: table entries. A mirror loses nothing (0 / 0); 1e-5 is below the loss at MIN_ALPHA.
float f_kulla_conty(vec4 dfg_l, vec4 dfg_v) { return dfg_l.r * dfg_v.r / (PI * max(dfg_v.a, 1e-5)); }

// Albedo of multiple scattering towards v (Fdez-Aguera 2019, derived for uniform lighting):
//
//   F_ms E_ms = F_ss E_ss F_avg / (1 - F_avg (1 - E)) (1 - E)     F_ss E_ss = f0 A + f90 B; F = 1 -> 1 - E
vec3 fdez_aguera_albedo(FresnelCurve curve, vec4 dfg) {
    return curve_albedo(curve, dfg) * curve.average * dfg.r / (1.0 - curve.average * dfg.r);
}

// The same for the selected model. dfg: the table entry of the direction in question.
vec3 multiple_albedo(FresnelCurve curve, vec4 dfg) {
    if (MULTI_SCATTER == FDEZ_AGUERA) return fdez_aguera_albedo(curve, dfg);
    if (MULTI_SCATTER == KULLA_CONTY) return multiple_fresnel(curve.average, dfg.a) * dfg.r;
    return vec3(0.0);
}

// The multiple-scattering lobe, 1/sr. dfg_l: the table entry towards the light.
vec3 f_multiple(Surface s, vec4 dfg_l) {
    if (MULTI_SCATTER == KULLA_CONTY) return s.multiple * f_kulla_conty(dfg_l, s.dfg);
    return s.multiple;
}

// Computes what does not depend on a light: s.dfg and s.multiple (F_ms of Kulla & Conty, or the whole lobe of
// Fdez-Aguera). Call it after the last change of the material and its normal, before lighting. `v`: towards the eye,
// unit.
void complete_surface(inout Surface s, vec3 v) {
    s.dfg = dfg(clamp(dot(s.n, v), MIN_N_DOT_V, 1.0), table_roughness(s));
    s.multiple = vec3(0.0);
    FresnelCurve dielectric = dielectric_curve(s);
    FresnelCurve metal = metal_curve(s);
    if (MULTI_SCATTER == KULLA_CONTY) {
        vec3 f_dielectric = multiple_fresnel(dielectric.average, s.dfg.a);
        s.multiple = mix(f_dielectric, multiple_fresnel(metal.average, s.dfg.a), s.metallic);
    } else if (MULTI_SCATTER == FDEZ_AGUERA) {
        vec3 albedo = mix(multiple_albedo(dielectric, s.dfg), multiple_albedo(metal, s.dfg), s.metallic);
        s.multiple = albedo / PI;
    }
}

// Total reflectance of the dielectric boundary, single and multiple scattering. The rest enters.
float boundary_albedo(Surface s, vec4 dfg) {
    FresnelCurve curve = dielectric_curve(s, dfg);
    return min(max_component(curve_albedo(curve, dfg) + multiple_albedo(curve, dfg)), 1.0);
}

// Its cosine-weighted average. For Schlick's curve it is a sum of A and B, whose averages are E_avg - b_average and
// b_average. The difference of another F to Schlick's is scaled by E_avg.
float boundary_albedo_average(Surface s) {
    float lost_avg = s.dfg.a;
    float e_avg = 1.0 - lost_avg;
    vec3 f90 = vec3(s.f90);
    vec3 average = dielectric_curve(s).average;
    vec3 single = s.f0 * e_avg + (f90 - s.f0) * b_average(table_roughness(s));
    single += e_avg * (average - curve_average(s.f0, f90, vec3(0.0)));
    if (MULTI_SCATTER != SINGLE_SCATTER) single += multiple_fresnel(average, lost_avg) * lost_avg;
    return max_component(single);
}

#endif
