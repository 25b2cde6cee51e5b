// Measured BRDFs: tables of reflectance measured on real materials, as references for the analytic BRDF.
//
//   MERL (Matusik et al. 2003): isotropic, over half and difference angles, 90 x 90 x 180 bins
//   UTIA (Filip & Vavra 2014): anisotropic, over the angles of light and view, (6 x 48) x (6 x 48) directions
//
// src/scene/measured builds the table (RGB, 1/sr) and documents the file formats; its `evaluate` does the same lookup
// on the CPU. All lookups are linear in every angle.
#ifndef BRDF_MEASURED_GLSL
#define BRDF_MEASURED_GLSL

#include "interface.glsl"
#include "common/color.glsl"
#include "common/math.glsl"

layout(set = SET_FRAME, binding = BINDING_MEASURED, scalar) readonly buffer Measured {
    uint measured_kind;        // MEASURED_*
    float measured_values[];   // RGB triples
};

const uint MERL_THETA_H = 90u;
const uint MERL_THETA_D = 90u;
const uint MERL_PHI_D = 180u;
const uint UTIA_THETA = 6u;
const uint UTIA_PHI = 48u;

// Two neighboring samples of one angle and the interpolation factor between them.
struct MeasuredBetween {
    uint low;
    uint high;
    float t;
};

// x: position in samples, clamped to the first and last sample.
MeasuredBetween measured_clamped(float x, uint count) {
    x = clamp(x, 0.0, float(count - 1u));
    uint low = min(uint(x), count - 2u);
    return MeasuredBetween(low, low + 1u, x - float(low));
}

// x: position in samples, -1 <= x <= count; wraps around.
MeasuredBetween measured_around(float x, uint count) {
    float low = floor(x);
    uint index = uint(low + float(count)) % count;
    return MeasuredBetween(index, (index + 1u) % count, x - low);
}

vec3 measured_rgb(uint cell) {
    return vec3(measured_values[3u * cell], measured_values[3u * cell + 1u], measured_values[3u * cell + 2u]);
}

vec3 merl_row(uint theta_h, uint theta_d, MeasuredBetween phi_d) {
    uint row = (theta_h * MERL_THETA_D + theta_d) * MERL_PHI_D;
    return mix(measured_rgb(row + phi_d.low), measured_rgb(row + phi_d.high), phi_d.t);
}

// Half and difference angles (Rusinkiewicz 1998): h is the half vector; after the rotation that takes h to the normal,
// l is at (theta_d, phi_d). An isotropic BRDF does not depend on phi_h. By reciprocity phi_d and phi_d + pi are equal.
//
//   l + v = 2 cos(theta_d) h        l - v = 2 sin(theta_d) (across h, towards phi_d)
//
// All angles come from arctangents, which stay exact at the highlight's peak; acos(n . h) is off by whole bins there.
// Samples are bin centers: 1 degree of theta_d and phi_d, theta_h = 90 (i / 90)^2 degrees.
vec3 f_merl(vec3 l, vec3 v) {
    vec3 sum = l + v;
    vec3 difference = l - v;
    float aside = length(sum.xy);
    float theta_h = atan(aside, sum.z);
    float theta_d = atan(length(difference), length(sum));

    // Components along the meridian through h and across it. At the pole any meridian will do: this takes x.
    vec2 meridian = aside > 0.0 ? sum.xy / aside : vec2(1.0, 0.0);
    float along = dot(difference, vec3(cos(theta_h) * meridian, -sin(theta_h)));
    float across = dot(difference.xy, vec2(-meridian.y, meridian.x));
    // l = v leaves phi_d undefined, as is atan(0, 0).
    float phi_d = along == 0.0 && across == 0.0 ? 0.0 : atan(across, along);
    phi_d += phi_d < 0.0 ? PI : 0.0;

    MeasuredBetween h = measured_clamped(float(MERL_THETA_H) * sqrt(theta_h / (0.5 * PI)) - 0.5, MERL_THETA_H);
    MeasuredBetween d = measured_clamped(float(MERL_THETA_D) * theta_d / (0.5 * PI) - 0.5, MERL_THETA_D);
    MeasuredBetween phi = measured_around(float(MERL_PHI_D) * phi_d / PI - 0.5, MERL_PHI_D);
    return mix(mix(merl_row(h.low, d.low, phi), merl_row(h.low, d.high, phi), d.t),
               mix(merl_row(h.high, d.low, phi), merl_row(h.high, d.high, phi), d.t), h.t);
}

