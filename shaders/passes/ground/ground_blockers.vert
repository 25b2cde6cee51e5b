#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/vertex.glsl"
#include "lighting/shadows/ground.glsl"
#include "user/vertex.glsl"

// The model as the ground sees it, straight from below.

layout(location = 0) out Fragment fragment;

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);
    // Depth is reversed: the lowest surface is the nearest.
    float height = (fragment.position_ws.y - ground_height()) / ground_width();
    gl_Position = vec4(2.0 * ground_uv(fragment.position_ws) - 1.0, 1.0 - height, 1.0);
    gl_PointSize = 1.0;
}
