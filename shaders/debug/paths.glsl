// Path-traced modes: the reference picture, and how the rasterized picture differs from it, term by term.
//
//   path-error = prefilter-error + split-sum-error + occlusion-error + shadow-error + bounce-error
//
// and ibl-error is the sum of the first two. Every term is a mean over paths minus the picture's own term, without
// emission, specular transmission and user_radiance, which picture and paths share.
#ifndef DEBUG_PATHS_GLSL
#define DEBUG_PATHS_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material/material.glsl"
#include "paths/exact_lookups.glsl"
#include "paths/furnace.glsl"
#include "paths/path.glsl"

// Whether only the environment counts, reflected once and without obstacles: what the split sum approximates.
bool is_one_bounce() { return MODE == MODE_MONTE_CARLO || MODE == MODE_IBL_ERROR || MODE == MODE_SPLIT_SUM_ERROR; }

// A pixel's value, and whether some path of it was no number.
struct PathValue {
    vec3 value;
    bool not_finite;
};

// Below roughness 0.1 the error of furnace_albedo can exceed the tolerance and flag white metals.
vec3 energy_color(Surface s, vec3 v) {
    s.roughness = max(s.roughness, 0.1);
    s.clearcoat_roughness = max(s.clearcoat_roughness, 0.1);
    complete_surface(s, v);
    vec3 albedo = furnace_albedo(s, v);
    return max_component(albedo) > 1.005 ? vec3(1.0, 0.06, 0.03) : albedo;   // the tolerance is the estimate's error
}

// The picture's light from the environment, as if nothing were occluded.
vec3 unoccluded_split_sum(Surface s, vec3 v) {
    s.occlusion = 1.0;
    return shade(s, v, LightRange(0u, 0u, false)).ambient.all;
}

vec3 value_of(PathLight light, vec3 lookups, Surface s, vec3 v) {
    if (MODE == MODE_PREFILTER_ERROR) return lookups;
    if (MODE == MODE_IBL_ERROR) return light.unoccluded - unoccluded_split_sum(s, v);
    if (MODE == MODE_SPLIT_SUM_ERROR) return light.unoccluded - unoccluded_split_sum(s, v) - lookups;
    if (MODE == MODE_BOUNCE_ERROR) return light.model;

    Lit lit = shade(s, v, all_lights());
    vec3 lamps = lit.punctual.all + lit.area.all;
    if (MODE == MODE_SHADOW_ERROR) return light.lamps - lamps;
    if (MODE == MODE_OCCLUSION_ERROR) {
        return (light.sky - light.unoccluded) - (lit.ambient.all - unoccluded_split_sum(s, v));
    }
    if (MODE == MODE_PATH_ERROR) return light.sky + light.lamps + light.model - lit.ambient.all - lamps;
    lit.ambient.all = MODE == MODE_MONTE_CARLO ? light.unoccluded : light.sky + light.model;
    if (MODE == MODE_PATH_TRACED) {
        lit.punctual.all = light.lamps;
        lit.area.all = vec3(0.0);
    }
    return outgoing_radiance(s, v, lit);
}

// Modes about the split sum need an environment. Unlit materials have no light to trace, but are part of the picture.
bool has_value() {
    bool is_picture = MODE == MODE_PATH_TRACED;
    bool needs_environment = is_one_bounce() || MODE == MODE_PREFILTER_ERROR || MODE == MODE_OCCLUSION_ERROR;
    return (is_picture || !has_feature(FEATURE_UNLIT)) && (!needs_environment || has_feature(FEATURE_ENVIRONMENT));
}

// `facet_n`: normal of the triangle towards v.
PathValue path_value(Fragment f, Surface s, vec3 v, vec3 facet_n) {
    PathValue pixel = PathValue(vec3(0.0), false);
    if (your_mode(f, s, v, pixel.value)) return pixel;
    if (MODE == MODE_ENERGY) {
        pixel.value = if_present(!has_feature(FEATURE_UNLIT), energy_color(s, v));
        return pixel;
    }
    uint first = frame.sample_index * frame.sample_count;
    PathLight light = PathLight(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0u);
    vec3 lookups = vec3(0.0);
    if (has_value()) {
        if (MODE == MODE_PREFILTER_ERROR || MODE == MODE_SPLIT_SUM_ERROR) {
            lookups = mean_lookup_difference(s, v, first, frame.sample_count);
        }
        if (MODE != MODE_PREFILTER_ERROR && !has_feature(FEATURE_UNLIT)) {
            light = trace_paths(s, v, facet_n, first, frame.sample_count, !is_one_bounce());
        }
    }
    pixel.value = if_present(has_value(), value_of(light, lookups, s, v));
    pixel.not_finite = light.not_finite > 0u;
    return pixel;
}

#endif
