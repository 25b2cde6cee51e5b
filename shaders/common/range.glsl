// Values as the display shows them: range, channels, colors that stand for a number, and dither.
#ifndef COMMON_RANGE_GLSL
#define COMMON_RANGE_GLSL

#include "interface.glsl"
#include "common/math.glsl"

// Whether values are spread over a range, in place of exposure and tone map.
bool has_range() { return frame.range_scale != 0.0; }

vec3 in_range(vec3 value) { return (value - frame.range_low) * frame.range_scale; }

// The chosen channel as gray, or all three.
vec3 chosen_channels(vec3 value, float coverage) {
    if (frame.channels == 0u) return value;
    return vec3(frame.channels == 4u ? coverage : value[min(frame.channels, 3u) - 1u]);
}

// The color that stands for a number, 0..1: linear RGB between the nearest steps of the colormap.
vec3 color_of_number(float t) {
    float at = saturate(t) * float(COLORMAP_STEPS - 1);
    int low = min(int(at), COLORMAP_STEPS - 2);
    return mix(frame.colormap[low], frame.colormap[low + 1], at - float(low));
}

// Dither of +-1/2 step of 8 bits, which turns the bands of smooth gradients into grain. Interleaved gradient noise
// spreads evenly over each 3 x 3 pixels (Jimenez 2014, Next Generation Post Processing in Call of Duty: Advanced Warfare).
float dither_noise(vec2 pixel) {
    float noise = fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
    return frame.dither * (noise - 0.5) / 255.0;
}

#endif