MeasuredBetween utia_theta(vec3 w) {
    return measured_clamped(atan(length(w.xy), w.z) / radians(15.0), UTIA_THETA);
}

MeasuredBetween utia_phi(vec3 w) {
    // phi is undefined at the pole, as is atan(0, 0).
    float phi = w.x == 0.0 && w.y == 0.0 ? 0.0 : atan(w.y, w.x);
    phi += phi < 0.0 ? 2.0 * PI : 0.0;
    return measured_around(phi / radians(7.5), UTIA_PHI);
}

vec3 utia_light(uint light, MeasuredBetween theta_v, MeasuredBetween phi_v) {
    uint row = light * UTIA_THETA * UTIA_PHI;
    uint low = row + theta_v.low * UTIA_PHI;
    uint high = row + theta_v.high * UTIA_PHI;
    return mix(mix(measured_rgb(low + phi_v.low), measured_rgb(low + phi_v.high), phi_v.t),
               mix(measured_rgb(high + phi_v.low), measured_rgb(high + phi_v.high), phi_v.t), theta_v.t);
}

vec3 utia_ring(uint theta, MeasuredBetween phi, MeasuredBetween theta_v, MeasuredBetween phi_v) {
    uint ring = theta * UTIA_PHI;
    return mix(utia_light(ring + phi.low, theta_v, phi_v), utia_light(ring + phi.high, theta_v, phi_v), phi.t);
}

// Samples every 15 degrees of theta and 7.5 of phi. The last, at theta = 75 degrees, is used up to the horizon.
vec3 f_utia(vec3 l, vec3 v) {
    MeasuredBetween theta = utia_theta(l), phi = utia_phi(l), theta_v = utia_theta(v), phi_v = utia_phi(v);
    return mix(utia_ring(theta.low, phi, theta_v, phi_v), utia_ring(theta.high, phi, theta_v, phi_v), theta.t);
}

// f(l, v) in 1/sr; black if no measured BRDF is loaded or l is below the horizon. All vectors are in world space; l, v
// and n are unit and point away from the surface. Only UTIA uses t (tangent, phi = 0) and b (bitangent, phi = 90
// degrees): t is made perpendicular to n, and b gives the sense of phi.
vec3 f_measured(vec3 l, vec3 v, vec3 n, vec3 t, vec3 b) {
    float n_dot_l = dot(n, l);
    if (measured_kind == MEASURED_NONE || !(n_dot_l > 0.0)) return vec3(0.0);
    vec3 axis = abs(n.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    t = safe_normalize(t - n * dot(n, t), normalize(axis - n * dot(n, axis)));
    vec3 across = cross(n, t);
    b = dot(across, b) < 0.0 ? -across : across;
    // A normal map can turn n away from the eye. v is then mirrored, as in evaluate_brdf.
    vec3 v_ts = normalize(vec3(dot(t, v), dot(b, v), max(abs(dot(n, v)), 1e-4)));
    vec3 l_ts = vec3(dot(t, l), dot(b, l), n_dot_l);
    return measured_kind == MEASURED_MERL ? f_merl(l_ts, v_ts) : f_utia(l_ts, v_ts);
}

// The error of the analytic BRDF in stops of luminance; both arguments in 1/sr.
//
//   e = log2((Y_analytic + eps) / (Y_measured + eps))        0 equal, 1 twice as bright, -1 half as bright
//
// For small errors, e ln 2 is the relative error (Y_analytic - Y_measured) / Y_measured; unlike that, e weighs too dark
// and too bright alike. eps = 1e-3, a Lambertian albedo of 0.3 % (blacker than black velvet), makes values far below it
// count as equal; otherwise the measurement's noise would dominate there.
float relative_error(vec3 measured, vec3 analytic) {
    const float eps = 1e-3;
    return log2((max(luminance(analytic), 0.0) + eps) / (max(luminance(measured), 0.0) + eps));
}

// Green: equal. Cyan, blue: the analytic BRDF is darker, by half a stop, by one or more. Yellow, red: it is brighter,
// by half a stop, by one or more. Differences in hue alone do not show.
vec3 relative_error_color(vec3 measured, vec3 analytic) { return heat(0.5 + 0.5 * relative_error(measured, analytic)); }

#endif
