// Rectangular lights: weights each lobe's albedo by the fraction that the light covers (lighting/area.glsl).
#ifndef LIGHTING_RECTANGLE_GLSL
#define LIGHTING_RECTANGLE_GLSL

#include "interface.glsl"
#include "brdf/energy.glsl"
#include "brdf/surface.glsl"
#include "brdf/transmission.glsl"
#include "lighting/albedo.glsl"
#include "lighting/area.glsl"
#include "lighting/lobes.glsl"

// The light mirrored in the surface's tangent plane.
Light mirrored_rectangle(Light light, vec3 position_ws, vec3 n) {
    light.position_ws.xyz = position_ws + reflect(light.position_ws.xyz - position_ws, n);
    light.direction_ws = reflect(light.direction_ws, n);
    light.half_x_ws = reflect(light.half_x_ws, n);
    light.half_y_ws = reflect(light.half_y_ws, n);
    return light;
}

// Each lobe's albedo, times the fraction of the lobe that the rectangle covers, times the rectangle's radiance.
// Multiple scattering and sheen have no table; they use the fraction of the diffuse lobe, which is about as wide.
Lobes rectangle_light(Surface s, vec3 v, Albedo albedo, Light light) {
    AreaLight base = integrate_rect(light, s.position_ws, s.n, v, s.roughness);
    Lobes seen = no_light();
    seen.diffuse = albedo.diffuse * base.diffuse;
    seen.multiple = albedo.multiple * base.diffuse;
    seen.sheen = albedo.sheen * base.diffuse;
    seen.specular = albedo.specular * base.specular;
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        AreaLight coat = integrate_rect(light, s.position_ws, s.clearcoat_n, v, s.clearcoat_roughness);
        seen.clearcoat = albedo.clearcoat * coat.specular;
    }
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        AreaLight back = integrate_rect(light, s.position_ws, -s.n, v, s.roughness);
        seen.transmitted += albedo.diffuse_transmitted * back.diffuse;
    }
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) {
        // The transmitted lobe of a thin wall is the reflected lobe, mirrored, as in evaluate_brdf. evaluate_brdf loses
        // light between the facets, so this multiplies by the albedo for F = 1.
        float roughness = transmission_roughness(s.roughness, s.ior);
        vec3 passes = albedo.transmitted * white_albedo(dfg(n_dot_v_of(s.n, v), roughness));
        Light mirror = mirrored_rectangle(light, s.position_ws, s.n);
        seen.transmitted += passes * integrate_rect(mirror, s.position_ws, s.n, v, roughness).specular;
    }
    Lobes sum = no_light();
    add(sum, with_sum(seen), light.intensity);
    return sum;
}

#endif
