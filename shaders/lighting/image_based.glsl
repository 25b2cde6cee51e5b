// Light from the environment, by the split sum (Karis 2013, "Real Shading in Unreal Engine 4"): each lobe's albedo
// towards the eye (lighting/albedo.glsl) times the radiance that the lobe gathers on average, looked up in images that
// were filtered before (ibl/prefilter.comp, ibl/irradiance.comp) for a lobe seen along its axis.
//
// Multiple scattering (Kulla & Conty 2017; Fdez-Aguera 2019) leaves the facets in all directions, and gathers what the
// diffuse lobe gathers.
#ifndef LIGHTING_IMAGE_BASED_GLSL
#define LIGHTING_IMAGE_BASED_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "lighting/albedo.glsl"
#include "lighting/environment.glsl"
#include "lighting/lobes.glsl"

// Where a lobe gathers its light: around the mirrored eye, but a rough one more from above, since NoL weighs it
// (Lagarde & de Rousiers 2014, section 4.9.3). Within 0.1 of the true mean's share of n for most angles; a mirror -> r,
// alpha = 1 -> n. Not unit length: it only looks up a cube.
vec3 lobe_direction(vec3 n, vec3 v, float roughness) {
    float alpha = roughness * roughness;
    float smoothness = 1.0 - alpha;
    return mix(n, reflect(-v, n), smoothness * (sqrt(smoothness) + alpha));
}

// The facets of a stretched lobe lean along t: of those in the plane of t and n, the one that faces the eye. The
// rounder the lobe, the more the normal itself (McAuley 2015, "Rendering the world of Far Cry 4", after Revie 2011).
vec3 stretched_normal(Surface s, vec3 v) {
    vec3 facing = v - s.b * dot(s.b, v);
    float round_part = 1.0 - s.anisotropy * (1.0 - s.roughness);
    round_part *= round_part;
    return safe_normalize(mix(safe_normalize(facing, s.n), s.n, round_part * round_part), s.n);
}

// Where the specular lobe of the base looks.
vec3 mirrored(Surface s, vec3 v) {
    vec3 n = s.n;
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) n = stretched_normal(s, v);
    return lobe_direction(n, v, s.roughness);
}

// Occlusion is the part of the hemisphere that is open; glTF says that it dims indirect light, not how it dims a lobe
// that looks at a part of it (glTF 2.0, 3.9.3). Lagarde & de Rousiers 2014, listing 26: a wide lobe is dimmed as much,
// a narrow one only where it grazes the surface and the rest of the sky is hidden. occlusion = 1 -> 1.
float specular_occlusion(float n_dot_v, float occlusion, float roughness) {
    float alpha = roughness * roughness;
    return saturate(pow(n_dot_v + occlusion, exp2(-16.0 * alpha - 1.0)) - 1.0 + occlusion);
}

Lobes environment_light(Surface s, vec3 v, Albedo albedo) {
    float n_dot_v = n_dot_v_of(s.n, v);
    vec3 irradiance = irradiance_over_pi(s.n) * s.occlusion;

    Lobes light = no_light();
    light.diffuse = albedo.diffuse * irradiance;
    light.multiple = albedo.multiple * irradiance;
    light.specular = albedo.specular * prefiltered_radiance(mirrored(s, v), s.roughness);
    light.specular *= specular_occlusion(n_dot_v, s.occlusion, s.roughness);
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        vec3 direction = lobe_direction(s.clearcoat_n, v, s.clearcoat_roughness);
        light.clearcoat = albedo.clearcoat * prefiltered_radiance(direction, s.clearcoat_roughness);
        light.clearcoat *= specular_occlusion(n_dot_v_of(s.clearcoat_n, v), s.occlusion, s.clearcoat_roughness);
    }
    if ((FEATURES & FEATURE_SHEEN) != 0u) {
        light.sheen = albedo.sheen * prefiltered_sheen(reflect(-v, s.n), s.sheen_roughness) * s.occlusion;
    }
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        light.transmitted = albedo.diffuse_transmitted * irradiance_over_pi(-s.n) * s.occlusion;
    }
    return light;
}

#endif
