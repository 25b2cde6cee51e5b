#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "lighting/shadow_view.glsl"
#include "user/vertex.glsl"

// The model as each light sees it, in the light's tile. Instance i belongs to light i.

layout(location = 0) out Fragment fragment;
layout(location = 12) out vec3 tile;  // beyond those of Fragment; xy: position in the tile, -w..w; z: depth, linear

void main() {
    Vertex vertex = draw.vertices.at[gl_VertexIndex];
    user_vertex(vertex);
    fragment.position_ws = draw.world_from_object * vec4(vertex.position, 1.0);
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    fragment.normal_ws = safe_normalize(draw.normal_ws_from_object * vertex.normal, vec3(0.0));
    fragment.tangent_ws = vertex.tangent;
    fragment.uv0 = vertex.uv0;
    fragment.uv1 = (FEATURES & FEATURE_UV1) != 0u ? vertex.uv1 : vertex.uv0;
    fragment.color = (FEATURES & FEATURE_VERTEX_COLOR) != 0u ? vertex.color : vec4(1.0);

    uint light = uint(gl_InstanceIndex);
    ShadowView view = shadow_view(lights[light]);
    vec3 seen = seen_from(view, fragment.position_ws);
    float depth = shadow_depth(view, seen);
    tile = vec3(seen.xy / view.half_width, depth);
    float w = view.is_parallel ? 1.0 : seen.z;
    float size = 1.0 / float(shadow_tiles());
    vec2 center = 2.0 * shadow_tile(light) + size - 1.0;
    gl_Position = vec4(seen.xy / view.half_width * size + w * center, view.is_parallel ? depth : view.near_m, w);
    gl_PointSize = 1.0;
    // No tile: behind the far plane.
    if (light >= MAX_SHADOWS) gl_Position = vec4(0.0, 0.0, -1.0, 1.0);
}
