// Shared by the passes of the depth of field. depth_of_field.frag tells how they work.
#ifndef LENS_GLSL
#define LENS_GLSL

#include "common/pixel.glsl"

// Radius of the largest blur, part of the picture's height. Blur beyond it is cut.
const float LARGEST_BLUR = 1.0 / 32.0;

// Samples of a disk lie along a spiral that turns by 2.4 radians, the golden angle (Vogel 1979).
const int LENS_SAMPLES = 20;
const mat2 GOLDEN_TURN = mat2(-0.737369, 0.675490, -0.675490, -0.737369);

// The direction of the first sample, another for each pixel: interleaved gradient noise (Jimenez 2014).
vec2 first_direction(vec2 pixel) {
    float angle = 6.2831853 * fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
    return vec2(cos(angle), sin(angle));
}

// Radius of sample i 0..1, and its part of the disk's area. Samples are denser in the middle, where small blurs need them: the radius
// grows with t^(3/4), so a sample stands for an area of 1.5 sqrt(t).
vec2 lens_sample(int i) {
    float root = sqrt((float(i) + 0.5) / float(LENS_SAMPLES));
    return vec2(root * sqrt(root), 1.5 * root / float(LENS_SAMPLES));
}

// How much of a blur of `blur` pixels reaches `away` pixels, 0..1.
float reach(float blur, float away) { return clamp(blur - away + 0.5, 0.0, 1.0); }

// A texel of dof_light: rgb light times coverage; in alpha, coverage as in common/pixel.glsl, and blur in steps of 1/8 pixel. So a
// sample takes one read.
vec4 lens_texel(vec4 light, float blur) { return vec4(light.rgb, min(light.a, 1.0) + 2.0 * round(8.0 * blur)); }
vec4 light_of(vec4 texel) { return vec4(texel.rgb, coverage_of(texel.a)); }
float blur_of(vec4 texel) { return 0.125 * floor(0.5 * texel.a); }

#endif
