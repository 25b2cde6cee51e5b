//@pass ground "Ground" to=picture off doc="The model's shadow on the ground under it"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "common/pixel.glsl"
#include "lighting/environment.glsl"
#include "lighting/shadows/ground.glsl"
#include "lighting/punctual.glsl"
#include "lighting/shadows/shadow.glsl"

// Darkens the background where the model takes light from the ground, by the part of the irradiance that is left. The ground
// itself is not drawn. Its light is that of the environment, and of the lights if shadows are on.
//
// Limits: rectangles count as point lights; the ground reflects no light onto the model.

uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D ground_sky;

uniform Ground {
    float ground_strength;     //@ui "Ground shadow" 0..1 = 0.8
};

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
    vec3 left = sky * texture(ground_sky, ground_uv(position_ws)).r;
    if (LIGHT_COUNT != 0u) {
        [[unroll]] for (uint i = 0u; i < LIGHT_COUNT; ++i) add_light(whole, left, i, position_ws);
    } else {
        for (uint i = 0u; i < min(frame.light_count, uint(MAX_LIGHTS)); ++i) add_light(whole, left, i, position_ws);
    }
    // Without light there is no shadow.
    return mix(vec3(1.0), left / max(whole, 1e-12), greaterThan(whole, vec3(1e-12)));
}

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    color = scene;
    vec4 far = frame.world_from_clip * vec4(2.0 * uv - 1.0, 0.0, 1.0);
    vec3 direction = far.xyz - far.w * frame.eye_ws;
    float above = frame.eye_ws.y - ground_height();
    if (texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r > 0.0 || direction.y >= 0.0 || above <= 0.0) return;
    vec3 position_ws = frame.eye_ws - direction * (above / direction.y);
    float away = length(position_ws.xz - frame.scene_center_ws.xz) / (0.5 * ground_width());
    float fade = ground_strength * (1.0 - smoothstep(0.6, 1.0, away));
    vec3 left = mix(vec3(1.0), lit_part_of(position_ws), fade);
    // Where no environment is behind the model, the shadow is black with the coverage of what it takes away.
    float taken = 1.0 - max(left.r, max(left.g, left.b));
    color = vec4(scene.rgb * left, scene.a + (1.0 - min(scene.a, 1.0)) * taken);
}
