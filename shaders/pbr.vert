#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "user/vertex.glsl"

// Transforms vertices to world and clip space. Vertices are read through a buffer device address, so the pipeline
// declares no vertex input.

layout(location = 0) out Fragment fragment;

void main() {
    Vertex vertex = draw.vertices.at[gl_VertexIndex];
    user_vertex(vertex);
    mat3 directions = mat3(draw.world_from_object);

    fragment.position_ws = draw.world_from_object * vec4(vertex.position, 1.0);
    // Unit length at each vertex: on a non-uniformly scaled mesh, interpolation would otherwise favor the longer normals.
    // A zero normal stays zero; the fragment stage replaces it.
    fragment.normal_ws = safe_normalize(draw.normal_ws_from_object * vertex.normal, vec3(0.0));
    // A mirroring transform flips cross(n, t), so the sign of the bitangent flips too.
    float mirrored = determinant(directions) < 0.0 ? -1.0 : 1.0;
    fragment.tangent_ws = vec4(safe_normalize(directions * vertex.tangent.xyz, vec3(0.0)), vertex.tangent.w * mirrored);
    fragment.uv0 = vertex.uv0;
    fragment.uv1 = (FEATURES & FEATURE_UV1) != 0u ? vertex.uv1 : vertex.uv0;
    fragment.color = (FEATURES & FEATURE_VERTEX_COLOR) != 0u ? vertex.color : vec4(1.0);

    // This follows every change of the position.
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    gl_Position = frame.clip_from_world * vec4(fragment.position_ws, 1.0);
    gl_PointSize = 4.0;
}
