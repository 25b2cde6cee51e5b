// Directional albedo of the lobes: tables over NoV and roughness, which ibl/*.comp bake with the functions that punctual lights
// use. So an edit of D, V, F or the diffuse model reaches light from all directions too, as soon as the tables follow.
#ifndef BRDF_ENERGY_ALBEDO_GLSL
#define BRDF_ENERGY_ALBEDO_GLSL

#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "brdf/energy/anisotropy.glsl"
#include "brdf/energy/dfg.glsl"
#include "brdf/energy/dfg_table.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"

layout(set = SET_FRAME, binding = BINDING_LAMP_DFG) uniform sampler2D lamp_dfg_table;
layout(set = SET_FRAME, binding = BINDING_DIFFUSE_ALBEDO) uniform sampler2D diffuse_table;
layout(set = SET_FRAME, binding = BINDING_SHEEN_ALBEDO) uniform sampler2D sheen_albedo_table;

Dfg dfg_of(vec4 terms, vec4 weights) { return Dfg(terms.r, terms.g, terms.b, terms.a, weights); }

// The lobe's moments in a direction with this cosine to the normal.
Dfg dfg_at(float cosine, float roughness) {
    vec4 weights = vec4(0.0);
    if (F_IS_SAMPLED) weights = dfg_texel(cosine, roughness, DFG_DIRECTION_WEIGHTS);
    return dfg_of(dfg_texel(cosine, roughness, DFG_DIRECTION), weights);
}

// The same moments for a lobe of another E, whose facets F meets at the same angles. 1e-3: a lobe that masking takes away
// entirely.
Dfg with_lost(Dfg dfg, float lost) {
    float ratio = (1.0 - lost) / max(1.0 - dfg.lost, 1e-3);
    return Dfg(dfg.a * ratio, dfg.b * ratio, dfg.e * ratio, lost, dfg.weights * ratio);
}

// A + B. f_schlick(1, 1, c) does not depend on c, so A + B is proportional to E, which is proportional to 1 - lost; the factor
// is that of the direction to the eye. 1e-3: a lobe that masking takes away entirely.
float sum_of_terms(float lost, Dfg towards_eye) {
    return (1.0 - lost) * (towards_eye.a + towards_eye.b) / max(1.0 - towards_eye.lost, 1e-3);
}

// The lobe's moments towards v.
Dfg dfg_towards_eye(Surface s, vec3 v) {
    Dfg dfg = dfg_at(n_dot_v_of(s.n, v), table_roughness(s));
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) {
        RoundLobe equal = lobe_of_equal_albedo(s, v);
        dfg = with_lost(dfg, dfg_texel(equal.cosine, equal.roughness, DFG_DIRECTION).a);
    }
    return dfg;
}

// B and the energy deficit `lost` towards a punctual light.
vec2 lamp_texel(float cosine, float roughness) {
    return textureLod(lamp_dfg_table, table_uv(cosine, roughness, 0u, DFG_SIDE, 1u), 0.0).rg;
}

// The lobe's moments towards a punctual light. A follows from the two that the table holds.
Dfg dfg_towards_lamp(Surface s, vec3 l) {
    float cosine = abs(dot(s.n, l));
    float roughness = table_roughness(s);
    Dfg dfg;
    if (F_IS_SAMPLED) {
        dfg = dfg_at(cosine, roughness);
    } else {
        vec2 b_lost = lamp_texel(cosine, roughness);
        float sum = sum_of_terms(b_lost.y, s.dfg);
        dfg = Dfg(sum - b_lost.x, b_lost.x, sum, b_lost.y, vec4(0.0));
    }
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) {
        RoundLobe equal = lobe_of_equal_albedo(s, l);
        float lost = F_IS_SAMPLED ? dfg_texel(equal.cosine, equal.roughness, DFG_DIRECTION).a
                                  : lamp_texel(equal.cosine, equal.roughness).y;
        dfg = with_lost(dfg, lost);
    }
    return dfg;
}

// Their cosine-weighted means, 2 integral over 0..1 of x(mu) mu dmu. Likewise, the table has no A.
Dfg dfg_mean(float roughness, Dfg towards_eye) {
    vec2 b_lost = texelFetch(dfg_table, fine_texel(roughness, DFG_MEAN), 0).ga;
    float sum = sum_of_terms(b_lost.y, towards_eye);
    if (!F_IS_SAMPLED) return Dfg(sum - b_lost.x, b_lost.x, sum, b_lost.y, vec4(0.0));
    float e = texelFetch(dfg_table, fine_texel(roughness, DFG_LOBE), 0).r;
    return Dfg(sum - b_lost.x, b_lost.x, e, b_lost.y, dfg_texel(0.5, roughness, DFG_MEAN_WEIGHTS));
}

// A single angle that represents the whole lobe, for a thin film, whose F changes too fast for five samples. B / E is the
// mean of (1 - c)^5 over the lobe, so this angle has that value; exact for a mirror. 1e-10: the root has no slope at 0.
float effective_cosine(Dfg dfg) { return 1.0 - pow(clamp(dfg.b / max(dfg.e, 1e-3), 1e-10, 1.0), 0.2); }

