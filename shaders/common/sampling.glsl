// Sampling: point sets, warps to distributions of directions, and their densities.
//
// Directions are in tangent space with z as the normal. Each density belongs to its sampler and deliberately does not
// call brdf/ndf.glsl: after you edit D there, the samplers still match their densities, and the estimates follow your
// D.
#ifndef COMMON_SAMPLING_GLSL
#define COMMON_SAMPLING_GLSL

#include "common/math.glsl"

// Hammersley points: i / count and the radical inverse of i in base 2 (van der Corput). x is shifted by half a step, so
// that no point falls on an edge, where some warps below have their pole.
vec2 hammersley(uint i, uint count) {
    return vec2((float(i) + 0.5) / float(count), float(bitfieldReverse(i) >> 8) * exp2(-24.0));
}

// Azimuth of point i as a fraction of a turn. Steps of the golden angle interleave evenly on rings of any radius.
float golden_turns(uint i) { return fract(float(i) * 0.618033988); }

// Three random 32-bit words from three (pcg3d: Jarzynski & Olano 2020, section 3). Stateless: hash pixel and sample
// index. x, y and z are updated one after the other, each from the newest values of the other two. Updated together,
// they would stay equal for equal inputs.
uvec3 pcg3d_round(uvec3 x) {
    x.x += x.y * x.z;
    x.y += x.z * x.x;
    x.z += x.x * x.y;
    return x;
}

uvec3 random_words(uvec3 x) {
    x = pcg3d_round(x * 1664525u + 1013904223u);
    return pcg3d_round(x ^ (x >> 16));
}

// Uniform in 0 <= x < 1. 24 bits fit a float's mantissa; more could round up to 1.
vec3 random_numbers(uvec3 seed) { return vec3(random_words(seed) >> 8) * exp2(-24.0); }

// World from tangent space: columns t, b, n, right-handed (Duff et al. 2017, listing 3). side: 1 or -1; at n.z = -side there
// is no such basis. basis_around chooses the side that never divides by 0, since |side + n.z| >= 1, so t and b jump where
// n.z changes sign.
mat3 basis_around(vec3 n, float side) {
    float a = -1.0 / (side + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3(b, side + n.y * n.y * a, -n.y), n);
}

mat3 basis_around(vec3 n) { return basis_around(n, n.z < 0.0 ? -1.0 : 1.0); }

// The direction with the given cosine to z; `turns` is the azimuth over 2 pi. max: rounding can make 1 - cos^2
// negative.
vec3 direction_from_cosine(float cos_theta, float turns) {
    float sin_theta = sqrt(max(1.0 - cos_theta * cos_theta, 0.0));
    float phi = 2.0 * PI * turns;
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi), cos_theta);
}

// Density cos(theta) / pi: a uniform disk projected up to the hemisphere (Malley's method; Pharr et al. 2016, 13.6.3).
vec3 sample_cosine(vec2 u) { return direction_from_cosine(sqrt(1.0 - u.x), u.y); }
float pdf_cosine(float n_dot_l) { return max(n_dot_l, 0.0) / PI; }

// Half vectors with GGX's density D NoH: tan^2 = alpha^2 u / (1 - u) (Walter et al. 2007, eq. 35).
vec3 sample_ggx(vec2 u, float alpha) {
    return direction_from_cosine(sqrt((1.0 - u.x) / (1.0 + (alpha * alpha - 1.0) * u.x)), u.y);
}

// sin2_h: sin^2 of the angle to h, from sin2_between. 1 - NoH^2 would be off by percents where alpha is small.
float pdf_ggx(float n_dot_h, float sin2_h, float alpha) {
    float a2 = alpha * alpha;
    float spread = n_dot_h * n_dot_h * a2 + sin2_h;
    return a2 * max(n_dot_h, 0.0) / (PI * spread * spread);
}

// GGX with a different alpha along x and y (Heitz 2014, eq. 85), whatever brdf/ndf.glsl returns.
float d_ggx_reference(vec3 h, vec2 alpha) {
    vec3 scaled = vec3(h.xy / alpha, h.z);
    float spread = dot(scaled, scaled);
    return 1.0 / (PI * alpha.x * alpha.y * spread * spread);
}

// Smith's G1 of GGX, 2 / (1 + sqrt(1 + alpha^2 tan^2)): the visible fraction of the facets that face v (Walter et al.
// 2007, eq. 34; with different alpha along x and y: Heitz 2014, eq. 72 and 87). This form avoids the tangent.
float g1_ggx(vec3 v, vec2 alpha) {
    float root = length(vec3(alpha * v.xy, v.z));
    return 2.0 * v.z / (v.z + root);
}

// Visible normals of GGX, density G1 D VoH / NoV, by spherical caps (Dupuy & Benyoub 2023, listing 3): stretched, GGX
// becomes a hemisphere of mirrors, which reflects v uniformly into the cap z > -v.z. The facet is halfway between v and
// the reflection. Requires v.z >= 0.
vec3 sample_ggx_vndf(vec2 u, vec3 v, vec2 alpha) {
    vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
    vec3 h = stretched + direction_from_cosine((1.0 - u.x) * (1.0 + stretched.z) - stretched.z, u.y);
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-6)));   // 1e-6: an edge-on facet still has a direction
}

// The density of sample_ggx_vndf.
float pdf_ggx_vndf(vec3 v, vec3 h, vec2 alpha) {
    return g1_ggx(v, alpha) * d_ggx_reference(h, alpha) * max(dot(v, h), 0.0) / max(v.z, 1e-6);   // 1e-6: at v.z = 0 no facet is visible
}

// Density of l = reflect(-v, h) from the density of h: dh / dl = 1 / (4 VoH) (Walter et al. 2007, eq. 14). 1e-6:
// densities with VoH as a factor are 0 at VoH = 0; the others diverge there.
float pdf_reflected(float pdf_h, float v_dot_h) { return pdf_h / (4.0 * max(v_dot_h, 1e-6)); }

#endif
