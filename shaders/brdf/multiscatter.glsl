// Light that leaves the surface after more than one reflection between its facets. D V F has only the first one: a
// rough white metal would keep half of the light.
#ifndef BRDF_MULTISCATTER_GLSL
#define BRDF_MULTISCATTER_GLSL

#include "brdf/energy.glsl"
#include "brdf/models.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"

// F of all orders together: E_avg of what arrives leaves after each meeting, the rest meets another facet (Kulla &
// Conty 2017, after Jakob et al. 2014):
//
//   F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg))        F_avg = 1 -> 1: a white metal loses nothing
vec3 multiple_fresnel(vec3 f_avg, float lost_avg) {
    return f_avg * f_avg * (1.0 - lost_avg) / (1.0 - f_avg * lost_avg);
}

// The lobe of a white metal (Kulla & Conty 2017, after Kelemen & Szirmay-Kalos 2001), symmetric in l and v:
//
//   f_ms = (1 - E(l)) (1 - E(v)) / (pi (1 - E_avg))       integral of f_ms NoL dl = 1 - E(v), just what is missing
//
// dfg_l, dfg_v: entries of the table. A mirror loses nothing: 0 / 0. 1e-5 is less than what is lost at MIN_ALPHA.
float f_kulla_conty(vec4 dfg_l, vec4 dfg_v) { return dfg_l.r * dfg_v.r / (PI * max(dfg_v.a, 1e-5)); }

// The part of the light that leaves towards v after more than one reflection (Fdez-Aguera 2019, made for
// light from everywhere):
//
//   F_ms E_ms = F_ss E_ss F_avg / (1 - F_avg (1 - E)) (1 - E)     F_ss E_ss = f0 A + f90 B; F = 1 -> 1 - E
vec3 fdez_aguera_albedo(FresnelCurve curve, vec4 dfg) {
    return curve_albedo(curve, dfg) * curve.average * dfg.r / (1.0 - curve.average * dfg.r);
}

// The same by the model that is chosen. dfg: the entry for the direction that is asked for.
vec3 multiple_albedo(FresnelCurve curve, vec4 dfg) {
    if (MULTI_SCATTER == FDEZ_AGUERA) return fdez_aguera_albedo(curve, dfg);
    if (MULTI_SCATTER == KULLA_CONTY) return multiple_fresnel(curve.average, dfg.a) * dfg.r;
    return vec3(0.0);
}

// The lobe, 1/sr. dfg_l: the table's entry towards the light.
vec3 f_multiple(Surface s, vec4 dfg_l) {
    if (MULTI_SCATTER == KULLA_CONTY) return s.multiple * f_kulla_conty(dfg_l, s.dfg);
    return s.multiple;
}

// What no light changes: s.dfg, and s.multiple, the F_ms of Kulla & Conty or the whole lobe of Fdez-Aguera. To be called
// after the last change of the material and the normal, before the surface is lit. `v`: unit, towards the eye.
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

// All that the boundary of the dielectric reflects, once or more often: what is left of 1 enters.
float boundary_albedo(Surface s, vec4 dfg) {
    FresnelCurve curve = dielectric_curve(s, dfg);
    return min(max_component(curve_albedo(curve, dfg) + multiple_albedo(curve, dfg)), 1.0);
}

// The same over the hemisphere. Schlick's curve is a sum of A and B, whose averages are E_avg - b_average and
// b_average; what another F has more or less than Schlick's is taken in proportion to E_avg.
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
