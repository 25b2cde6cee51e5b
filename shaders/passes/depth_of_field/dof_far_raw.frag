//@pass dof_far_raw "Depth of field: background samples" size=1/2 doc="Blurred light of what is not in front of the focus, and coverage; with noise"
#version 460
#include "pass.glsl"
#include "lens.glsl"

uniform sampler2D dof_soft;

// Smallest gather radius, in pixels. Even in-focus pixels gather this far, so that there is background to blend in at their
// edges.
const float SMALLEST_SEARCH = 5.0;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(dof_soft, 0) - 1;
    vec4 own = texelFetch(dof_soft, here, 0);
    float blur = blur_of(own);
    float radius = max(abs(blur), SMALLEST_SEARCH);
    vec2 direction = first_direction(gl_FragCoord.xy);
    // Where nothing else reaches, the pixel's own light.
    vec4 sum = 1e-5 * light_of(own);
    float weights = 1e-5;
    for (int i = 0; i < LENS_SAMPLES; ++i) {
        direction = GOLDEN_TURN * direction;
        vec2 disk = lens_sample(i);
        float away = disk.x * radius;
        ivec2 texel = clamp(ivec2(gl_FragCoord.xy + 0.5 * away * direction), ivec2(0), last);
        vec4 sampled = texelFetch(dof_soft, texel, 0);
        float other = blur_of(sampled);
        // A sharp pixel does not reach far, so it does not leak into the background around it. The light of a point is spread over
        // the area of its circle.
        float weight = disk.y * reach(other, away) / max(other * other, 4.0);
        sum += weight * light_of(sampled);
        weights += weight;
    }
    color = sum / weights;
}
