// Modes of the group Truth: they flag invalid or implausible values. Valid pixels stay dark, so that a single bad one
// is visible.
#ifndef DEBUG_TRUTH_GLSL
#define DEBUG_TRUTH_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "debug/surface.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material/material.glsl"

const vec3 TOO_LOW = vec3(0.05, 0.15, 1.0);
const vec3 TOO_HIGH = vec3(1.0, 0.06, 0.03);

// Dimmed luminance of the picture, below 1/4, as the background of warnings.
vec3 dimmed(vec3 radiance) {
    float seen = max(luminance(radiance) * frame.exposure, 0.0);
    return vec3(0.25 * seen / (1.0 + seen));
}

vec3 nan_value(vec3 radiance) {
    if (any(isnan(radiance))) return number_or_color(1u, vec3(1.0, 0.0, 1.0));
    if (any(isinf(radiance))) return number_or_color(2u, vec3(1.0, 1.0, 0.0));
    if (any(lessThan(radiance, vec3(0.0)))) return number_or_color(3u, vec3(0.0, 1.0, 1.0));
    return number_or_color(0u, dimmed(radiance));
}

// The marked channels. As a number: 1 red + 2 green + 4 blue.
vec3 marked_channels(bvec3 marked, vec3 radiance) {
    uint number = uint(marked.r) + 2u * uint(marked.g) + 4u * uint(marked.b);
    return number_or_color(number, any(marked) ? vec3(marked) : dimmed(radiance));
}

vec3 negative_value(vec3 radiance) { return marked_channels(lessThan(radiance, vec3(0.0)), radiance); }

vec3 clipped_value(vec3 radiance) {
    return marked_channels(greaterThan(radiance * frame.exposure, vec3(1.0)), radiance);
}

// Stops above and below 18 % gray, the mean reflectance that light meters assume.
float stops_from_gray(vec3 radiance) {
    // 1e-6: log2(0) is -infinity; 17 stops below gray is off the scale anyway.
    float seen = max(luminance(radiance) * frame.exposure, 1e-6);
    return log2(seen / 0.18);
}

// No common dielectric is darker than charcoal (sRGB 30) or lighter than fresh snow (240) (McDermott 2018, The PBR
// Guide). A metal's base color is not an albedo, so the check applies only below metallic 0.5.
vec3 albedo_range_value(Surface s) {
    vec3 srgb = srgb_from_linear(s.base_color) * 255.0;
    if (s.metallic < 0.5 && max_component(srgb) < 30.0) return number_or_color(1u, TOO_LOW);
    if (s.metallic < 0.5 && max_component(srgb) > 240.0) return number_or_color(2u, TOO_HIGH);
    return number_or_color(0u, vec3(0.25 * luminance(s.base_color)));
}

// At normal incidence dielectrics reflect 2 to 5 % and metals sRGB 180 or more (McDermott 2018). Values between are
// suspect: such a metal is covered by dirt or rust, which are dielectrics and need a lower `metallic`.
vec3 f0_range_value(Surface s) {
    float f0 = max_component(f0_of(s));
    if (f0 < 0.02) return number_or_color(1u, TOO_LOW);
    float metal = linear_from_srgb(vec3(180.0 / 255.0)).r;
    if (f0 > 0.05 && f0 < metal) return number_or_color(2u, TOO_HIGH);
    return number_or_color(0u, vec3(0.25 * f0));
}

// `lit` and `radiance`: the picture.
bool debug_truth(Surface s, vec3 v, Lit lit, vec3 radiance, out vec3 value) {
    bool known = true;
    if (MODE == MODE_NAN) value = nan_value(radiance);
    else if (MODE == MODE_NEGATIVE) value = negative_value(radiance);
    else if (MODE == MODE_CLIPPED) value = clipped_value(radiance);
    else if (MODE == MODE_FALSE_COLOR) value = vec3(stops_from_gray(radiance));
    else if (MODE == MODE_ALBEDO_RANGE) value = albedo_range_value(s);
    else if (MODE == MODE_F0_RANGE) value = f0_range_value(s);
    else known = false;
    return known;
}

#endif
