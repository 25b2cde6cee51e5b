#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/vertex.glsl"
#include "user/vertex.glsl"

// The model grown along its normals, by the same number of pixels everywhere.

layout(location = 0) out Fragment fragment;

const float WIDTH_PX = 3.0;

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    vec4 clip = frame.clip_from_world * vec4(fragment.position_ws, 1.0);
    vec2 direction = (frame.clip_from_world * vec4(fragment.normal_ws, 0.0)).xy * frame.viewport_px;
    float length_px = length(direction);
    if (length_px > 0.0) clip.xy += WIDTH_PX * 2.0 / frame.viewport_px * (direction / length_px) * clip.w;
    gl_Position = clip;
    gl_PointSize = 1.0;
}
