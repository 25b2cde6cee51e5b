#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/vertex.glsl"
#include "lighting/shadows/shadow_view.glsl"
#include "user/vertex.glsl"

// The model as each light sees it, in the light's tile. Instance i belongs to light i.

layout(location = 0) out Fragment fragment;
layout(location = 12) out vec3 tile;  // beyond those of Fragment; xy: position in the tile, -w..w; z: depth, linear

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);

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
