#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/vertex.glsl"
#include "user/vertex.glsl"

// Shell i of the fur is the model, grown along its normals.

layout(location = 0) out Fragment fragment;
layout(location = 12) out float height;  // 0 skin .. 1 tips

const float SHELLS = 24.0;
const float LENGTH = 0.1;                // of the model's radius

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);
    // Where the skin is, so that a hair has the same place in all shells.
    fragment.color = vec4(fragment.position_ws, 1.0);
    height = (float(gl_InstanceIndex) + 1.0) / SHELLS;
    // Hair hangs down a little, the more the farther out.
    vec3 hangs = vec3(0.0, -0.4, 0.0) * height * height;
    vec3 grows = safe_normalize(fragment.normal_ws + hangs, vec3(0.0, 1.0, 0.0));
    fragment.position_ws += LENGTH * frame.scene_radius * height * grows;
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    gl_Position = frame.clip_from_world * vec4(fragment.position_ws, 1.0);
    gl_PointSize = 1.0;
}
