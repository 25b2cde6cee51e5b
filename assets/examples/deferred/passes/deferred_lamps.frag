//@pass deferred_lamps "Deferred: lamps" doc="Light of the lamps that the surfaces in the G-buffer reflect, cd/m^2"
#version 460
#include "pass.glsl"
#include "brdf/evaluate.glsl"
#include "lighting/albedo.glsl"
#include "lighting/light_grid.glsl"
#include "lighting/punctual.glsl"
#include "lighting/rectangle.glsl"
#include "lighting/shadows/shadow.glsl"
#include "passes/deferred.glsl"

// Radiance towards the eye by light `i`.
vec3 radiance_by_light(uint i, Surface s, vec3 v, Albedo albedo) {
    Light light = light_at(i, s.position_ws);
    if ((FEATURES & FEATURE_RECT_LIGHTS) != 0u && light.kind == LIGHT_RECT) {
        vec3 to_center = safe_normalize(light.position_ws.xyz - s.position_ws, s.n);
        return rectangle_light(s, v, albedo, light).all * shadow_visibility(i, s.position_ws, s.ng, to_center);
    }
    Illumination from = illuminate(light, s.position_ws);
    float n_dot_l = dot(s.n, from.l);
    if (n_dot_l <= 0.0) return vec3(0.0);
    float visible = shadow_visibility(i, s.position_ws, s.ng, from.l);
    return evaluate_brdf(s, from.l, v).value * from.irradiance * (n_dot_l * visible);
}

void main() {
    color = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (!has_surface(pixel)) return;
    vec3 direction = view_direction(uv);
    Surface s = surface_at(pixel, direction);
    Albedo albedo = directional_albedo(s, -direction);
    vec3 radiance = vec3(0.0);
    LightWalk walk = lights_near(s.position_ws);
    for (uint n = 0u; n < uint(MAX_LIGHTS); ++n) {
        uint i = next_light(walk);
        if (i == NO_LIGHT) break;
        radiance += radiance_by_light(i, s, -direction, albedo);
    }
    color = vec4(radiance, 1.0);
}
