//@pass ground_light "Ground: light" size=1024x1024 doc="Part of the ground's irradiance that the model leaves"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/environment.glsl"
#include "lighting/punctual.glsl"
#include "lighting/shadows/ground.glsl"
#include "lighting/shadows/shadow.glsl"

// The ground's light is that of the environment, and of the lights if shadows are on. It does not depend on the camera, so the
// image stays while only that moves.
//
// Limits: rectangles count as point lights.

uniform sampler2D ground_sky;

const vec3 UP = vec3(0.0, 1.0, 0.0);

// Adds the irradiance by light `i`, and what is left of it in the light's shadow.
void add_light(inout vec3 whole, inout vec3 left, uint i, vec3 position_ws) {
    Illumination light = illuminate(light_at(i, position_ws), position_ws);
    vec3 irradiance = light.irradiance * max(light.l.y, 0.0);
    whole += irradiance;
    left += irradiance * shadow_visibility(i, position_ws, UP, light.l);
}

// Part of the irradiance of a point of the ground that reaches it.
vec3 lit_part_of(vec3 position_ws) {
    vec3 sky = PI * irradiance_over_pi(UP);
    vec3 whole = sky;
    vec3 left = sky * texture(ground_sky, uv).r;
    if (LIGHT_COUNT != 0u) {
        [[unroll]] for (uint i = 0u; i < LIGHT_COUNT; ++i) add_light(whole, left, i, position_ws);
    } else {
        for (uint i = 0u; i < min(frame.light_count, uint(MAX_LIGHTS)); ++i) add_light(whole, left, i, position_ws);
    }
    // Without light there is no shadow.
    return mix(vec3(1.0), left / max(whole, 1e-12), greaterThan(whole, vec3(1e-12)));
}

void main() { color = vec4(lit_part_of(ground_position(uv)), 1.0); }
