#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "lighting/ground.glsl"
#include "user/vertex.glsl"

// The model as the ground sees it, straight from below.

layout(location = 0) out Fragment fragment;

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
    // Depth is reversed: the lowest surface is the nearest.
    float height = (fragment.position_ws.y - ground_height()) / ground_width();
    gl_Position = vec4(2.0 * ground_uv(fragment.position_ws) - 1.0, 1.0 - height, 1.0);
    gl_PointSize = 1.0;
}
