//@pass ground_light "Ground: light" size=1024x1024 doc="Part of the ground's irradiance that the model leaves"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/environment_map.glsl"
#include "lighting/punctual.glsl"
#include "lighting/shadows/ground.glsl"
#include "lighting/shadows/shadow.glsl"

// The ground's light is that of the environment, and of the lights if shadows are on. It does not depend on the camera, so the
// image stays while only that moves.
//
// Limits: rectangles count as point lights.

uniform sampler2D ground_sky;

const vec3 UP = vec3(0.0, 1.0, 0.0);

// The part of the sky's irradiance that comes from the sun.
vec3 sun_irradiance() {
    if ((FEATURES & FEATURE_SUN) == 0u) return vec3(0.0);
    return frame.environment_intensity * frame.sun_intensity * max(frame.sun_direction.y, 0.0);
}

// Part of the sun that is below the elevation up to which its direction is free, sin^2. The edge is soft, as the model is known in a
// few steps only.
float sun_visibility(float open) {
    float elevation = frame.sun_direction.y * frame.sun_direction.y;
    return 1.0 - smoothstep(0.7 * open, 1.3 * open + 0.05, elevation);
}

// Adds the irradiance by light `i`, and what is left of it in the light's shadow.
void add_light(inout vec3 whole, inout vec3 left, uint i, vec3 position_ws) {
    Illumination light = illuminate(light_at(i, position_ws), position_ws);
    vec3 irradiance = light.irradiance * max(light.l.y, 0.0);
    whole += irradiance;
    left += irradiance * shadow_visibility(i, position_ws, UP, light.l);
}

// Part of the irradiance of a point of the ground that reaches it.
vec3 lit_part_of(vec3 position_ws) {
    vec2 open = texture(ground_sky, uv).rg;
    vec3 whole = PI * irradiance_over_pi(UP);
    vec3 sun = min(sun_irradiance(), whole);
    vec3 left = (whole - sun) * open.r + sun * sun_visibility(open.g);
    if (LIGHT_COUNT != 0u) {
        [[unroll]] for (uint i = 0u; i < LIGHT_COUNT; ++i) add_light(whole, left, i, position_ws);
    } else {
        for (uint i = 0u; i < min(frame.light_count, uint(MAX_LIGHTS)); ++i) add_light(whole, left, i, position_ws);
    }
    // Without light there is no shadow.
    return mix(vec3(1.0), left / max(whole, 1e-12), greaterThan(whole, vec3(1e-12)));
}

void main() { color = vec4(lit_part_of(ground_position(uv)), 1.0); }
