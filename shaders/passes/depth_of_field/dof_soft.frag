//@pass dof_soft "Depth of field: softer light" size=1/2 format=rgba32f doc="dof_light, softened where the blur is wide"
#version 460
#include "pass.glsl"
#include "lens.glsl"

// The samples of a wide blur are texels apart. A tent of 3 x 3 texels of the same surface fills the space between them, so that a
// small highlight becomes a disk, not a pattern of dots.

uniform sampler2D dof_light;

// Blur with the full tent, pixels.
const float WIDE_BLUR = 12.0;

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(dof_light, 0) - 1;
    float blur = blur_of(texelFetch(dof_light, here, 0));
    float side = 0.5 * min(abs(blur) / WIDE_BLUR, 1.0);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 texel = clamp(here + ivec2(x, y), ivec2(0), last);
            vec4 other = texelFetch(dof_light, texel, 0);
            float same = clamp(2.0 - abs(blur_of(other) - blur), 0.0, 1.0);
            float weight = same * (x == 0 ? 1.0 : side) * (y == 0 ? 1.0 : side);
            sum += weight * light_of(other);
            weights += weight;
        }
    }
    color = lens_texel(sum / weights, blur);
}
