#version 460

layout(location = 0) out vec4 color;

// Premultiplied.
void main() { color = vec4(0.12, 0.47, 1.0, 1.0) * 0.4; }
