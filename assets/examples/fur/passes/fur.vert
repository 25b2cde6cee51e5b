#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "user/params.glsl"

// Shell i of the fur is the model, grown along its normals.

layout(location = 0) out Fragment fragment;
layout(location = 12) out float height;  // 0 skin .. 1 tips

const float SHELLS = 24.0;

void main() {
    Vertex vertex = draw.vertices.at[gl_VertexIndex];
    height = (float(gl_InstanceIndex) + 1.0) / SHELLS;
    vec3 n = safe_normalize(draw.normal_ws_from_object * vertex.normal, vec3(0.0, 1.0, 0.0));
    vec3 position_ws = draw.world_from_object * vec4(vertex.position, 1.0);
    // Hair hangs down a little, the more the farther out.
    vec3 hangs = vec3(0.0, -0.4, 0.0) * height * height;
    fragment.position_ws = position_ws + fur_length * frame.scene_radius * height * normalize(n + hangs);
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    fragment.normal_ws = n;
    fragment.tangent_ws = vertex.tangent;
    fragment.uv0 = vertex.uv0;
    fragment.uv1 = vertex.uv0;
    // Where the skin is, so that a hair has the same place in all shells.
    fragment.color = vec4(position_ws, 1.0);
    gl_Position = frame.clip_from_world * vec4(fragment.position_ws, 1.0);
    gl_PointSize = 1.0;
}
