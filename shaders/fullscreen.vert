#version 460

// A full-screen triangle: (-1, -1), (3, -1), (-1, 3). Two triangles would shade the pixels along their shared edge
// twice.

// Position in the image, 0..1 from the upper left corner.
layout(location = 0) out vec2 uv;

void main() {
    vec2 corner = vec2(gl_VertexIndex == 1 ? 2.0 : 0.0, gl_VertexIndex == 2 ? 2.0 : 0.0);
    uv = corner;
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
