// The view of a light for its shadow map: from the light as user_light leaves it. The light may depend on the place that it
// shines on, but its map is one picture, so the light at the center of the model counts.
#ifndef LIGHTING_LIGHT_VIEW_GLSL
#define LIGHTING_LIGHT_VIEW_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/punctual.glsl"

// The suns of the environment follow the lights; they are no lights of user_light.
Light shadow_light(uint i) {
    Light light = given_light(i);
    if (i < frame.light_count) user_light(light, i, frame.scene_center_ws);
    return light;
}

// World space to two axes across and the distance along `axis`, from a point.
mat4 look_along(vec3 axis, vec3 from) {
    mat3 basis = basis_around(axis);
    return mat4(vec4(basis[0].x, basis[1].x, axis.x, 0.0),
                vec4(basis[0].y, basis[1].y, axis.y, 0.0),
                vec4(basis[0].z, basis[1].z, axis.z, 0.0),
                vec4(-dot(basis[0], from), -dot(basis[1], from), -dot(axis, from), 1.0));
}

// World to the clip space of a light that sees the model's bounds; depth is reversed: 1 near, 0 far. The same as `view_of_light` in
// src/scene/lights.rs, which makes frame.light_clip_from_world. A light inside the bounds sees 143 degrees, towards their center.
mat4 view_of_light(Light light) {
    const vec3 DOWN = vec3(0.0, -1.0, 0.0);
    vec3 center = frame.scene_center_ws;
    float radius = max(1.02 * frame.scene_radius, 1e-6 * (1.0 + length(center)));
    vec3 place = light.position_ws.xyz;
    if (light.position_ws.w == 0.0) {
        mat4 view = look_along(safe_normalize(-place, DOWN), center);
        mat4 clip_from_view = mat4(1.0);
        clip_from_view[0].x = clip_from_view[1].y = 1.0 / radius;
        clip_from_view[2].z = -0.5 / radius;
        clip_from_view[3].z = 0.5;
        return clip_from_view * view;
    }
    float distance = length(center - place);
    float near = max(distance - radius, 0.02 * radius);
    float far = max(distance + radius, 1.00001 * near);
    float tangent = min(radius / sqrt(max(distance * distance - radius * radius, 1e-30)), 3.0);
    mat4 clip_from_view = mat4(0.0);
    clip_from_view[0].x = clip_from_view[1].y = 1.0 / tangent;
    clip_from_view[2].zw = vec2(-near / (far - near), 1.0);
    clip_from_view[3].z = near * far / (far - near);
    return clip_from_view * look_along(safe_normalize(center - place, DOWN), place);
}

// The view of light `i`, which is `light` at the center of the model. Where user_light moves no light, the optimizer sees that the
// bits are the same, and leaves the matrix that Specula gives.
mat4 light_view(uint i, Light light) {
    Light given = given_light(i);
    bool is_moved = !is_same_bits(light.position_ws.xyz, given.position_ws.xyz);
    bool is_of_other_kind = !is_same_bits(light.position_ws.w, given.position_ws.w);
    if (is_moved) return view_of_light(light);
    if (is_of_other_kind) return view_of_light(light);
    return frame.light_clip_from_world[i];
}

#endif
