// Directional albedo of the lobes: tables over NoV and roughness, which ibl/dfg.comp and ibl/sheen_albedo.comp bake for
// the selected NDF and masking.
//
// With the selected D and V, c = VoH and F = f0 + (f90 - f0) (1 - c)^5 - beta c (1 - c)^6, the albedo towards v is
//
//   integral of F D V NoL dl = f0 A + f90 B - beta C
//
//   A = integral of D V (1 - (1 - c)^5) NoL dl        E = A + B: albedo for F = 1; 1 - E is lost between facets
//   B = integral of D V (1 - c)^5 NoL dl              E_avg = 2 integral over 0..1 of E(mu) mu dmu
//   C = integral of D V c (1 - c)^6 NoL dl
//
// The table stores 1 - E, B, C, 1 - E_avg. Multiple scattering needs a ratio of two losses, which are about 1e-4 on
// smooth surfaces. A half float holds such a loss to three digits, but E, close to 1, only to 5e-4.
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

// Returns 1 - E, B, C, 1 - E_avg. Columns are NoV at texel centers. The first and last row are roughness 0 and 1
// exactly, since many materials use these values.
vec4 dfg(float n_dot_v, float roughness) {
    const float ROWS = 128.0;
    return textureLod(dfg_table, vec2(n_dot_v, (roughness * (ROWS - 1.0) + 0.5) / ROWS), 0.0);
}

// alpha along t and b. Anisotropy raises alpha along t towards 1 (KHR_materials_anisotropy).
vec2 alpha_sides(Surface s) {
    float alpha = alpha_from_roughness(s.roughness);
    if ((FEATURES & FEATURE_ANISOTROPY) == 0u) return vec2(alpha);
    return vec2(mix(alpha, 1.0, s.anisotropy * s.anisotropy), alpha);
}

// The roughness at which to look up the table. The table holds isotropic lobes only. Averaged over the azimuth, an
// anisotropic lobe has about the E of an isotropic one in between: our fit, with an error below 0.005 of E. In a single
// direction the error may be larger.
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

// Cosine-weighted average of B, 2 integral B(mu) mu dmu, which the table does not hold. It is 1/21 for a mirror and
// less for rough surfaces, whose facets reflect at smaller angles. Fits to the integrals, with an error below 0.002.
float b_average(float roughness) {
    vec2 fit = vec2(2.9, 13.3);
    if (MASKING_SHADOWING == SCHLICK_MASKING) fit = vec2(6.0, 18.0);
    else if (NDF == BECKMANN) fit = vec2(1.0, 7.0);
    float alpha = roughness * roughness;
    return 1.0 / (21.0 * (1.0 + alpha * (fit.x + alpha * fit.y)));
}

// Columns are sqrt(NoV), since E is steep at grazing angles; rows as in dfg(). The error is below 0.001 for NoV >= 0.1
// and roughness >= 0.15.
float sheen_albedo(float n_dot_v, float sheen_roughness) {
    const float ROWS = 64.0;
    return textureLod(sheen_albedo_table, vec2(sqrt(n_dot_v), (sheen_roughness * (ROWS - 1.0) + 0.5) / ROWS), 0.0).r;
}

// The fraction of light that the sheen layer transmits to the layers below (Estevez & Kulla 2017; KHR_materials_sheen).
// stopped: the larger of sheen's E(l) and E(v). The fit of Lambda lets E exceed 1 at grazing angles; the result is then
// 0.
float under_sheen(Surface s, float stopped) { return max(1.0 - max_component(s.sheen_color) * stopped, 0.0); }

#endif
