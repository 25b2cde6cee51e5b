#version 460

// A full-screen triangle: (-1, -1), (3, -1), (-1, 3). Two triangles would shade the pixels along their shared edge
// twice.

void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
