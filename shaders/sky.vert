#version 460

// One triangle that covers the screen, infinitely far away: depth is reversed, 0 is infinity. It is seen where there is
// no model.

void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
