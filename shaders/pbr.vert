#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/jitter.glsl"
#include "common/vertex.glsl"
#include "user/vertex.glsl"

// Transforms vertices to world and clip space.

layout(location = 0) out Fragment fragment;

// Several stages draw the same surfaces, and compare their depths.
invariant gl_Position;

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    gl_Position = frame.clip_from_world * vec4(fragment.position_ws, 1.0);
    if (MODE == 0u) gl_Position.xy += 2.0 * jitter_px() / frame.viewport_px * gl_Position.w;
    gl_PointSize = 4.0;
}
