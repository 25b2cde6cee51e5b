// The hooks of user.glsl, with the pattern of passes/reaction.frag as a stain on the model.
#ifndef USER_GLSL
#define USER_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "user/params.glsl"

// The image of the pass `reaction`. The model reads it, so the pass is drawn before the model.
uniform sampler2D reaction;

void user_surface(inout Surface s, Fragment f, vec3 v) {
    s.roughness = saturate(s.roughness * roughness_scale);
    // Projected along the axis that the surface faces most.
    vec3 p = (s.position_ws - frame.scene_center_ws) / frame.scene_radius;
    vec3 facing = abs(s.n);
    vec2 at = facing.x > max(facing.y, facing.z) ? p.zy : facing.y > facing.z ? p.xz : p.xy;
    // At an explicit level: `at` jumps where the surface faces another axis, and so would its derivatives.
    float inhibitor = textureLod(reaction, 0.5 + 0.45 * at, 0.0).g;
    float stain = smoothstep(0.1, 0.25, inhibitor);
    s.base_color = mix(s.base_color, vec3(0.01, 0.02, 0.03), stain);
    s.roughness = mix(s.roughness, 0.15, stain);
}

void user_light(inout Light light, uint index, vec3 position_ws) {
}

vec3 user_radiance(Surface s, vec3 v, vec3 radiance) { return radiance; }

#endif
