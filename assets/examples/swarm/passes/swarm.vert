#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/sampling.glsl"
#include "common/vertex.glsl"
#include "user/vertex.glsl"

// Instance i is a small copy of the model that flies around it on a circle of its own.

layout(location = 0) out Fragment fragment;

void main() {
    Vertex vertex = mesh_vertex();
    user_vertex(vertex);
    fragment = fragment_of(vertex);
    vec3 random = random_numbers(uvec3(gl_InstanceIndex, 7u, 0u));
    vec3 other = random_numbers(uvec3(gl_InstanceIndex, 8u, 0u));
    float angle = 2.0 * PI * random.x + frame.time_s * mix(0.2, 0.8, random.y);
    mat3 plane = basis_around(normalize(other - 0.5));
    vec3 center = plane * vec3(cos(angle), sin(angle), 0.0) * mix(0.8, 1.25, random.z);
    vec3 offset = 0.06 * (fragment.position_ws - frame.scene_center_ws) + center * frame.scene_radius;
    fragment.position_ws = frame.scene_center_ws + offset;
    fragment.to_eye_ws = frame.eye_ws - fragment.position_ws;
    fragment.color = vec4(other, 1.0);
    gl_Position = frame.clip_from_world * vec4(fragment.position_ws, 1.0);
    gl_PointSize = 1.0;
}
