#version 460

// A full-screen triangle at infinity (depth is reversed, so z = 0), visible wherever the model does not cover it.

void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
