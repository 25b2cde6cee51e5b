// G: masking-shadowing, the fraction of microfacets visible to both the light and the eye. V divides G by Cook &
// Torrance's denominator:
//
//   V = G / (4 NoL NoV)        f = F D G / (4 NoL NoV) = F D V
//
// The functions compute V directly, since NoL and NoV cancel: V stays finite where the quotient is 0 / 0.
#ifndef BRDF_VISIBILITY_GLSL
#define BRDF_VISIBILITY_GLSL

#include "brdf/models.glsl"
#include "common/math.glsl"

// A normal map can turn n away from the eye, where no BRDF is defined. All shading mirrors v at the plane of n there
// (mirrored_to_front), so that NoV is |n . v|, as KHR_materials_clearcoat has it, and reflections stay above the surface.
// The clamp to 1e-4, which is far below a degree, keeps V's denominator above zero, together with MIN_ALPHA.
const float MIN_N_DOT_V = 1e-4;
float n_dot_v_of(vec3 n, vec3 v) { return clamp(abs(dot(n, v)), MIN_N_DOT_V, 1.0); }

// Smith's functions use Lambda, the ratio of masked to visible microfacets. Written as c (1 + 2 Lambda) with the cosine
// c, they contain no tangent that diverges.
//
// GGX: Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2 (Heitz 2014, eq. 72). a2 is alpha^2.
float smith_root_ggx(float c, float a2) { return sqrt(c * c * (1.0 - a2) + a2); }

// Beckmann, with a = 1 / (alpha tan): Lambda = (1 - 1.259 a + 0.396 a^2) / (3.535 a + 2.181 a^2) for a < 1.6, else 0
// (Walter et al. 2007, eq. 27, as a Lambda: Heitz 2014, section 5). The exact Lambda contains an error function; the
// error in G1 is below 0.4 %. 1e-12 keeps a finite at c = 1.
float smith_root_beckmann(float c, float a2) {
    float a = c * inversesqrt(max(a2 * (1.0 - c * c), 1e-12));
    if (a >= 1.6) return c;
    // c Lambda with c / a cancelled: sqrt(a2) / 3.535 as c -> 0.
    float c_over_a = sqrt(a2 * (1.0 - c * c));
    return c + 2.0 * c_over_a * (1.0 + a * (0.396 * a - 1.259)) / (3.535 + 2.181 * a);
}

float smith_root(float c, float a2) { return NDF == BECKMANN ? smith_root_beckmann(c, a2) : smith_root_ggx(c, a2); }

// G = 1 / (1 + Lambda(l) + Lambda(v)) (Heitz 2014, eq. 99): a facet high enough to be lit is likely high enough to be
// seen. alpha -> 0: V = 1 / (4 NoL NoV). NoL = 0 leaves the denominator NoV alpha, which MIN_N_DOT_V and MIN_ALPHA keep
// above zero.
float v_height_correlated(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    return 0.5 / (n_dot_v * smith_root(n_dot_l, a2_l) + n_dot_l * smith_root(n_dot_v, a2_v));
}

// G = G1(l) G1(v) with G1 = 1 / (1 + Lambda) = 2 c / (c + smith_root) (Walter et al. 2007, eq. 23 and 34; Heitz 2014,
// eq. 98; glTF 2.0, appendix B.3.2): treats masking and shadowing as independent. Darker at grazing angles.
float v_separable(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    return 1.0 / ((n_dot_l + smith_root(n_dot_l, a2_l)) * (n_dot_v + smith_root(n_dot_v, a2_v)));
}

// G1 = c / (c (1 - k) + k) (Schlick 1994, eq. 19), without a square root. k = alpha sqrt(2 / pi) is Schlick's value for
// Beckmann; k = alpha / 2 approximates GGX (Karis 2013, eq. 4, without his remapping of roughness). Both shadow at
// least as much as Smith's G1.
float v_schlick(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    float scale = NDF == BECKMANN ? 0.797885 : 0.5;
    float k_l = scale * sqrt(a2_l);
    float k_v = scale * sqrt(a2_v);
    return 0.25 / ((n_dot_l * (1.0 - k_l) + k_l) * (n_dot_v * (1.0 - k_v) + k_v));
}

// a2_l, a2_v: alpha^2 in the plane of n and l, and of n and v. They differ for anisotropic lobes.
float v_specular(float n_dot_l, float n_dot_v, float a2_l, float a2_v) {
    if (MASKING_SHADOWING == SEPARABLE) return v_separable(n_dot_l, n_dot_v, a2_l, a2_v);
    if (MASKING_SHADOWING == SCHLICK_MASKING) return v_schlick(n_dot_l, n_dot_v, a2_l, a2_v);
    return v_height_correlated(n_dot_l, n_dot_v, a2_l, a2_v);
}

float v_specular(float n_dot_l, float n_dot_v, float alpha) {
    return v_specular(n_dot_l, n_dot_v, alpha * alpha, alpha * alpha);
}

// alpha^2 of an anisotropic surface in the direction w (Heitz 2014, section 5). w_ts: w along t, b and n. At w = n any
// direction will do; 1e-7, one rounding error of 1, keeps the quotient finite there.
float a2_towards(vec3 w_ts, vec2 alpha) {
    vec2 stretched = w_ts.xy * alpha;
    return dot(stretched, stretched) / max(dot(w_ts.xy, w_ts.xy), 1e-7);
}

#endif
