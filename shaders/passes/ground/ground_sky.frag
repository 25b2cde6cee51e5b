//@pass ground_sky "Ground: sky" size=128x128 format=r16f doc="Part of the sky that the ground sees, weighted by the cosine"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/shadows/ground.glsl"

// In each direction of the compass the model hides the sky above some angle: that of the lowest surface over the ground, as if the
// model were solid above it. Below that angle t the sky lights the ground with the integral of 2 sin cos from 0 to t, sin^2 t.

// Horizons of a height field hide the sky in the same way (Max 1988, "Horizon Mapping: Shadows for Bump-Mapped Surfaces").
//
// Limits: light that passes under an overhang of the model is lost.

uniform sampler2D ground_blockers;

const int DIRECTIONS = 24;
const int STEPS = 6;

void main() {
    float sky = 0.0;
    for (int i = 0; i < DIRECTIONS; ++i) {
        float angle = 2.0 * PI * (float(i) + 0.5) / float(DIRECTIONS);
        vec2 direction = vec2(cos(angle), sin(angle));
        float open = 1.0;
        for (int step = 0; step < STEPS; ++step) {
            // Distances grow, as near blockers hide the most: 0.4 % to 36 % of the ground.
            float far = 0.36 * pow((float(step) + 0.6) / (float(STEPS) - 0.4), 2.0);
            // The mean over an area as wide as the step, so that no thin wall is missed and none stands out.
            float level = log2(max(0.5 * far * pass.size_px.x, 1.0));
            vec2 blockers = textureLod(ground_blockers, clamp(uv + far * direction, 0.0, 1.0), level).rg;
            if (blockers.r <= 0.0) continue;
            float height = max(blockers.g / blockers.r, 0.0);
            open = min(open, 1.0 - blockers.r * (1.0 - height * height / (height * height + far * far)));
        }
        sky += open;
    }
    color = vec4(sky / float(DIRECTIONS), 0.0, 0.0, 1.0);
}
