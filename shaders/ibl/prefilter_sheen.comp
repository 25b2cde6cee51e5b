#version 460
#include "interface.glsl"
#include "brdf/layers/sheen.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/maps/cube_map.glsl"
#include "ibl/maps/half.glsl"
#include "ibl/maps/levels.glsl"
#include "ibl/sampling/filter.glsl"
#include "ibl/small_lights/add.glsl"

// Prefilters one level for sheen: the mean of radiance weighted by K = f NoL of the selected sheen, with N = V = R
// (Karis 2013, as ibl/prefilter.comp does for GGX). K is brdf/layers/sheen.glsl's, so it follows an edit there.
//
// Smooth sheen is a ring near the horizon, rough sheen is as wide as a cosine. So half of the samples have the density
// (p + 1) / 2 pi (1 - NoL)^p, p = 1 / (2 alpha), of which (1 - NoL)^(p + 1) is uniform, and half are uniform in NoL. The
// balance heuristic weights both (Veach 1997, section 9.2.2).

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

float lobe_weight(float n_dot_l, float roughness) {
    float n_dot_h = sqrt(0.5 + 0.5 * n_dot_l);   // h is halfway between l and n = v
    return f_sheen(n_dot_l, 1.0, n_dot_h, n_dot_h, roughness) * n_dot_l;
}

// rgb: the mean over the mip levels, without small lights. w: the integral of K.
vec4 filtered_mean(vec3 n, float roughness) {
    float p = 0.5 / sheen_alpha(roughness);
    mat3 basis = basis_around(n);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < task.samples; ++i) {
        float u = (float(i / 2u) + 0.5) / float(task.samples / 2u);
        float n_dot_l = 1.0 - ((i & 1u) == 0u ? pow(u, 1.0 / (p + 1.0)) : u);
        float pdf = (0.25 / PI) * ((p + 1.0) * pow(1.0 - n_dot_l, p) + 1.0);
        vec3 d = basis * direction_from_cosine(n_dot_l, golden_turns(i));
        vec3 radiance = filtered_radiance(d, 1.0 / (float(task.samples) * pdf));
        sum += vec4(radiance, 1.0) * (lobe_weight(n_dot_l, roughness) / pdf);
    }
    return vec4(sum.rgb / sum.w, sum.w / float(task.samples));
}

// Without the suns, which are lit as directional lights (lighting/sun.glsl).
vec3 small_light_sum(vec3 n, float roughness) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < listed_lights(); ++i) {
        float n_dot_l = dot(listed.lights[i].direction, n);
        if (n_dot_l > 0.0) sum += listed.lights[i].intensity * lobe_weight(n_dot_l, roughness);
    }
    return sum;
}

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, task.size))) return;
    vec3 n = normalize(cube_position(texel_center(texel.xy, task.size), texel.z));
    float roughness = roughness_of_level(task.level, task.levels);
    vec4 mean = filtered_mean(n, roughness);
    vec3 radiance = mean.rgb + small_light_sum(n, roughness) / mean.w;
    imageStore(target, ivec3(texel), vec4(rounded_to_half(radiance), 1.0));
}
