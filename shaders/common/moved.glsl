// How far a pose has moved the surface since the frame before, for fragment stages that draw the model.
#ifndef COMMON_MOVED_GLSL
#define COMMON_MOVED_GLSL

#include "interface.glsl"

// Where a point of this fragment's surface was in the frame before: world space, meters. The point moves with the corners of its
// triangle, weighted by its barycentric coordinates.
//
// Limits: user_vertex counts as still. Of points and lines, the matrix counts, but not joints and morph targets.
vec3 position_before_ws(vec3 position_ws) {
    if ((draw.attributes & ATTRIBUTE_MOVED) == 0u) return position_ws;
    Before before = draw.before.at[0];
    if (draw.triangle_count == 0u) {
        vec3 position = inverse(mat3(draw.world_from_object)) * (position_ws - draw.world_from_object[3]);
        return before.world_from_object * vec4(position, 1.0);
    }
    Corners corners = draw.indices.at[gl_PrimitiveID];
    vec3 now[3], motion[3];
    for (int i = 0; i < 3; ++i) {
        now[i] = draw.world_from_object * vec4(draw.vertices.at[corners.vertex[i]].position, 1.0);
        motion[i] = before.world_from_object * vec4(before.vertices.at[corners.vertex[i]].position, 1.0) - now[i];
    }
    vec3 u = now[1] - now[0], v = now[2] - now[0], p = position_ws - now[0];
    float uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), pu = dot(p, u), pv = dot(p, v);
    float area2 = uu * vv - uv * uv;
    vec2 at = area2 > 0.0 ? vec2(vv * pu - uv * pv, uu * pv - uv * pu) / area2 : vec2(0.0);
    return position_ws + motion[0] + at.x * (motion[1] - motion[0]) + at.y * (motion[2] - motion[0]);
}

#endif
