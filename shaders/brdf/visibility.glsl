// G: the part of the microfacets that both the light and the eye can see. V is G over Cook & Torrance's denominator:
//
//   V = G / (4 NoL NoV)        f = F D G / (4 NoL NoV) = F D V
//
// V is what is computed, since NoL and NoV cancel: it stays finite where the quotient is 0 / 0.
#ifndef BRDF_VISIBILITY_GLSL
#define BRDF_VISIBILITY_GLSL

#include "interface.glsl"

const uint HEIGHT_CORRELATED = 0u;
const uint SEPARABLE = 1u;

layout(constant_id = USER_CONSTANTS + 0) const uint MASKING_SHADOWING = 0u;   //@ui "Masking-shadowing" choice HeightCorrelated=0 Separable=1

// Both forms below are Smith's with GGX's Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2 (Heitz 2014, eq. 72). Written
// with the cosine c this is 1 + 2 Lambda = smith_root / c, without a tangent that grows to infinity.
float smith_root(float c, float a2) { return sqrt(c * c * (1.0 - a2) + a2); }

// G = 1 / (1 + Lambda(l) + Lambda(v)) (Heitz 2014, eq. 99): a facet high enough to see the light is likely high
// enough to be seen. alpha -> 0: V = 1 / (4 NoL NoV). NoL = 0 leaves NoV alpha below the line: MIN_N_DOT_V and
// MIN_ALPHA keep it > 0.
float v_smith_height_correlated(float n_dot_l, float n_dot_v, float alpha) {
    float a2 = alpha * alpha;
    return 0.5 / (n_dot_v * smith_root(n_dot_l, a2) + n_dot_l * smith_root(n_dot_v, a2));
}

// G = G1(l) G1(v) with G1 = 2 c / (c + smith_root) (Walter et al. 2007, eq. 23 and 34; Heitz 2014, eq. 98; glTF 2.0,
// appendix B.3.2): as if the light and the eye had nothing to do with each other. Darker at grazing angles.
float v_smith_separable(float n_dot_l, float n_dot_v, float alpha) {
    float a2 = alpha * alpha;
    return 1.0 / ((n_dot_l + smith_root(n_dot_l, a2)) * (n_dot_v + smith_root(n_dot_v, a2)));
}

float v_smith_ggx(float n_dot_l, float n_dot_v, float alpha) {
    return MASKING_SHADOWING == SEPARABLE ? v_smith_separable(n_dot_l, n_dot_v, alpha)
                                          : v_smith_height_correlated(n_dot_l, n_dot_v, alpha);
}

#endif
