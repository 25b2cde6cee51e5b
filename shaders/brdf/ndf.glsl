// D: the normal distribution function. Of all microfacets, how many face h?
#ifndef BRDF_NDF_GLSL
#define BRDF_NDF_GLSL

#include "common/math.glsl"

// GGX, which is Trowbridge & Reitz 1975 rediscovered (Walter et al. 2007, eq. 33), in 1/sr:
//
//                alpha^2
//   D = ---------------------------      integral of D NoH over the hemisphere = 1
//       pi (NoH^2 (alpha^2 - 1) + 1)^2
//
// alpha = 1 -> D = 1 / pi in every direction; the peak at NoH = 1 is 1 / (pi alpha^2), so alpha must not be 0
// (MIN_ALPHA). The tail is longer than Beckmann's: that is the glow around a highlight.
float d_ggx(float n_dot_h, float alpha) {
    float a2 = alpha * alpha;
    float spread = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
    return a2 / (PI * spread * spread);
}

#endif
