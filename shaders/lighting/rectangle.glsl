// Rectangular lights: weights each lobe's albedo by the fraction that the light covers (lighting/area.glsl).
#ifndef LIGHTING_RECTANGLE_GLSL
#define LIGHTING_RECTANGLE_GLSL

#include "interface.glsl"
#include "brdf/energy/albedo.glsl"
#include "brdf/layers/transmission.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "lighting/albedo.glsl"
#include "lighting/anisotropy.glsl"
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

// The part of a lobe that the light covers. The table is for GGX, so the lobe counts as the GGX that is as wide.
AreaLight covered(Light light, vec3 position_ws, vec3 n, vec3 v, float roughness) {
    return integrate_rect(light, position_ws, n, v, ggx_roughness(roughness));
}

// The same for the specular lobe of an anisotropic surface.
float covered_of_stretched(Light light, Surface s, vec3 v) {
    v = mirrored_to_front(s.n, v);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < STRIPS; ++i) {
        Strip strip = strip_of_lobe(s, v, i);
        sum += vec2(covered(light, s.position_ws, strip.n, v, s.roughness).specular, 1.0) * strip.weight;
    }
    return sum.x / max(sum.y, 1e-6);
}

// The part of the rectangle's height that lies above the plane of n, 0..1. 1e-20: edges parallel to the plane.
float part_above(Light light, vec3 position_ws, vec3 n) {
    float reach = abs(dot(n, light.half_x_ws)) + abs(dot(n, light.half_y_ws));
    return saturate((dot(n, light.position_ws.xyz - position_ws) + reach) / max(2.0 * reach, 1e-20));
}

// The part of what the lobes of n see of the rectangle that lies above the mesh, 0..1. integrate_rect clips at the horizon of n; where
// the mesh's own is higher, the light is reduced by the height that it hides, which is 1 for a rectangle in front of both and 0 for one
// behind the mesh. In between it is an approximation, which needs no second clipping. n = ng -> 1.
float rectangle_visibility(Light light, vec3 position_ws, vec3 ng, vec3 n) {
    return min(part_above(light, position_ws, ng) / max(part_above(light, position_ws, n), 1e-6), 1.0);
}

// Each lobe's albedo, times the fraction of the lobe that the rectangle covers, times the rectangle's radiance.
// Multiple scattering and sheen have no table; they use the fraction of the diffuse lobe, which is about as wide.
Lobes rectangle_light(Surface s, vec3 v, Albedo albedo, Light light) {
    AreaLight base = covered(light, s.position_ws, s.n, v, s.roughness);
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) base.specular = covered_of_stretched(light, s, v);
    float front = rectangle_visibility(light, s.position_ws, s.ng, s.n);
    base.diffuse *= front;
    base.specular *= front;
    Lobes seen = no_light();
    seen.diffuse = albedo.diffuse * base.diffuse;
    seen.multiple = albedo.multiple * base.diffuse;
    seen.sheen = albedo.sheen * base.diffuse;
    seen.specular = albedo.specular * base.specular;
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        AreaLight coat = covered(light, s.position_ws, s.clearcoat_n, v, s.clearcoat_roughness);
        seen.clearcoat = albedo.clearcoat * coat.specular * rectangle_visibility(light, s.position_ws, s.ng, s.clearcoat_n);
    }
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        AreaLight back = covered(light, s.position_ws, -s.n, v, s.roughness);
        seen.transmitted += albedo.diffuse_transmitted * back.diffuse * rectangle_visibility(light, s.position_ws, -s.ng, -s.n);
    }
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) {
        // The transmitted lobe of a thin wall is the reflected lobe, mirrored, as in evaluate_brdf.
        float roughness = transmission_roughness(s.roughness, s.ior);
        Light mirror = mirrored_rectangle(light, s.position_ws, s.n);
        float through = covered(mirror, s.position_ws, s.n, v, roughness).specular;
        seen.transmitted += albedo.transmitted * through * rectangle_visibility(light, s.position_ws, -s.ng, -s.n);
    }
    Lobes sum = no_light();
    add(sum, with_sum(seen), light.intensity);
    return sum;
}

#endif
