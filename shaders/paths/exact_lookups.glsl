// The split sum with exact lookups: the means that the baked maps approximate, by random directions. They separate the
// error of the bake and of its interpolation from that of the split sum itself.
#ifndef PATHS_EXACT_LOOKUPS_GLSL
#define PATHS_EXACT_LOOKUPS_GLSL

#include "interface.glsl"
#include "brdf/energy/albedo.glsl"
#include "brdf/horizon.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/sampling/lobe_weight.glsl"
#include "lighting/albedo.glsl"
#include "lighting/environment.glsl"
#include "lighting/image_based.glsl"
#include "lighting/transmission.glsl"
#include "paths/environment_sampling.glsl"
#include "paths/numbers.glsl"

// A lobe around an axis, which is normal, eye and mirror direction in one (Karis 2013).
struct Kernel {
    vec3 axis;
    float alpha;               // 0: the cosine
    float scale;               // makes the integral of the weight 1
};

Kernel cosine_kernel(vec3 axis) { return Kernel(axis, 0.0, 1.0 / PI); }

// The weight is D V NoL with n = v, as in ibl/prefilter.comp. Its integral is the albedo E at normal incidence.
Kernel lobe_kernel(vec3 axis, float roughness) {
    return Kernel(normalize(axis), alpha_from_roughness(roughness), 1.0 / max(facing_albedo(roughness), 1e-3));
}

// Density with which the kernel's own sampler draws l.
float pdf_kernel(Kernel kernel, vec3 l) {
    if (kernel.alpha == 0.0) return pdf_cosine(dot(kernel.axis, l));
    vec3 h = safe_normalize(kernel.axis + l, kernel.axis);
    float n_dot_h = dot(kernel.axis, h);
    return pdf_reflected(pdf_ggx(n_dot_h, sin2_between(kernel.axis, h), kernel.alpha), n_dot_h);
}

vec3 sample_kernel(Kernel kernel, vec2 u) {
    mat3 basis = basis_around(kernel.axis);
    if (kernel.alpha == 0.0) return basis * sample_cosine(u);
    return basis * reflect(vec3(0.0, 0.0, -1.0), sample_ggx(u, kernel.alpha));
}

// The kernel's mean of the unfiltered environment, estimated from one direction: with equal odds of the kernel or towards
// the environment's light (one-sample balance heuristic).
vec3 exact_mean(Kernel kernel, vec3 u) {
    float sky = environment_has_light() ? 0.5 : 0.0;
    vec3 l;
    if (u.z < sky) l = sample_environment(vec3(u.xy, u.z / sky)).l;
    else l = sample_kernel(kernel, u.xy);
    float n_dot_l = dot(kernel.axis, l);
    if (n_dot_l <= 0.0) return vec3(0.0);
    float own = pdf_kernel(kernel, l);
    float weight = n_dot_l;
    if (kernel.alpha != 0.0) {
        vec3 chord = l - kernel.axis;
        weight = lobe_weight(0.25 * dot(chord, chord), kernel.alpha);
    }
    return sky_radiance(l) * (weight * kernel.scale / (sky * pdf_environment(l) + (1.0 - sky) * own));
}

// One path's estimate of what exact lookups would add to the split sum without occlusion. Two lookups stay as baked, so
// their errors count as the split sum's: that of sheen, and the row of lookups of an anisotropic lobe. So do the errors of
// sampled reflections, which have no lookup to compare.
vec3 lookup_difference(Surface s, vec3 v, Albedo albedo, uint path) {
    PathNumbers numbers = path_numbers(path);
    vec3 u = numbers_of(numbers, 0u, false);
    vec3 sum = (albedo.diffuse + albedo.multiple) * (exact_mean(cosine_kernel(s.n), u) - irradiance_over_pi(s.n));
    if ((FEATURES & FEATURE_ANISOTROPY) == 0u && !REFLECTIONS_ARE_SAMPLED) {
        vec3 direction = lobe_direction(s.n, v, s.roughness);
        vec3 difference = exact_mean(lobe_kernel(direction, s.roughness), u) - specular_radiance(s, v);
        sum += albedo.specular * difference * reflection_visibility(s.ng, direction);
    }
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u && !REFLECTIONS_ARE_SAMPLED) {
        vec3 direction = lobe_direction(s.clearcoat_n, v, s.clearcoat_roughness);
        vec3 baked = prefiltered_radiance(direction, s.clearcoat_roughness);
        vec3 difference = exact_mean(lobe_kernel(direction, s.clearcoat_roughness), u) - baked;
        sum += albedo.clearcoat * difference * reflection_visibility(s.ng, direction);
    }
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        vec3 difference = exact_mean(cosine_kernel(-s.n), u) - irradiance_over_pi(-s.n);
        sum += albedo.diffuse_transmitted * difference * attenuation(s, s.thickness);
    }
    return sum;
}

// Mean of paths first .. first + count - 1 of this pixel.
vec3 mean_lookup_difference(Surface s, vec3 v, uint first, uint count) {
    Albedo albedo = directional_albedo(s, v);
    vec3 sum = vec3(0.0);
    for (uint i = first; i < first + count; ++i) sum += lookup_difference(s, v, albedo, i);
    return sum / float(max(count, 1u));
}

#endif
