// How much of the light the lobes reflect in all: tables over NoV and roughness, baked by ibl/dfg.comp and
// ibl/sheen_albedo.comp for the chosen NDF and masking.
//
// With D and V as chosen, c = VoH and F = f0 + (f90 - f0) (1 - c)^5 - beta c (1 - c)^6, the albedo towards v is
//
//   integral of F D V NoL dl = f0 A + f90 B - beta C
//
//   A = integral of D V (1 - (1 - c)^5) NoL dl        E = A + B: F = 1, a white metal; 1 - E is lost between the facets
//   B = integral of D V (1 - c)^5 NoL dl              E_avg = 2 integral over 0..1 of E(mu) mu dmu
//   C = integral of D V c (1 - c)^6 NoL dl
//
// The table holds 1 - E, B, C, 1 - E_avg. What multiple scattering needs is the ratio of two losses, which are 1e-4 of
// smooth surfaces: a half float has that to three digits, but knows E, close to 1, to 5e-4 only.
#ifndef BRDF_ENERGY_GLSL
#define BRDF_ENERGY_GLSL

#include "interface.glsl"
#include "brdf/models.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

layout(set = SET_FRAME, binding = BINDING_DFG) uniform sampler2D dfg_table;
layout(set = SET_FRAME, binding = BINDING_SHEEN_ALBEDO) uniform sampler2D sheen_albedo_table;

// 1 - E, B, C, 1 - E_avg. NoV is at texel centers; the first and the last row are roughness 0 and 1, where many
// materials are.
vec4 dfg(float n_dot_v, float roughness) {
    const float ROWS = 128.0;
    return textureLod(dfg_table, vec2(n_dot_v, (roughness * (ROWS - 1.0) + 0.5) / ROWS), 0.0);
}

// alpha along t and b, stretched or round (KHR_materials_anisotropy: the long side grows towards 1).
vec2 alpha_sides(Surface s) {
    float alpha = alpha_from_roughness(s.roughness);
    if ((FEATURES & FEATURE_ANISOTROPY) == 0u) return vec2(alpha);
    return vec2(mix(alpha, 1.0, s.anisotropy * s.anisotropy), alpha);
}

// The roughness at which the table has a lobe. It has round ones: of a stretched one, over all directions, E is that of
// a round one in between. Our fit, off by less than 0.005 of E; towards one direction it may be off by more.
float table_roughness(Surface s) {
    if ((FEATURES & FEATURE_ANISOTROPY) == 0u) return s.roughness;
    vec2 alpha = alpha_sides(s);
    return sqrt(sqrt(mix(alpha.y * alpha.y, alpha.x * alpha.x, 0.46)));
}

// A, B and C.
vec3 dfg_terms(vec4 dfg) { return vec3(1.0 - dfg.r - dfg.g, dfg.g, dfg.b); }

float white_albedo(vec4 dfg) { return 1.0 - dfg.r; }

vec3 curve_albedo(FresnelCurve curve, vec4 dfg) {
    vec3 terms = dfg_terms(dfg);
    return curve.f0 * terms.r + curve.f90 * terms.g - curve.beta * terms.b;
}

// B over the hemisphere, 2 integral B(mu) mu dmu, which the table does not hold: 1/21 for a mirror, less for rough
// surfaces, which meet more light at steep angles. Fits to the integrals, off by less than 0.002.
float b_average(float roughness) {
    vec2 fit = vec2(2.9, 13.3);
    if (MASKING_SHADOWING == SCHLICK_MASKING) fit = vec2(6.0, 18.0);
    else if (NDF == BECKMANN) fit = vec2(1.0, 7.0);
    float alpha = roughness * roughness;
    return 1.0 / (21.0 * (1.0 + alpha * (fit.x + alpha * fit.y)));
}

// Columns are the root of NoV, since E is steep where v grazes; rows as above. Off by less than 0.001 from NoV = 0.1
// on, for a roughness of 0.15 and more.
float sheen_albedo(float n_dot_v, float sheen_roughness) {
    const float ROWS = 64.0;
    return textureLod(sheen_albedo_table, vec2(sqrt(n_dot_v), (sheen_roughness * (ROWS - 1.0) + 0.5) / ROWS), 0.0).r;
}

// What the fibers of the sheen let through to what lies below them (Estevez & Kulla 2017; KHR_materials_sheen).
// stopped: E of the direction, towards the light or the eye, in which more is stopped. The fit of Lambda lets E exceed
// 1 where v grazes: nothing is left below.
float under_sheen(Surface s, float stopped) { return max(1.0 - max_component(s.sheen_color) * stopped, 0.0); }

#endif
