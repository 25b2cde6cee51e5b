#version 460
#extension GL_EXT_scalar_block_layout : require

// A line around what the mask covers: pixels outside of it with a covered pixel nearby.

layout(set = 2, binding = 0) uniform sampler2D mask;

layout(push_constant, scalar) uniform Push {
    // RGB as displayed.
    vec3 color;
    // Pixels.
    float width;
    // Of the mask, pixels.
    vec2 size;
} push;

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 line;

const int DIRECTIONS = 16;

void main() {
    float near = 0.0;
    for (int i = 0; i < DIRECTIONS; i++) {
        float angle = 6.2831853 * float(i) / float(DIRECTIONS);
        vec2 offset = push.width * vec2(cos(angle), sin(angle)) / push.size;
        near = max(near, max(textureLod(mask, uv + offset, 0.0).r, textureLod(mask, uv + 0.5 * offset, 0.0).r));
    }
    float coverage = near * (1.0 - textureLod(mask, uv, 0.0).r);
    // Premultiplied.
    line = vec4(push.color, 1.0) * coverage;
}
