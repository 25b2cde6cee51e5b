// Light from the environment, by the split sum (Karis 2013, "Real Shading in Unreal Engine 4"): each lobe's albedo
// towards the eye (lighting/albedo.glsl) times its mean incident radiance, from maps that were prefiltered for a
// lobe with v = n (ibl/prefilter.comp, ibl/irradiance.comp). Without an environment the radiance is the same from
// everywhere, and the product is exact. Suns of the map are lit as directional lights (lighting/sun.glsl).
//
// With REFLECTION_SAMPLES, the specular lobe and the coat are sums over directions instead
// (lighting/sampled_reflections.glsl).
//
// Multiple scattering (Kulla & Conty 2017; Fdez-Aguera 2019) leaves the facets in all directions, so it uses the
// irradiance, as the diffuse lobe does.
#ifndef LIGHTING_IMAGE_BASED_GLSL
#define LIGHTING_IMAGE_BASED_GLSL

#include "interface.glsl"
#include "brdf/horizon.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"
#include "lighting/albedo.glsl"
#include "lighting/shadows/ambient_occlusion.glsl"
#include "lighting/anisotropy.glsl"
#include "lighting/environment.glsl"
#include "lighting/lobes.glsl"
#include "lighting/sampled_reflections.glsl"
#include "lighting/sun.glsl"

// The direction in which to look up a lobe: the mirror direction, shifted towards n for rough lobes, since NoL weights
// them (Lagarde & de Rousiers 2014, section 4.9.3). The weight of n is within 0.1 of the true mean's at most angles. A
// mirror -> r, alpha = 1 -> n. Not normalized, since the lookup does not need it. The fit is for GGX.
vec3 lobe_direction(vec3 n, vec3 v, float roughness) {
    float alpha = pow(ggx_roughness(roughness), 2.0);
    float smoothness = 1.0 - alpha;
    return mix(n, reflect(-mirrored_to_front(n, v), n), smoothness * (sqrt(smoothness) + alpha));
}

// Mean incident radiance of an anisotropic lobe, without suns.
vec3 stretched_radiance(Surface s, vec3 v) {
    v = mirrored_to_front(s.n, v);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < STRIPS; ++i) {
        Strip strip = strip_of_lobe(s, v, i);
        sum += vec4(prefiltered_without_suns(lobe_direction(strip.n, v, s.roughness), s.roughness), 1.0) * strip.weight;
    }
    return sum.rgb / max(sum.a, 1e-6);
}

// Mean incident radiance of the base's specular lobe, without suns.
vec3 specular_sky(Surface s, vec3 v) {
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) return stretched_radiance(s, v);
    return prefiltered_without_suns(lobe_direction(s.n, v, s.roughness), s.roughness);
}

// The same with the suns, whose lobes are those of v = n. Lighting adds them by add_suns instead.
vec3 specular_radiance(Surface s, vec3 v) {
    vec3 radiance = specular_sky(s, v);
    if (SUN_COUNT == 0u) return radiance;
    return radiance + missing_suns(s.roughness) * sun_radiance(lobe_direction(s.n, v, s.roughness), s.roughness);
}

// Environment light but that of suns that the base's specular lobe reflects. evaluate_brdf knows the mesh's horizon; a lookup does not.
vec3 reflected_specular(Surface s, vec3 v, vec3 albedo) {
    if (REFLECTIONS_ARE_SAMPLED) return sampled_specular(s, v);
    return albedo * specular_sky(s, v) * reflection_visibility(s.ng, lobe_direction(s.n, v, s.roughness));
}

// The same for the coat.
vec3 reflected_coat(Surface s, vec3 v, vec3 albedo) {
    if (REFLECTIONS_ARE_SAMPLED) return sampled_coat(s, v);
    vec3 direction = lobe_direction(s.clearcoat_n, v, s.clearcoat_roughness);
    return albedo * prefiltered_without_suns(direction, s.clearcoat_roughness) * reflection_visibility(s.ng, direction);
}

// Occlusion is the open fraction of the hemisphere. glTF says that it dims indirect light, but not how it dims a narrow
// lobe (glTF 2.0, 3.9.3). Lagarde & de Rousiers 2014, listing 26: a wide lobe is dimmed by the same factor, a narrow
// one only at grazing angles and under strong occlusion. occlusion = 1 -> 1.
float specular_occlusion(float n_dot_v, float occlusion, float roughness) {
    float alpha = roughness * roughness;
    return saturate(pow(n_dot_v + occlusion, exp2(-16.0 * alpha - 1.0)) - 1.0 + occlusion);
}

// Light from the environment. `s.occlusion` includes ambient occlusion, screen_visibility().
Lobes environment_light(Surface s, vec3 v, Albedo albedo) {
    float n_dot_v = n_dot_v_of(s.n, v);
    Occlusion open = Occlusion(vec3(s.occlusion), 0.0, 0.0, s.occlusion);
    if (AMBIENT_OCCLUSION) open.wide = with_bounces(s.occlusion, s.base_color);
    open.specular = specular_occlusion(n_dot_v, s.occlusion, s.roughness);
    vec3 irradiance = irradiance_over_pi_without_suns(s.n) * open.wide;

    Lobes light = no_light();
    light.diffuse = albedo.diffuse * irradiance;
    light.multiple = albedo.multiple * irradiance;
    light.specular = reflected_specular(s, v, albedo.specular) * open.specular;
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        open.clearcoat = specular_occlusion(n_dot_v_of(s.clearcoat_n, v), s.occlusion, s.clearcoat_roughness);
        light.clearcoat = reflected_coat(s, v, albedo.clearcoat) * open.clearcoat;
    }
    if ((FEATURES & FEATURE_SHEEN) != 0u) {
        vec3 r = reflect(-mirrored_to_front(s.n, v), s.n);
        light.sheen = albedo.sheen * prefiltered_sheen(r, s.sheen_roughness) * reflection_visibility(s.ng, r) * open.sheen;
    }
    // Occlusion is that of the side that the eye sees; light from behind has not come through it.
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        light.transmitted = albedo.diffuse_transmitted * irradiance_over_pi_without_suns(-s.n);
    }
    if (SUN_COUNT != 0u) add_suns(light, s, v, open);
    return light;
}

#endif
