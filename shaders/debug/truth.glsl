// Modes of the group Truth: they flag invalid or implausible values. Valid pixels stay dark, so that a single bad one
// is visible.
#ifndef DEBUG_TRUTH_GLSL
#define DEBUG_TRUTH_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"
#include "common/math.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "debug/surface.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material/material.glsl"

const vec3 TOO_LOW = vec3(0.05, 0.15, 1.0);
const vec3 TOO_HIGH = vec3(1.0, 0.06, 0.03);
const vec3 OUT_OF_RANGE = vec3(1.0, 0.22, 0.0);

// Dimmed luminance of the picture, below 1/4, as the background of warnings.
vec3 dimmed(vec3 radiance) {
    float seen = max(luminance(radiance) * frame.exposure, 0.0);
    return vec3(0.25 * seen / (1.0 + seen));
}

bool is_part(float x) { return x >= 0.0 && x <= 1.0; }
bool is_part(vec3 x) { return all(greaterThanEqual(x, vec3(0.0))) && all(lessThanEqual(x, vec3(1.0))); }
bool is_unit(vec3 x) { return abs(dot(x, x) - 1.0) < 0.01; }

// Whether every value of the surface is one that a material can have: parts and reflectances within 0..1, amounts not negative,
// an index of at least 1 (or 0, which stands for infinity), and unit normals. NaN is none. Files are checked when they are read, so
// only an edit gives others.
bool is_material(Surface s) {
    bool is_base = is_part(s.base_color) && is_part(s.metallic) && is_part(s.roughness) && is_part(s.coverage)
                && is_part(s.occlusion) && is_part(s.f0) && is_part(s.f90) && (s.ior >= 1.0 || s.ior == 0.0)
                && min_component(s.emissive) >= 0.0 && is_unit(s.n);
    bool are_layers = is_part(s.anisotropy) && is_part(s.clearcoat) && is_part(s.clearcoat_roughness) && is_unit(s.clearcoat_n)
                   && is_part(s.sheen_color) && is_part(s.sheen_roughness) && is_part(s.iridescence)
                   && s.iridescence_ior >= 1.0 && s.iridescence_nm >= 0.0;
    bool is_volume = is_part(s.transmission) && s.thickness >= 0.0 && is_part(s.attenuation_color) && s.attenuation_distance > 0.0
                  && s.dispersion >= 0.0 && is_part(s.diffuse_transmission) && is_part(s.diffuse_transmission_color);
    return is_base && are_layers && is_volume;
}

vec3 nan_value(Surface s, vec3 radiance) {
    if (any(isnan(radiance))) return number_or_color(1u, vec3(1.0, 0.0, 1.0));
    if (any(isinf(radiance))) return number_or_color(2u, vec3(1.0, 1.0, 0.0));
    if (any(lessThan(radiance, vec3(0.0)))) return number_or_color(3u, vec3(0.0, 1.0, 1.0));
    if (!is_material(s)) return number_or_color(4u, OUT_OF_RANGE);
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
// Guide). A metal's base color is not an albedo, so these limits apply only below metallic 0.5. But no surface reflects less than
// nothing or more than it receives.
vec3 albedo_range_value(Surface s) {
    if (min_component(s.base_color) < 0.0) return number_or_color(1u, TOO_LOW);
    if (max_component(s.base_color) > 1.0) return number_or_color(2u, TOO_HIGH);
    vec3 srgb = srgb_from_linear(s.base_color) * 255.0;
    if (s.metallic < 0.5 && max_component(srgb) < 30.0) return number_or_color(1u, TOO_LOW);
    if (s.metallic < 0.5 && max_component(srgb) > 240.0) return number_or_color(2u, TOO_HIGH);
    return number_or_color(0u, vec3(0.25 * luminance(s.base_color)));
}

// At normal incidence dielectrics reflect 2 to 5 % and metals sRGB 180 or more (McDermott 2018). Values between are
// suspect: such a metal is covered by dirt or rust, which are dielectrics and need a lower `metallic`. Above 1 is impossible.
vec3 f0_range_value(Surface s) {
    float f0 = max_component(f0_of(s));
    if (f0 < 0.02 || min_component(f0_of(s)) < 0.0) return number_or_color(1u, TOO_LOW);
    float metal = linear_from_srgb(vec3(180.0 / 255.0)).r;
    if ((f0 > 0.05 && f0 < metal) || f0 > 1.0) return number_or_color(2u, TOO_HIGH);
    return number_or_color(0u, vec3(0.25 * f0));
}

// `lit` and `radiance`: the picture.
bool debug_truth(Surface s, vec3 v, Lit lit, vec3 radiance, out vec3 value) {
    bool known = true;
    if (MODE == MODE_NAN) value = nan_value(s, radiance);
    else if (MODE == MODE_NEGATIVE) value = negative_value(radiance);
    else if (MODE == MODE_CLIPPED) value = clipped_value(radiance);
    else if (MODE == MODE_FALSE_COLOR) value = vec3(stops_from_gray(radiance));
    else if (MODE == MODE_ALBEDO_RANGE) value = albedo_range_value(s);
    else if (MODE == MODE_F0_RANGE) value = f0_range_value(s);
    else known = false;
    return known;
}

#endif
