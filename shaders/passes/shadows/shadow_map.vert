#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/vertex.glsl"
#include "lighting/shadows/tiles.glsl"
#include "user/vertex.glsl"

// The model as each light sees it, in the light's tile. Instance i belongs to light i.

uniform sampler2D light_views;

layout(location = 0) out Fragment fragment;
layout(location = 12) out vec2 in_tile;  // beyond those of Fragment; -w..w inside the tile

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);

    mat4 view = mat4(texelFetch(light_views, ivec2(0, gl_InstanceIndex), 0), texelFetch(light_views, ivec2(1, gl_InstanceIndex), 0),
                     texelFetch(light_views, ivec2(2, gl_InstanceIndex), 0), texelFetch(light_views, ivec2(3, gl_InstanceIndex), 0));
    vec4 seen = view * vec4(fragment.position_ws, 1.0);
    in_tile = seen.xy;
    float size = 1.0 / float(shadow_tiles());
    vec2 center = 2.0 * shadow_tile(uint(gl_InstanceIndex)) + size - 1.0;
    gl_Position = vec4(seen.xy * size + seen.w * center, seen.zw);
    gl_PointSize = 1.0;
}
