// Directions to sample: point sets, the distributions they are warped to, and the densities of these.
//
// Directions are in tangent space: z is the normal. A density here is the one that the sampler has, on purpose apart
// from brdf/ndf.glsl: when you edit D there, the estimates follow your edit, and the samplers stay right.
#ifndef COMMON_SAMPLING_GLSL
#define COMMON_SAMPLING_GLSL

#include "common/math.glsl"

// Hammersley's points: i / count against the bits of i mirrored at the point (van der Corput in base 2). Shifted by
// half a step in x, so that no point lies on the edge, where some of the warps below have their pole.
vec2 hammersley(uint i, uint count) {
    return vec2((float(i) + 0.5) / float(count), float(bitfieldReverse(i) >> 8) * exp2(-24.0));
}

// Three random words from three (pcg3d: Jarzynski & Olano 2020, section 3): pixel and sample number in, no state kept.
uvec3 random_words(uvec3 x) {
    x = x * 1664525u + 1013904223u;
    x += x.yzx * x.zxy;
    x ^= x >> 16;
    return x + x.yzx * x.zxy;
}

// Uniform in 0 <= x < 1. 24 bits: more do not fit a float's mantissa, and rounding would yield 1.
vec3 random_numbers(uvec3 seed) { return vec3(random_words(seed) >> 8) * exp2(-24.0); }

// World from tangent space: columns t, b, n, right-handed (Duff et al. 2017, listing 3). No branch, no division by 0:
// sign + n.z is at least 1 in size. t and b jump where n.z changes its sign.
mat3 basis_around(vec3 n) {
    float side = n.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3(b, side + n.y * n.y * a, -n.y), n);
}

// The direction with this cosine to z. max: 1 - cos^2 of a rounded cosine may be a little below 0.
vec3 direction_from_cosine(float cos_theta, float turns) {
    float sin_theta = sqrt(max(1.0 - cos_theta * cos_theta, 0.0));
    float phi = 2.0 * PI * turns;
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi), cos_theta);
}

// Uniform over the hemisphere: equal heights have equal areas (Archimedes).
vec3 sample_uniform(vec2 u) { return direction_from_cosine(1.0 - u.x, u.y); }
float pdf_uniform() { return 0.5 / PI; }

// Density cos(theta) / pi: a uniform disk, lifted to the sphere (Malley's method; Pharr et al. 2016, section 13.6.3).
vec3 sample_cosine(vec2 u) { return direction_from_cosine(sqrt(1.0 - u.x), u.y); }
float pdf_cosine(float n_dot_l) { return max(n_dot_l, 0.0) / PI; }

// Half vectors with density D NoH of GGX: tan^2 = alpha^2 u / (1 - u) (Walter et al. 2007, eq. 35).
vec3 sample_ggx(vec2 u, float alpha) {
    return direction_from_cosine(sqrt((1.0 - u.x) / (1.0 + (alpha * alpha - 1.0) * u.x)), u.y);
}

float pdf_ggx(float n_dot_h, float alpha) {
    float a2 = alpha * alpha;
    float spread = n_dot_h * n_dot_h * (a2 - 1.0) + 1.0;
    return a2 * max(n_dot_h, 0.0) / (PI * spread * spread);
}

// Half vectors with density D NoH of Beckmann: tan^2 = -alpha^2 log(1 - u) (Walter et al. 2007, eq. 28).
vec3 sample_beckmann(vec2 u, float alpha) {
    return direction_from_cosine(inversesqrt(1.0 - alpha * alpha * log(1.0 - u.x)), u.y);
}

float pdf_beckmann(float n_dot_h, float alpha) {
    if (n_dot_h <= 0.0) return 0.0;
    float cos2 = n_dot_h * n_dot_h;
    float a2 = alpha * alpha;
    return exp((cos2 - 1.0) / (cos2 * a2)) / (PI * a2 * cos2 * n_dot_h);
}

// Half vectors with density D NoH of sheen's "Charlie", D = (2 + 1/alpha) sin^(1/alpha) / 2 pi (Estevez & Kulla 2017,
// eq. 2): the integral is a power of the sine, sin = u^(alpha / (2 alpha + 1)).
vec3 sample_charlie(vec2 u, float alpha) {
    float sin_theta = pow(u.x, alpha / (2.0 * alpha + 1.0));
    return direction_from_cosine(sqrt(max(1.0 - sin_theta * sin_theta, 0.0)), u.y);
}

float pdf_charlie(float n_dot_h, float alpha) {
    float sin2 = max(1.0 - n_dot_h * n_dot_h, 0.0);
    return (2.0 + 1.0 / alpha) * pow(sin2, 0.5 / alpha) * max(n_dot_h, 0.0) / (2.0 * PI);
}

// Smith's G1 of GGX, the part of the facets facing v that v sees: 2 / (1 + sqrt(1 + alpha^2 tan^2)) (Walter et al.
// 2007, eq. 34; Heitz 2014, eq. 72 and 87 when alpha differs along x and y). z above and below the line: no tangent.
float g1_ggx(vec3 v, vec2 alpha) {
    float root = length(vec3(alpha * v.xy, v.z));
    return 2.0 * v.z / (v.z + root);
}

// Half vectors of the facets that v sees: density G1 D VoH / NoV (Heitz 2018, listing 1). The stretched GGX is a
// hemisphere; the half of a disk that faces v is sampled, and bent where the hemisphere hides it. v.z >= 0.
vec3 sample_ggx_vndf(vec2 u, vec3 v, vec2 alpha) {
    vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
    float across = dot(stretched.xy, stretched.xy);
    vec3 t = across > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(across) : vec3(1.0, 0.0, 0.0);
    vec3 b = cross(stretched, t);

    float radius = sqrt(u.x);
    float phi = 2.0 * PI * u.y;
    float x = radius * cos(phi);
    float y = mix(sqrt(1.0 - x * x), radius * sin(phi), 0.5 + 0.5 * stretched.z);
    vec3 h = x * t + y * b + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-6)));   // 1e-6: a facet on edge still has a direction
}

// D itself for alpha along x and y: Heitz 2014, eq. 85 (alpha alike: Walter et al. 2007, eq. 33).
float pdf_ggx_vndf(vec3 v, vec3 h, vec2 alpha) {
    vec3 scaled = vec3(h.xy / alpha, h.z);
    float spread = dot(scaled, scaled);
    float d = 1.0 / (PI * alpha.x * alpha.y * spread * spread);
    return g1_ggx(v, alpha) * d * max(dot(v, h), 0.0) / max(v.z, 1e-6);   // 1e-6: v in the surface sees no facet
}

// Density of l = reflect(-v, h) from that of h: dh / dl = 1 / (4 VoH) (Walter et al. 2007, eq. 14). 1e-6: at VoH = 0
// the densities of h that hold VoH as a factor are 0, the others have no limit.
float pdf_reflected(float pdf_h, float v_dot_h) { return pdf_h / (4.0 * max(v_dot_h, 1e-6)); }

#endif
