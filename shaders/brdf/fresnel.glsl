// F: the fraction of light that a smooth boundary reflects. It rises to 1 at grazing angles for every material. c is
// the cosine to the boundary's normal, which for microfacets is h: c = VoH = LoH.
#ifndef BRDF_FRESNEL_GLSL
#define BRDF_FRESNEL_GLSL

#include "common/math.glsl"

// F = F0 + (F90 - F0) (1 - c)^5 (Schlick 1994, eq. 15, where F90 = 1). c = 1 -> F0, c = 0 -> F90. For glass (index of
// refraction 1.5) the error against the exact equations is at most 0.036, at 85 degrees. Metals such as aluminum dip
// before they rise; Schlick's curve does not.
vec3 f_schlick(vec3 f0, vec3 f90, float c) { return f0 + (f90 - f0) * pow5(1.0 - c); }
float f_schlick(float f0, float c) { return f_schlick(vec3(f0), vec3(1.0), c).x; }

// Reflectance at normal incidence, ((n - 1) / (n + 1))^2; n = 1.5 -> 0.04. KHR_materials_ior uses 0 for an infinite
// index, which needs no special case: both give 1.
float f0_from_ior(float ior) {
    float ratio = (ior - 1.0) / (ior + 1.0);
    return ratio * ratio;
}

// The inverse, (1 + sqrt F0) / (1 - sqrt F0), for F0 < 1.
float ior_from_f0(float f0) { return (1.0 + sqrt(f0)) / (1.0 - sqrt(f0)); }

// The direction of the refracted ray below a surface seen from v, unit (Snell's law). An infinite ior (0 in glTF) refracts to
// -n. max: an ior below 1 could cause total reflection, which has no refracted ray. It does not matter on which side of
// n's plane v lies.
vec3 refracted(vec3 n, vec3 v, float ior) { return refract(-v, n, ior > 0.0 ? 1.0 / max(ior, 1.0) : 0.0); }

// A dielectric, by Fresnel 1823, unpolarized, with g^2 = n^2 - 1 + c^2 (Walter et al. 2007, eq. 22):
//
//   F = 1/2 ((g - c) / (g + c))^2 (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2)
//
// g^2 <= 0: total internal reflection. n = 1 -> F = 0; 1e-6 keeps the first quotient finite as c -> 0.
float f_dielectric_exact(float ior, float c) {
    float g2 = ior * ior - 1.0 + c * c;
    if (g2 <= 0.0) return 1.0;
    float g = sqrt(g2);
    float root_s = (g - c) / max(g + c, 1e-6);
    float root_ratio = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * root_s * root_s * (1.0 + root_ratio * root_ratio);
}

// A conductor with the complex index of refraction n + i k (Born & Wolf 1999, section 14.4).
//
//   a^2 + b^2 = sqrt((n^2 - k^2 - sin^2)^2 + 4 n^2 k^2)        2 a^2 = a^2 + b^2 + n^2 - k^2 - sin^2
//   F_s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2)
//   F_p = F_s (c^2 (a^2 + b^2) - 2 a c sin^2 + sin^4) / (c^2 (a^2 + b^2) + 2 a c sin^2 + sin^4)
//
// k = 0 -> the dielectric. max: rounding can make the second radicand slightly negative.
vec3 f_conductor(vec3 n, vec3 k, float c) {
    float cos2 = c * c;
    float sin2 = 1.0 - cos2;
    vec3 difference = n * n - k * k - sin2;
    vec3 sum = sqrt(difference * difference + 4.0 * n * n * k * k);
    vec3 ac2 = 2.0 * c * sqrt(max(0.5 * (sum + difference), 0.0));
    vec3 f_s = (sum + cos2 - ac2) / (sum + cos2 + ac2);
    vec3 ratio = (cos2 * sum + sin2 * sin2 - ac2 * sin2) / (cos2 * sum + sin2 * sin2 + ac2 * sin2);
    return saturate(0.5 * f_s * (1.0 + ratio));
}

// n and k of a metal from its color alone (Gulbrandsen 2014). F0 leaves one of the two free; the edge tint g, 0..1,
// selects n between its largest value, (1 + sqrt F0) / (1 - sqrt F0), and its smallest, (1 - F0) / (1 + F0). No finite
// n gives F0 = 1, so F0 is limited to 0.999.
void complex_ior(vec3 f0, vec3 edge_tint, out vec3 n, out vec3 k) {
    f0 = min(f0, 0.999);
    vec3 root = sqrt(f0);
    n = mix((1.0 + root) / (1.0 - root), (1.0 - f0) / (1.0 + f0), edge_tint);
    vec3 n_plus = n + 1.0;
    vec3 n_minus = n - 1.0;
    k = sqrt(max((f0 * n_plus * n_plus - n_minus * n_minus) / (1.0 - f0), 0.0));
}

// A metal by its reflectance at 0 and at 82 degrees (Kutz, Hasan & Edmondson 2021, "F82-tint", after Lazanyi &
// Szirmay-Kalos 2005):
//
//   F = F0 + (1 - F0) (1 - c)^5 - beta c (1 - c)^6        beta such that F(82 degrees) = f82
//
// The last term peaks at c = 1 / 7 (82 degrees), so beta is fitted there: 1/7 (6/7)^6 = 0.0566528.
const float COS_82 = 1.0 / 7.0;
vec3 f_82(vec3 f0, vec3 f82, float c) {
    vec3 beta = (f_schlick(f0, vec3(1.0), COS_82) - f82) / 0.0566528;
    float x = 1.0 - c;
    return saturate(f_schlick(f0, vec3(1.0), c) - beta * (c * pow5(x) * x));
}

#endif
