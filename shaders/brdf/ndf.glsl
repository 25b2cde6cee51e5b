// D: the normal distribution function, the density of microfacets whose normal is h.
#ifndef BRDF_NDF_GLSL
#define BRDF_NDF_GLSL

#include "brdf/models.glsl"
#include "common/math.glsl"

// GGX, a rediscovery of Trowbridge & Reitz 1975 (Walter et al. 2007, eq. 33), in 1/sr:
//
//                alpha^2
//   D = ---------------------------      integral of D NoH over the hemisphere = 1
//       pi (NoH^2 alpha^2 + sin^2)^2
//
// alpha = 1 -> D = 1 / pi in every direction; the peak at NoH = 1 is 1 / (pi alpha^2), so alpha must not be 0
// (MIN_ALPHA). Its tail is longer than Beckmann's, which gives highlights their glow.
//
// sin2_h: sin^2 of the angle between n and h, from sin2_between. Computed as 1 - NoH^2, it would be off by a percent:
// the highlight at alpha = 0.0025 ends where sin2_h is 6e-6, and a float close to 1 has an error of 6e-8.
float d_ggx(float n_dot_h, float sin2_h, float alpha) {
    float a2 = alpha * alpha;
    float spread = n_dot_h * n_dot_h * a2 + sin2_h;
    return a2 / (PI * spread * spread);
}

// The same, anisotropic: alpha.x along t, alpha.y along b (Burley 2012, eq. 13). h_ts: h along t, b and n.
//
//   D = 1 / (pi alpha_t alpha_b (ToH^2 / alpha_t^2 + BoH^2 / alpha_b^2 + NoH^2)^2)
//
// alpha_t = alpha_b -> d_ggx, since ToH^2 + BoH^2 = sin^2.
float d_ggx_anisotropic(vec3 h_ts, vec2 alpha) {
    vec3 stretched = vec3(h_ts.xy / alpha, h_ts.z);
    float spread = dot(stretched, stretched);
    return 1.0 / (PI * alpha.x * alpha.y * spread * spread);
}

// Beckmann & Spizzichino 1963 (Walter et al. 2007, eq. 25): normally distributed slopes.
//
//   D = exp(-tan^2 / alpha^2) / (pi alpha^2 NoH^4)        tan^2 = ToH^2 + BoH^2 over NoH^2
//
// NoH = 0 -> D = 0. The quotient would be 0 / 0 there, so NoH is clamped to 1e-3, where the exponent is below
// -1e6 / alpha^2.
float d_beckmann_anisotropic(vec3 h_ts, vec2 alpha) {
    float cos2 = max(h_ts.z * h_ts.z, 1e-6);
    vec2 slope = h_ts.xy / alpha;
    return exp(-dot(slope, slope) / cos2) / (PI * alpha.x * alpha.y * cos2 * cos2);
}

float d_beckmann(float n_dot_h, float sin2_h, float alpha) {
    return d_beckmann_anisotropic(vec3(sqrt(sin2_h), 0.0, n_dot_h), vec2(alpha));
}

float d_specular(float n_dot_h, float sin2_h, float alpha) {
    return NDF == BECKMANN ? d_beckmann(n_dot_h, sin2_h, alpha) : d_ggx(n_dot_h, sin2_h, alpha);
}

float d_specular(float n_dot_h, float alpha) { return d_specular(n_dot_h, 1.0 - n_dot_h * n_dot_h, alpha); }

float d_specular_anisotropic(vec3 h_ts, vec2 alpha) {
    return NDF == BECKMANN ? d_beckmann_anisotropic(h_ts, alpha) : d_ggx_anisotropic(h_ts, alpha);
}

#endif
