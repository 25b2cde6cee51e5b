// The directional albedo of each lobe: the light it sends towards the eye under uniform lighting of radiance 1,
// R(v) = integral of f NoL dl. It does not depend on the lights, so it is computed once per fragment.
//
// Light that does not come from a single direction is reflected by the split sum (Karis 2013): the integral of a
// product becomes the product of two integrals, the albedo and the lobe's mean incident radiance. In a white furnace
// (all radiance 1) the product is exact. Each albedo is the integral of the lobe that evaluate_brdf returns for the
// selected models, so lighting from the environment conserves energy exactly as far as punctual lighting does.
#ifndef LIGHTING_ALBEDO_GLSL
#define LIGHTING_ALBEDO_GLSL

#include "interface.glsl"
#include "brdf/energy/albedo.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/layers/transmission.glsl"
#include "brdf/models.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
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

// The fraction of light that enters the dielectric and leaves towards v.
//
// GltfSample: 1 - F(VoH), averaged over the half vectors of the diffuse lobe. The sum with the specular albedo exceeds
// 1 at grazing angles, as it does for punctual lights; brdf/models.glsl claims no conservation for this coupling. Albedo: (1 -
// R(l)) (1 - R(v)) / (1 - R_avg) integrates to 1 - R(v), all that the boundary does not reflect.
float entering_albedo(Surface s, float n_dot_v) {
    if (DIFFUSE_COUPLING == ALBEDO_COUPLING) return 1.0 - s.boundary;
    return 1.0 - max_component(mean_dielectric_fresnel(s, n_dot_v));
}

// The layers attenuate as in evaluate_brdf. Sheen attenuates by the larger of E(l) and E(v); for lobes that gather from
// the whole hemisphere, the cosine-weighted mean of the cosine, 2/3, stands in for l.
Albedo directional_albedo(Surface s, vec3 v) {
    float n_dot_v = n_dot_v_of(s.n, v);
    vec3 single_dielectric = dielectric_albedo(s, s.dfg);

    Albedo albedo;
    albedo.specular = mix(single_dielectric, metal_albedo(s, s.dfg), s.metallic);
    albedo.multiple = mix(dielectric_multiple_albedo(s, s.dfg), metal_multiple_albedo(s, s.dfg), s.metallic);
    albedo.clearcoat = albedo.sheen = albedo.transmitted = albedo.diffuse_transmitted = vec3(0.0);
    albedo.under_coat = 1.0;

    float base = 1.0;
    float wide_base = 1.0;     // below sheen, for lobes that gather from the whole hemisphere
    if ((FEATURES & FEATURE_SHEEN) != 0u) {
        float sheen = sheen_albedo(n_dot_v, s.sheen_roughness);
        albedo.sheen = s.sheen_color * sheen;
        base = under_sheen(s, sheen);
        wide_base = under_sheen(s, max(sheen, sheen_albedo(2.0 / 3.0, s.sheen_roughness)));
    }
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        float coat_n_dot_v = n_dot_v_of(s.clearcoat_n, v);
        float weight = s.clearcoat * f_schlick(0.04, coat_n_dot_v);
        albedo.clearcoat = vec3(weight * dfg_at(coat_n_dot_v, s.clearcoat_roughness).e);
        albedo.under_coat = 1.0 - weight;
        albedo.sheen *= albedo.under_coat;
        base *= albedo.under_coat;
        wide_base *= albedo.under_coat;
    }

    float enters = wide_base * (1.0 - s.metallic) * entering_albedo(s, n_dot_v);
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) {
        // The transmitted lobe has the facet angles of the specular lobe, so F is that lobe's mean: its albedo over its
        // albedo for F = 1. 1e-3: a D of 0. Without multiple scattering, light between the facets is lost, as for punctual lights
        // (brdf/layers/transmission.glsl).
        float fresnel = max_component(single_dielectric) / max(s.dfg.e, 1e-3);
        float passes = base * (1.0 - s.metallic) * s.transmission;
        if (MULTI_SCATTER == SINGLE_SCATTER) passes *= dfg_at(n_dot_v, transmission_roughness(s.roughness, s.ior)).e;
        albedo.transmitted = s.base_color * (1.0 - fresnel) * passes;
        enters *= 1.0 - s.transmission;
    }
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        albedo.diffuse_transmitted = s.diffuse_transmission_color * (enters * s.diffuse_transmission);
        enters *= 1.0 - s.diffuse_transmission;
    }
    albedo.diffuse = diffuse_albedo(s.base_color, s.roughness, n_dot_v) * enters;
    albedo.specular *= base;
    albedo.multiple *= wide_base;
    return albedo;
}

#endif
