#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require

// Places the triangles of a selected instance. Vertices are arrays of floats here: `vertex::STRIDE` in mod.rs.

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vertices { float data[]; };

layout(push_constant, scalar) uniform Push {
    mat4 clip_from_object;
    Vertices vertices;
} push;

void main() {
    uint at = uint(gl_VertexIndex) * 18u;
    vec3 position = vec3(push.vertices.data[at], push.vertices.data[at + 1u], push.vertices.data[at + 2u]);
    gl_Position = push.clip_from_object * vec4(position, 1.0);
}
