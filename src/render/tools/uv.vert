#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require

// Places the triangles of a primitive at their texture coordinates.

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vertices { float data[]; };

layout(push_constant, scalar) uniform Push {
    Vertices vertices;
    // First float of the coordinates in a vertex.
    uint first;
    // Texture coordinates from those of the mesh.
    mat3x2 uv_from_mesh;
    // Corner and size of the part that is shown.
    vec2 corner;
    vec2 size;
} push;

void main() {
    uint at = uint(gl_VertexIndex) * 18u + push.first;
    vec2 uv = push.uv_from_mesh * vec3(push.vertices.data[at], push.vertices.data[at + 1u], 1.0);
    gl_Position = vec4((uv - push.corner) / push.size * 2.0 - 1.0, 0.0, 1.0);
}
