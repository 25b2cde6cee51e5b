// F: the part of the light that a smooth boundary reflects. It rises to 1 at grazing angles, whatever the material.
// c is the cosine to the boundary's normal; for microfacets that is h, so c = VoH = LoH.
#ifndef BRDF_FRESNEL_GLSL
#define BRDF_FRESNEL_GLSL

#include "common/math.glsl"

// F = F0 + (F90 - F0) (1 - c)^5 (Schlick 1994, eq. 15, where F90 = 1). c = 1 -> F0, c = 0 -> F90.
// Glass (index of refraction 1.5): off the full equations by at most 0.036, at 85 degrees. Metals such as aluminum dip
// before they rise; this does not.
vec3 f_schlick(vec3 f0, vec3 f90, float c) { return f0 + (f90 - f0) * pow5(1.0 - c); }
float f_schlick(float f0, float c) { return f0 + (1.0 - f0) * pow5(1.0 - c); }

// Reflectance along the normal, ((n - 1) / (n + 1))^2; n = 1.5 -> 0.04. KHR_materials_ior's 0 stands for infinity and
// needs no case of its own: both give 1.
float f0_from_ior(float ior) {
    float ratio = (ior - 1.0) / (ior + 1.0);
    return ratio * ratio;
}

// A dielectric by Fresnel 1823, both polarizations averaged, with g^2 = n^2 - 1 + c^2 (Walter et al. 2007, eq. 22):
//
//   F = 1/2 ((g - c) / (g + c))^2 (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2)
//
// g^2 < 0: total reflection. n = 1: g = c, F = 0 but for c = 0; 1e-6 keeps that one divisible.
float f_dielectric_exact(float ior, float c) {
    float g2 = ior * ior - 1.0 + c * c;
    if (g2 <= 0.0) return 1.0;
    float g = sqrt(g2);
    float s = (g - c) / max(g + c, 1e-6);
    float p = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * s * s * (1.0 + p * p);
}

// F of a dielectric over the hemisphere, 2 integral F c dc: our fit in t = sqrt F0, off by less than 0.001 for n from
// 1.2 to 2.6. n = 1.5 -> 0.0918.
float f_dielectric_average(float ior) {
    float t = (ior - 1.0) / (ior + 1.0);
    return saturate(t * (0.5129 + t * (1.1584 * t - 0.4833)));
}

// A metal with the complex index n + i k: the same boundary, where the wave dies away (Born & Wolf 1999, section 14.4).
//
//   a^2 + b^2 = sqrt((n^2 - k^2 - sin^2)^2 + 4 n^2 k^2)        2 a^2 = a^2 + b^2 + n^2 - k^2 - sin^2
//   F_s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2)
//   F_p = F_s (c^2 (a^2 + b^2) - 2 a c sin^2 + sin^4) / (c^2 (a^2 + b^2) + 2 a c sin^2 + sin^4)
//
// k = 0 -> the dielectric. Rounding may leave a little less than 0 under the second root.
vec3 f_conductor(vec3 n, vec3 k, float c) {
    float cos2 = c * c;
    float sin2 = 1.0 - cos2;
    vec3 difference = n * n - k * k - sin2;
    vec3 sum = sqrt(difference * difference + 4.0 * n * n * k * k);
    vec3 ac2 = 2.0 * c * sqrt(max(0.5 * (sum + difference), 0.0));
    vec3 s = (sum + cos2 - ac2) / (sum + cos2 + ac2);
    vec3 p = (cos2 * sum + sin2 * sin2 - ac2 * sin2) / (cos2 * sum + sin2 * sin2 + ac2 * sin2);
    return saturate(0.5 * s * (1.0 + p));
}

// n and k of a metal that is known by its color alone (Gulbrandsen 2014): F0 leaves one of the two free, and
// the edge tint g, 0..1, chooses it: n from the largest, (1 + sqrt F0) / (1 - sqrt F0), to the smallest,
// (1 - F0) / (1 + F0). No finite n reflects all; 0.999 keeps both within what floats can hold.
void complex_ior(vec3 f0, vec3 edge_tint, out vec3 n, out vec3 k) {
    f0 = min(f0, 0.999);
    vec3 root = sqrt(f0);
    n = mix((1.0 + root) / (1.0 - root), (1.0 - f0) / (1.0 + f0), edge_tint);
    vec3 n_plus = n + 1.0;
    vec3 n_minus = n - 1.0;
    k = sqrt(max((f0 * n_plus * n_plus - n_minus * n_minus) / (1.0 - f0), 0.0));
}

// How far Schlick overshoots a metal (Kutz, Hasan & Edmondson 2021, "F82-tint", after Lazanyi & Szirmay-Kalos 2005):
//
//   F = F0 + (1 - F0) (1 - c)^5 - beta c (1 - c)^6        beta such that F(82 degrees) = f82
//
// The last term is largest at c = 1 / 7, or 82 degrees, so that is where it is measured: 1/7 (6/7)^6 = 0.0566528.
const float COS_82 = 1.0 / 7.0;
vec3 f82_beta(vec3 f0, vec3 f82) { return (f_schlick(f0, vec3(1.0), COS_82) - f82) / 0.0566528; }

#endif
