//@pass life "Life" size=320x180 format=r16f keep doc="One generation of Conway's Game of Life in each frame"
#version 460
#include "pass.glsl"
#include "common/sampling.glsl"

// Conway's Game of Life (Gardner 1970, Scientific American 223(4)): a cell lives on with two or three neighbors, and is born
// with three. The image of the frame before is `before_life`. Hold the mouse over the picture to draw.

uniform sampler2D before_life;

float cell(ivec2 at) {
    ivec2 size = textureSize(before_life, 0);
    return texelFetch(before_life, (at + size) % size, 0).r;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float neighbors = -cell(at);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) neighbors += cell(at + ivec2(x, y));
    }
    bool lives = neighbors == 3.0 || (neighbors == 2.0 && cell(at) == 1.0);
    // The first frame is random: images begin with zeros, so nothing would ever be born.
    if (frame.frame_index == 0u) lives = random_numbers(uvec3(at, 1u)).x < 0.3;
    if (frame.mouse_px.z > 0.0 && distance(uv * frame.viewport_px, frame.mouse_px.xy) < 8.0) lives = true;
    color = vec4(lives ? 1.0 : 0.0);
}
