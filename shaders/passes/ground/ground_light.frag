//@pass ground_light "Ground: light" size=1024x1024 doc="Part of the ground's irradiance that the model leaves"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/environment_map.glsl"
#include "lighting/light_grid.glsl"
#include "lighting/punctual.glsl"
#include "lighting/shadows/ground.glsl"
#include "lighting/shadows/shadow.glsl"

// The ground's light is that of the environment, and of the lights if shadows are on. It does not depend on the camera, so the
// image stays while only that moves.
//
// Limits: rectangles count as point lights.

uniform sampler2D ground_sky;

const vec3 UP = vec3(0.0, 1.0, 0.0);

// Part of sun i that reaches the point. With shadows it is that of its shadow map. Without them, the first sun is hidden below the
// elevation up to which its direction is free, sin^2; the edge is soft, as the model is known in a few steps only. Further suns
// then are a part of the sky.
float sun_visibility(uint i, vec3 position_ws, vec3 l, vec2 open) {
    if (SHADOWS != NO_SHADOWS) return shadow_visibility(frame.light_count + i, position_ws, UP, l);
    return i == 0u ? 1.0 - smoothstep(0.7 * open.g, 1.3 * open.g + 0.05, l.y * l.y) : open.r;
}

// Adds the irradiance by the suns, and what is left of it.
void add_suns(inout vec3 whole, inout vec3 left, vec3 position_ws, vec2 open) {
    [[unroll]] for (uint i = 0u; i < SUN_COUNT; ++i) {
        Light sun = sun_at(i);
        vec3 l = sun.position_ws.xyz;
        if (l.y <= 0.0) continue;
        whole += sun.intensity * l.y;
        left += sun.intensity * (l.y * sun_visibility(i, position_ws, l, open));
    }
}

// Adds the irradiance by light `i`, and what is left of it in the light's shadow.
void add_light(inout vec3 whole, inout vec3 left, uint i, vec3 position_ws) {
    Illumination light = illuminate(light_at(i, position_ws), position_ws);
    vec3 irradiance = light.irradiance * max(light.l.y, 0.0);
    whole += irradiance;
    left += irradiance * shadow_visibility(i, position_ws, UP, light.l);
}

// The same for many lights: first those with shadows, then the others that reach the point.
void add_many(inout vec3 whole, inout vec3 left, vec3 position_ws) {
    for (uint i = 0u; i < MAX_LIGHT_VIEWS; ++i) add_light(whole, left, i, position_ws);
    LightWalk walk = lights_near(position_ws);
    for (uint n = 0u; n < uint(MAX_LIGHTS); ++n) {
        uint i = next_light(walk);
        if (i == NO_LIGHT) break;
        if (i < MAX_LIGHT_VIEWS) continue;
        Illumination light = illuminate(light_at(i, position_ws), position_ws);
        vec3 irradiance = light.irradiance * max(light.l.y, 0.0);
        whole += irradiance;
        left += irradiance;
    }
}

// Part of the irradiance of a point of the ground that reaches it.
vec3 lit_part_of(vec3 position_ws) {
    vec2 open = texture(ground_sky, uv).rg;
    vec3 whole = PI * irradiance_over_pi_without_suns(UP);
    vec3 left = whole * open.r;
    if (SUN_COUNT != 0u) add_suns(whole, left, position_ws, open);
    if (LIGHT_COUNT != 0u) {
        [[unroll]] for (uint i = 0u; i < LIGHT_COUNT; ++i) add_light(whole, left, i, position_ws);
    } else if (MANY_LIGHTS == 0u) {
        for (uint i = 0u; i < min(frame.light_count, uint(FEW_LIGHTS)); ++i) add_light(whole, left, i, position_ws);
    } else {
        add_many(whole, left, position_ws);
    }
    // Without light there is no shadow.
    return mix(vec3(1.0), left / max(whole, 1e-12), greaterThan(whole, vec3(1e-12)));
}

void main() { color = vec4(lit_part_of(ground_position(uv)), 1.0); }
