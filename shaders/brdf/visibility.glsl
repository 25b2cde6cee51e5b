// G: the part of the microfacets that both the light and the eye can see. V is G over Cook & Torrance's denominator:
//
//   V = G / (4 NoL NoV)        f = F D G / (4 NoL NoV) = F D V
//
// V is what is computed, since NoL and NoV cancel: it stays finite where the quotient is 0 / 0.
#ifndef BRDF_VISIBILITY_GLSL
#define BRDF_VISIBILITY_GLSL

#include "brdf/models.glsl"
#include "common/math.glsl"

// A normal map can turn n away from the eye, where no BRDF is defined. Clamped, such a point is seen at a grazing
// angle, not as a black hole. 1e-4 is far under a degree; with MIN_ALPHA it keeps V's denominator above zero.
const float MIN_N_DOT_V = 1e-4;

// Smith's functions come from Lambda, how many facets hide another one for each that is seen. Written as
// c (1 + 2 Lambda) with the cosine c there is no tangent that grows to infinity.
//
// GGX: Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2 (Heitz 2014, eq. 72). a2 is alpha^2.
float smith_root_ggx(float c, float a2) { return sqrt(c * c * (1.0 - a2) + a2); }

// Beckmann, with a = 1 / (alpha tan): Lambda = (1 - 1.259 a + 0.396 a^2) / (3.535 a + 2.181 a^2) for a < 1.6, else 0
// (Walter et al. 2007, eq. 27, as a Lambda: Heitz 2014, section 5). The exact one has an error function; G1 is off by
// less than 0.4 %. The root is kept from 0 for c = 1, where a is infinite.
float smith_root_beckmann(float c, float a2) {
    float a = c * inversesqrt(max(a2 * (1.0 - c * c), 1e-12));
    if (a >= 1.6) return c;
    // c Lambda, with c / a cancelled: c -> 0 leaves sqrt(a2) / 3.535.
    float c_over_a = sqrt(a2 * (1.0 - c * c));
    return c + 2.0 * c_over_a * (1.0 + a * (0.396 * a - 1.259)) / (3.535 + 2.181 * a);
}

float smith_root(float c, float a2) { return NDF == BECKMANN ? smith_root_beckmann(c, a2) : smith_root_ggx(c, a2); }

// G = 1 / (1 + Lambda(l) + Lambda(v)) (Heitz 2014, eq. 99): a facet high enough to see the light is likely high
// enough to be seen. alpha -> 0: V = 1 / (4 NoL NoV). NoL = 0 leaves NoV alpha below the line: MIN_N_DOT_V and
// MIN_ALPHA keep it > 0.
float v_height_correlated(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    return 0.5 / (n_dot_v * smith_root(n_dot_l, a2_l) + n_dot_l * smith_root(n_dot_v, a2_v));
}

// G = G1(l) G1(v) with G1 = 1 / (1 + Lambda) = 2 c / (c + smith_root) (Walter et al. 2007, eq. 23 and 34; Heitz 2014,
// eq. 98; glTF 2.0, appendix B.3.2): as if the light and the eye had nothing to do with each other. Darker at grazing
// angles.
float v_separable(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    return 1.0 / ((n_dot_l + smith_root(n_dot_l, a2_l)) * (n_dot_v + smith_root(n_dot_v, a2_v)));
}

// G1 = c / (c (1 - k) + k) (Schlick 1994, eq. 19), without a root. k = alpha sqrt(2 / pi) is Schlick's, for Beckmann;
// k = alpha / 2 stands for GGX (Karis 2013, eq. 4, without his remapping of roughness). Neither hides less than Smith.
float v_schlick(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    float scale = NDF == BECKMANN ? 0.797885 : 0.5;
    float k_l = scale * sqrt(a2_l);
    float k_v = scale * sqrt(a2_v);
    return 0.25 / ((n_dot_l * (1.0 - k_l) + k_l) * (n_dot_v * (1.0 - k_v) + k_v));
}

// a2_l, a2_v: alpha^2 in the plane of n and l, and of n and v; they differ where the lobe is stretched.
float v_specular(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    if (MASKING_SHADOWING == SEPARABLE) return v_separable(n_dot_l, n_dot_v, a2_l, a2_v);
    if (MASKING_SHADOWING == SCHLICK_MASKING) return v_schlick(n_dot_l, n_dot_v, a2_l, a2_v);
    return v_height_correlated(n_dot_l, n_dot_v, a2_l, a2_v);
}

float v_specular(float n_dot_l, float n_dot_v, float alpha) {
    return v_specular(n_dot_l, n_dot_v, alpha * alpha, alpha * alpha);
}

// The roughness that w meets on a stretched surface (Heitz 2014, section 5), squared. w_ts: w along t, b and n. Along n
// every direction is as good: 1e-7, one rounding of 1, is what the sine may be off by there.
float a2_towards(vec3 w_ts, vec2 alpha) {
    vec2 stretched = w_ts.xy * alpha;
    return dot(stretched, stretched) / max(dot(w_ts.xy, w_ts.xy), 1e-7);
}

#endif
