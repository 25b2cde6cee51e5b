// The content of a pixel of the HDR target: linear RGB times coverage; in alpha, coverage 0..1 and flags.
//
// A flag is added to alpha, so it passes through half floats, clamping and the mean of a pixel's samples. Of n samples (up
// to 8), each without data adds 16 / n, at least 2, and each that is not finite adds 256 / n, at least 32. Coverage is
// below 2, and 16 / n is even, so the three never mix. PixelValue::decode in src/render/pixel.rs reads the same.
#ifndef COMMON_PIXEL_GLSL
#define COMMON_PIXEL_GLSL

#include "interface.glsl"

// The value of one sample for the HDR target. `no_data`: the debug mode that is shown has no data here. NaN is stored as 0
// and infinity as the largest value of the target, so that neither spoils the mean of the pixel's samples.
vec4 hdr_pixel(vec3 value, float coverage, bool no_data) {
    bvec3 is_nan = isnan(value);
    float flag = no_data ? float(FLAG_NO_DATA) : 0.0;
    if (any(is_nan) || any(isinf(value))) flag = float(FLAG_NOT_FINITE);
    value = mix(clamp(value, -frame.largest_value, frame.largest_value), vec3(0.0), is_nan);
    return vec4(value * coverage, coverage + flag);
}

// Whether Specula ended a loop of this pixel early. Such a pixel is (60000, -60000, 60000) with FLAG_NOT_FINITE.
bool is_cut_short(vec4 pixel) {
    return pixel.a >= float(FLAG_NOT_FINITE) / 8.0 && pixel.g < 0.0 && min(pixel.r, pixel.b) > 0.0;
}

// Coverage 0..1 of the alpha of a pixel.
float coverage_of(float alpha) { return 2.0 * fract(0.5 * alpha); }

#endif
