// Color: transfer functions, luminance, and colors that stand for numbers. RGB is linear with Rec. 709 primaries.
#ifndef COMMON_COLOR_GLSL
#define COMMON_COLOR_GLSL

#include "common/math.glsl"

// sRGB from linear and back, IEC 61966-2-1:1999. Inputs below 0 are taken as 0: pow of a negative number is undefined.
vec3 srgb_from_linear(vec3 x) {
    x = max(x, 0.0);
    return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 linear_from_srgb(vec3 x) {
    x = max(x, 0.0);
    return mix(pow((x + 0.055) / 1.055, vec3(2.4)), x / 12.92, lessThanEqual(x, vec3(0.04045)));
}

// Y of CIE XYZ: the second row of the Rec. 709 matrix (ITU-R BT.709-6).
float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

// Luma Y': the same sum of encoded values (ITU-R BT.709-6). Not the luminance, but close to how bright a pixel looks.
float luma(vec3 encoded) { return luminance(encoded); }

// 0 blue, 1/4 cyan, 1/2 green, 3/4 yellow, 1 red: each channel is a tent with a flat top. Inputs are clamped.
vec3 heat(float t) { return saturate(1.5 - abs(4.0 * saturate(t) - vec3(3.0, 2.0, 1.0))); }

// A hue for a number, neighbors far apart: steps of the golden ratio around the color wheel. 2654435769 is 2^32 /
// phi, so the product is the fraction of id / phi in exact integers (Knuth 1973, The Art of Computer Programming 3,
// section 6.4).
vec3 color_from_id(uint id) {
    float hue = float((id + 1u) * 2654435769u) / 4294967296.0;
    return 0.55 + 0.45 * cos(2.0 * PI * (hue + vec3(0.0, 1.0, 2.0) / 3.0));
}

// The color of a debug mode where its data does not exist: two grays in squares of 16 pixels.
vec3 checkerboard(vec2 pixel) {
    ivec2 square = ivec2(pixel) / 16;
    return vec3(((square.x + square.y) & 1) == 0 ? 0.180017 : 0.260017);
}

#endif
