//@pass dof_reach "Depth of field: reach" size=1/16 format=r32f doc="Radius in pixels of the largest blur in front of the focus that reaches each tile of 16 x 16 pixels"
#version 460
#include "pass.glsl"
#include "lens.glsl"

uniform sampler2D dof_circle;

const int STEPS = 12;

void main() {
    vec2 size = vec2(textureSize(dof_circle, 0));
    vec2 reach_px = vec2(0.5 * 16.0 + LARGEST_BLUR * size.y);
    float largest = 0.0;
    for (int y = 0; y < STEPS; ++y) {
        for (int x = 0; x < STEPS; ++x) {
            vec2 offset = (2.0 * vec2(x, y) + 1.0) / float(STEPS) - 1.0;
            vec4 blurs = -textureGather(dof_circle, uv + offset * reach_px / size);
            largest = max(largest, max(max(blurs.x, blurs.y), max(blurs.z, blurs.w)));
        }
    }
    color = vec4(largest, 0.0, 0.0, 1.0);
}
