// The directional albedo of each lobe: the light it sends towards the eye under uniform lighting of radiance 1,
// R(v) = integral of f NoL dl. It does not depend on the lights, so it is computed once per fragment.
//
// Light that does not come from a single direction is reflected by the split sum (Karis 2013): the integral of a
// product becomes the product of two integrals, the albedo and the lobe's mean incident radiance. In a white furnace
// (all radiance 1) the product is exact. Each albedo is the integral of the lobe that evaluate_brdf returns for the
// selected models, so lighting from the environment conserves energy exactly as far as lighting from lamps does.
#ifndef LIGHTING_ALBEDO_GLSL
#define LIGHTING_ALBEDO_GLSL

#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "brdf/energy.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/models.glsl"
#include "brdf/multiscatter.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"

struct Albedo {
    vec3 diffuse;
    vec3 specular;             // reflected by one microfacet
    vec3 multiple;             // by more than one
    vec3 clearcoat;
    vec3 sheen;
    vec3 transmitted;          // transmitted straight through, or refracted
    vec3 diffuse_transmitted;  // transmitted and scattered
    float under_coat;          // transmittance of the coat, for light from below it
};

float n_dot_v_of(vec3 n, vec3 v) { return clamp(dot(n, v), MIN_N_DOT_V, 1.0); }

// The cosine-weighted mean of (1 - VoH)^5 over l: our fit, with an error of at most 0.00025. The mean is small, since h
// is seldom far from v, even at grazing v.
float mean_rise(float n_dot_v) {
    float x = 1.0 - n_dot_v;
    return x * x * (0.01693 + 0.01112 * x * x);
}

// The fraction of light that enters the dielectric and leaves towards v.
//
// Fresnel coupling: 1 - F(VoH), integrated. The sum with the specular albedo exceeds 1 at grazing angles, as it does
// for lamps; brdf/models.glsl claims no conservation for this coupling. Albedo coupling: (1 - R(l)) (1 - R(v)) / (1 -
// R_avg) integrates to 1 - R(v), all that the boundary does not reflect.
float entering_albedo(Surface s, FresnelCurve dielectric, float n_dot_v) {
    if (DIFFUSE_COUPLING == ALBEDO_COUPLING) return 1.0 - boundary_albedo(s, s.dfg);
    vec3 f = has_film() ? dielectric.average : s.f0 + (s.f90 - s.f0) * mean_rise(n_dot_v);
    return 1.0 - max_component(f);
}

// Integral of f_diffuse NoL dl. Lambert's is the base color; Oren-Nayar's is in brdf/diffuse.glsl. Both of Burley's are
// a product of a factor of l and a factor of v, in which VoH^2 = (1 + l . v) / 2 is replaced by its mean: (1 + 2/3 NoV)
// / 2 over all l, 1/2 over grazing ones. (1 - NoL)^5 has the mean 1/21. Error below 0.02; for Call of Duty, with our
// fit to its retroreflection, below 0.05.
vec3 diffuse_albedo(Surface s, float n_dot_v) {
    float r = s.roughness;
    float rise = pow5(1.0 - n_dot_v);
    if (DIFFUSE == OREN_NAYAR) {
        float a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
        float average = a * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * r);
        vec3 rho = s.base_color * s.base_color * average / (1.0 - s.base_color * (1.0 - average));
        return mix(rho, s.base_color, eon_albedo(n_dot_v, r, a));
    }
    float fit = 1.0;
    if (DIFFUSE == BURLEY) {
        fit = (1.0 + (r - 0.5) / 21.0) * (1.0 + (r * (1.0 + n_dot_v / 1.5) - 0.5) * rise);
    } else if (DIFFUSE == RENORMALIZED_BURLEY) {
        fit = (1.0 + (1.5 * r - 1.0) / 21.0) * (1.0 + (r * (1.5 + n_dot_v / 1.5) - 1.0) * rise);
        fit *= mix(1.0, 1.0 / 1.51, r);
    } else if (DIFFUSE == CALL_OF_DUTY) {
        float alpha = alpha_from_roughness(r);
        float g = saturate(log2(2.0 / (alpha * alpha) - 1.0) / 18.0);
        float smooth_lobe = (1.0 - 0.75 / 21.0) * (1.0 - 0.75 * rise);
        fit = mix(sqrt(0.5 + n_dot_v / 3.0), smooth_lobe, saturate(2.2 * g - 0.5));
        fit += ((34.5 * g - 59.0) * g + 24.5) / (54.0 + n_dot_v * (215.0 + 120.0 * n_dot_v));
    }
    return s.base_color * fit;
}

// The layers attenuate as in evaluate_brdf. Sheen attenuates by the larger of E(l) and E(v); for lobes that gather from
// the whole hemisphere, the mean cosine stands in for l.
Albedo directional_albedo(Surface s, vec3 v) {
    float n_dot_v = n_dot_v_of(s.n, v);
    FresnelCurve dielectric = dielectric_curve(s);
    FresnelCurve metal = metal_curve(s);
    vec3 single_dielectric = curve_albedo(dielectric, s.dfg);

    Albedo albedo;
    albedo.specular = mix(single_dielectric, curve_albedo(metal, s.dfg), s.metallic);
    albedo.multiple = mix(multiple_albedo(dielectric, s.dfg), multiple_albedo(metal, s.dfg), s.metallic);
    albedo.clearcoat = albedo.sheen = albedo.transmitted = albedo.diffuse_transmitted = vec3(0.0);
    albedo.under_coat = 1.0;

    float base = 1.0;
    float wide_base = 1.0;     // below sheen, for lobes that gather from the whole hemisphere
    if ((FEATURES & FEATURE_SHEEN) != 0u) {
        float sheen = sheen_albedo(n_dot_v, s.sheen_roughness);
        albedo.sheen = s.sheen_color * sheen;
        base = under_sheen(s, sheen);
        wide_base = under_sheen(s, max(sheen, sheen_albedo(MEAN_COSINE, s.sheen_roughness)));
    }
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        float coat_n_dot_v = n_dot_v_of(s.clearcoat_n, v);
        float weight = s.clearcoat * f_schlick(0.04, coat_n_dot_v);
        albedo.clearcoat = vec3(weight * white_albedo(dfg(coat_n_dot_v, s.clearcoat_roughness)));
        albedo.under_coat = 1.0 - weight;
        albedo.sheen *= albedo.under_coat;
        base *= albedo.under_coat;
        wide_base *= albedo.under_coat;
    }

    float enters = wide_base * (1.0 - s.metallic) * entering_albedo(s, dielectric, n_dot_v);
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) {
        // The transmitted lobe has the facet angles of the specular lobe, so F is that lobe's mean: its albedo over its
        // albedo for F = 1. Light lost between facets is counted as transmitted.
        float f = max_component(single_dielectric) / white_albedo(s.dfg);
        float passes = base * (1.0 - s.metallic) * s.transmission;
        albedo.transmitted = s.base_color * (1.0 - f) * passes;
        enters *= 1.0 - s.transmission;
    }
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        albedo.diffuse_transmitted = s.diffuse_transmission_color * (enters * s.diffuse_transmission);
        enters *= 1.0 - s.diffuse_transmission;
    }
    albedo.diffuse = diffuse_albedo(s, n_dot_v) * enters;
    albedo.specular *= base;
    albedo.multiple *= wide_base;
    return albedo;
}

#endif
