// Reflections of the environment by a sum over directions in each pixel, in place of the split sum: filtered importance
// sampling (Krivanek & Colbert 2008, "Real-time Shading with Filtered Importance Sampling"; Colbert & Krivanek 2007, GPU
// Gems 3, chapter 20). With N directions l_i of density p,
//
//   integral of L f NoL dl  =  1 / N  sum of L_i f(l_i, v) NoL_i / p(l_i)        f: evaluate_brdf
//
// L_i is the mean radiance around l_i over 1 / (N p(l_i)) steradians, the solid angle that the sample stands for. So a few
// samples cover the lobe without gaps, and every pixel can use the same ones: the picture has no noise.
//
// f and its F, D and V are those of punctual lights, for this l and v. So an edit of them needs no bake to show, and it changes the
// reflections where the edit says, where the split sum only knows the lobe's albedo and its shape for v = n.
//
// Limits: the samples draw from GGX. Of a D with two peaks they may miss one. The mean around a sample near the horizon
// includes light from below it. Below 128, single samples show as faint streaks under small bright lights. All three shrink
// with N. Multiple scattering and sheen stay as in image_based.glsl.
#ifndef LIGHTING_SAMPLED_REFLECTIONS_GLSL
#define LIGHTING_SAMPLED_REFLECTIONS_GLSL

#include "interface.glsl"
#include "brdf/energy/dfg_table.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/environment.glsl"
#include "lighting/lobe_frame.glsl"

const uint PREFILTERED = 0u;
//@ui "Reflections" choice Prefiltered=0 "Maps filtered by roughness and a table: the split sum (Karis 2013)" Sampled32=32 "32 directions in each pixel: follows every edit of D, V and F" Sampled64=64 "64 directions: half the streaks, twice the samples" Sampled128=128 "128 directions: closest to random paths" group="Sampling" doc="Of the environment: from prefiltered maps, or by a sum over directions in each pixel, which follows every edit of D, V and F and costs time"
layout(constant_id = USER_CONSTANTS + 14) const uint REFLECTION_SAMPLES = PREFILTERED;

// Under uniform light the split sum is exact.
const bool REFLECTIONS_ARE_SAMPLED = REFLECTION_SAMPLES != PREFILTERED && HAS_ENVIRONMENT;

// The filter is the GGX lobe around l whose peak is 1 / solid angle, with its alpha times this factor. We chose it by eye and by
// the distance to the path-traced reference in the built-in environments: a wider filter blurs the lobe and lets in light from below the
// horizon, a narrower one shows single samples as spots.
const float FILTER_WIDTH = 0.75;

// Prefiltered levels are baked with the selected D, which an edit may have widened. This is the distance from the level of
// roughness `width` to the level whose lobe is as wide as GGX of that roughness: two steps towards the root r of
// ggx_roughness(r) = width. 1e-3: a D of 0.
float level_offset(float width) {
    float roughness = width * width / max(ggx_roughness(width), 1e-3);
    roughness *= width / max(ggx_roughness(roughness), 1e-3);
    return specular_level(roughness) - specular_level(width);
}

// The mean radiance around l, for a sample of density `pdf`. The peak of GGX reflected at v = n is D / 4 = 1 / (4 pi alpha^2),
// and it equals N p for alpha = (4 pi N p)^(-1/2); roughness is its root. With suns, level 0 is not read, since it shows
// them; lighting/sun.glsl adds them.
vec3 mean_radiance_around(vec3 l, float pdf, float offset) {
    float alpha = FILTER_WIDTH * inversesqrt(4.0 * PI * float(REFLECTION_SAMPLES) * pdf);
    float finest = SUN_COUNT != 0u ? 1.0 : 0.0;
    float level = clamp(specular_level(sqrt(alpha)) + offset, finest, float(SPECULAR_LEVELS));
    return prefiltered_sky(map_from_world(l), level);
}

// f |NoL| of the coat or of the base's specular lobe.
vec3 weight_of(Surface s, vec3 v, vec3 l, bool is_coat) {
    Brdf brdf = evaluate_brdf(s, l, v);
    return (is_coat ? brdf.clearcoat : brdf.specular) * abs(dot(s.n, l));
}

// The sum over samples. Their density is that of the GGX whose facets spread as widely as those of the selected D
// (ggx_roughness). The points form a spiral, which covers the spherical cap of visible normals evenly.
vec3 reflected_sky(Surface s, vec3 v, LobeFrame lobe, float roughness, bool is_coat) {
    float width = max(ggx_roughness(roughness), 1e-3);
    float ratio = width / max(roughness, 1e-3);
    lobe.alpha = clamp(lobe.alpha * (ratio * ratio), MIN_ALPHA, 1.0);
    float offset = level_offset(width * pow(float(REFLECTION_SAMPLES), -0.25));   // of the lobe's middle
    v = lobe.world_from_lobe * lobe.v;   // mirrored if a normal map has turned n away
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < REFLECTION_SAMPLES; ++i) {
        vec2 u = vec2((float(i) + 0.5) / float(REFLECTION_SAMPLES), golden_turns(i));
        vec3 l = sample_lobe(lobe, u);
        float pdf = pdf_lobe(lobe, l);
        if (pdf > 0.0) sum += mean_radiance_around(l, pdf, offset) * weight_of(s, v, l, is_coat) / pdf;
    }
    return sum / float(REFLECTION_SAMPLES);
}

vec3 sampled_reflection(Surface s, vec3 v, LobeFrame lobe, float roughness, bool is_coat) {
    return frame.environment_intensity * reflected_sky(s, v, lobe, roughness, is_coat);
}

// A frame that turns the samples from pixel to pixel without a jump, which would show as a seam. In view space, no visible
// surface has the normal (0, 0, -1), the only one where this basis jumps.
LobeFrame seamless_frame(vec3 n, vec3 v, float roughness) {
    mat3 view_from_world = mat3(frame.view_from_world);
    mat3 world_from_lobe = transpose(view_from_world) * basis_around(view_from_world * n, 1.0);
    return lobe_frame(world_from_lobe, v, vec2(alpha_from_roughness(roughness)));
}

vec3 sampled_specular(Surface s, vec3 v) {
    bool is_round = (FEATURES & FEATURE_ANISOTROPY) == 0u;
    LobeFrame lobe = specular_frame(s, v);
    if (is_round) lobe = seamless_frame(s.n, v, s.roughness);
    return sampled_reflection(s, v, lobe, s.roughness, false);
}

vec3 sampled_coat(Surface s, vec3 v) {
    LobeFrame lobe = seamless_frame(s.clearcoat_n, v, s.clearcoat_roughness);
    return sampled_reflection(s, v, lobe, s.clearcoat_roughness, true);
}

#endif