// Albedo of the specular lobe, with the F of the dielectric and of the metal. max: interpolation can go below an F of almost 0.
vec3 dielectric_albedo(Surface s, Dfg dfg) {
    if (HAS_FILM) return dielectric_fresnel(s, effective_cosine(dfg)) * dfg.e;
    if (DIELECTRIC_IS_SAMPLED) return max(sampled_dielectric(s, dfg.weights, dfg.e), vec3(0.0));
    return s.f0 * dfg.a + s.f90 * dfg.b;
}

vec3 metal_albedo(Surface s, Dfg dfg) {
    if (HAS_FILM) return metal_fresnel(s, effective_cosine(dfg)) * dfg.e;
    if (METAL_IS_SAMPLED) return max(sampled_metal(s, dfg.weights, dfg.e), vec3(0.0));
    return s.base_color * dfg.a + dfg.b;
}

bool equals_lambert(float n_dot_l, float n_dot_v, float v_dot_h, float roughness) {
    const vec3 COLOR = vec3(0.0, 0.5, 1.0);
    float n_dot_h = (n_dot_l + n_dot_v) / (2.0 * v_dot_h);
    Cosines x = Cosines(n_dot_l, n_dot_v, n_dot_h, v_dot_h, 2.0 * v_dot_h * v_dot_h - 1.0);
    return f_diffuse(COLOR, roughness, roughness * roughness, x) == f_lambert(COLOR);
}

// Whether f_diffuse is f_lambert, which is the same in all directions. The driver evaluates this when it compiles, and an
// edit of f_diffuse makes it false, unless the edit is Lambert at all places that are compared: light from the eye
// (retroreflection), along the mirror direction and between, each from above, at a middle and at a grazing angle, and at low,
// middle and high roughness.
bool diffuse_is_lambert() {
    if (DIFFUSE != LAMBERT) return false;
    bool from_eye = equals_lambert(1.0, 1.0, 1.0, 0.5) && equals_lambert(0.7, 0.7, 1.0, 0.9) && equals_lambert(0.1, 0.1, 1.0, 0.1);
    bool mirrored = equals_lambert(0.8, 0.8, 0.8, 0.1) && equals_lambert(0.5, 0.5, 0.5, 0.5) && equals_lambert(0.05, 0.05, 0.05, 1.0);
    bool between = equals_lambert(0.95, 0.6, 0.9, 0.3) && equals_lambert(0.2, 0.9, 0.8, 0.0) && equals_lambert(0.9, 0.05, 0.7, 0.7);
    return from_eye && mirrored && between;
}

// Integral of f_diffuse NoL dl. Lambert's needs no table, since the integral of NoL is pi. Other models need not be linear
// in the base color x (Oren-Nayar's is not): albedo / x is interpolated by the parabola through its values at x = 1/3, 2/3
// and 1. Beyond 0..1, where a parabola says nothing, it stays as at the end.
vec3 diffuse_albedo(vec3 base_color, float roughness, float n_dot_v) {
    if (diffuse_is_lambert()) return PI * f_lambert(base_color);
    vec2 uv = table_uv(n_dot_v, roughness, DIFFUSE_COLORS, DIFFUSE_SIDE, DIFFUSE_SLICES);
    vec3 q = textureLod(diffuse_table, uv, 0.0).rgb;
    vec3 x = 3.0 * saturate(base_color);
    return base_color * (q.x * 0.5 * (x - 2.0) * (x - 3.0) - q.y * (x - 1.0) * (x - 3.0) + q.z * 0.5 * (x - 1.0) * (x - 2.0));
}

// The mean of the dielectric's F over the half vectors of light that the diffuse lobe of a white surface sends towards v.
vec3 mean_dielectric_fresnel(Surface s, float n_dot_v) {
    vec2 uv = table_uv(n_dot_v, s.roughness, DIFFUSE_WEIGHTS, DIFFUSE_SIDE, DIFFUSE_SLICES);
    return dielectric_mean(s, textureLod(diffuse_table, uv, 0.0));
}

// Columns are sqrt(NoV), since E is steep at grazing angles; rows as in the other tables. The error is below 0.001 for
// NoV >= 0.1 and roughness >= 0.15.
float sheen_albedo(float n_dot_v, float sheen_roughness) {
    return textureLod(sheen_albedo_table, table_uv(n_dot_v, sheen_roughness, 0u, SHEEN_SIDE, 1u), 0.0).r;
}

// The fraction of light that the sheen layer transmits to the layers below (Estevez & Kulla 2017; KHR_materials_sheen).
// stopped: the larger of sheen's E(l) and E(v). The fit of Lambda lets E exceed 1 at grazing angles; the result is then
// 0.
float under_sheen(Surface s, float stopped) { return max(1.0 - max_component(s.sheen_color) * stopped, 0.0); }

#endif
