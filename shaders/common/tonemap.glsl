// Tone maps: from exposed linear light (1 is the sensor's saturation at this EV) to linear display values, 0..1.
#ifndef COMMON_TONEMAP_GLSL
#define COMMON_TONEMAP_GLSL

#include "common/color.glsl"
#include "common/math.glsl"

// Same order as `Tonemap` in src/settings.rs.
const uint TONEMAP_NONE = 0u;
const uint TONEMAP_REINHARD = 1u;
const uint TONEMAP_REINHARD_LUMINANCE = 2u;
const uint TONEMAP_UNCHARTED2 = 3u;
const uint TONEMAP_ACES = 4u;
const uint TONEMAP_ACES_HILL = 5u;
const uint TONEMAP_AGX = 6u;
const uint TONEMAP_NEUTRAL = 7u;

// x / (1 + x) per channel (Reinhard et al. 2002, eq. 3). Nothing clips and nothing reaches white; 1 maps to 1/2. Bright
// colors desaturate, since each channel is compressed on its own.
vec3 tonemap_reinhard(vec3 x) { return x / (1.0 + x); }

// The same on luminance, as in the paper: hue and saturation are kept, so a saturated light can exceed 1 and clip.
vec3 tonemap_reinhard_luminance(vec3 x) { return x / (1.0 + luminance(x)); }

// Filmic curve of Uncharted 2 (Hable 2010): toe, shoulder, white point 11.2. The exposure bias of 2 is the author's.
vec3 hable(vec3 x) {
    const float shoulder = 0.15, linear = 0.50, angle = 0.10, toe = 0.20, toe_top = 0.02, toe_bottom = 0.30;
    return (x * (shoulder * x + angle * linear) + toe * toe_top) / (x * (shoulder * x + linear) + toe * toe_bottom)
         - toe_top / toe_bottom;
}
vec3 tonemap_uncharted2(vec3 x) { return hable(2.0 * x) / hable(vec3(11.2)); }

// Rational fit of the ACES sRGB transform (Narkowicz 2015). About 1.7 times brighter than ACES (scale x by 0.6 to
// match), desaturates bright colors later than ACES, and clips at x = 7.2.
vec3 tonemap_aces(vec3 x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

// Fit of the ACES reference and output transforms (Hill 2016), evaluated in a space between the two: bright colors
// desaturate as on film. Matrices are in column order. The curve's limit is 1 / 0.9837, so only very bright light
// clips.
vec3 tonemap_aces_hill(vec3 x) {
    const mat3 aces_from_rgb = mat3(0.59719, 0.07600, 0.02840,
                                    0.35458, 0.90834, 0.13383,
                                    0.04823, 0.01566, 0.83777);
    const mat3 rgb_from_aces = mat3(1.60475, -0.10208, -0.00327,
                                    -0.53108, 1.10813, -0.07276,
                                    -0.07367, -0.00605, 1.07602);
    x = aces_from_rgb * x;
    x = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
    return rgb_from_aces * x;
}

// AgX (Sobotka 2022) in the polynomial form of Wrensch 2023, base look: a sigmoid over 16.5 stops of log2, between two
// matrices that desaturate bright colors. The result is encoded with gamma 2.2; the last line decodes it.
vec3 tonemap_agx(vec3 x) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                            0.0784335999999992, 0.878468636469772, 0.0784336,
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float min_ev = -12.47393, max_ev = 4.026069;
    // 1e-10: log2(0) is -infinity. It is far below min_ev, so the result does not change.
    vec3 stops = log2(max(inset * x, 1e-10));
    vec3 t = saturate((stops - min_ev) / (max_ev - min_ev));
    vec3 bent = ((((((15.5 * t - 40.14) * t + 31.96) * t - 6.868) * t + 0.4298) * t + 0.1191) * t) - 0.00232;
    return pow(max(outset * bent, 0.0), vec3(2.2));
}

// Khronos PBR Neutral (2024): below 0.76 it subtracts only the 0.04 that a dielectric reflects of white surroundings,
// so products show their base color. Above, it compresses the peak to 1 and desaturates.
vec3 tonemap_neutral(vec3 x) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float low = min_component(x);
    x -= low < 0.08 ? low - 6.25 * low * low : 0.04;
    float peak = max_component(x);
    if (peak < start) return x;
    float room = 1.0 - start;
    float new_peak = 1.0 - room * room / (peak + room - start);
    float keep = 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(vec3(new_peak), x * (new_peak / peak), keep);
}

// `x`: exposed light. Clamped to 0..1e6: the curves are defined for positive light only, and 1e6, whose square is still
// a float, is white on all of them. The result is clamped to 0..1.
vec3 tonemap(vec3 x, uint curve) {
    x = clamp(x, 0.0, 1e6);
    switch (curve) {
        case TONEMAP_REINHARD: x = tonemap_reinhard(x); break;
        case TONEMAP_REINHARD_LUMINANCE: x = tonemap_reinhard_luminance(x); break;
        case TONEMAP_UNCHARTED2: x = tonemap_uncharted2(x); break;
        case TONEMAP_ACES: x = tonemap_aces(x); break;
        case TONEMAP_ACES_HILL: x = tonemap_aces_hill(x); break;
        case TONEMAP_AGX: x = tonemap_agx(x); break;
        case TONEMAP_NEUTRAL: x = tonemap_neutral(x); break;
        default: break;   // TONEMAP_NONE clips
    }
    return saturate(x);
}

#endif
