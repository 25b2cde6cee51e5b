#version 460
#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/filter.glsl"
#include "ibl/half.glsl"
#include "ibl/levels.glsl"
#include "ibl/small_lights.glsl"

// Prefilters one level for GGX: the mean of radiance weighted by K = D NoL, with N = V = R (Karis 2013).
//
// With x = sin^2 of the angle to h, NoL = 1 - 2x and GGX is K = (1 - 2x) / q^2, q = alpha^2 + (1 - alpha^2) x.
// (Constant factors cancel in the mean.) dl = 4 pi dx, and light above the horizon has x < 1/2.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

struct LobeSample {
    vec3 direction;            // tangent space
    float footprint;           // steradians that the sample represents
    float weight;              // K / pdf
    float sharpened;           // the same, corrected for the blur of the footprints
};

// Sample i of the lobe, with a density proportional to q^(-3/2), which makes r = q^(-1/2) uniform. K falls with q^-2.
// Sampled with that density (Walter et al. 2007, eq. 35), the last samples would represent half the sky and mix the
// peak into it.
LobeSample lobe_sample(uint i, float alpha) {
    float a2 = alpha * alpha;
    float b = 1.0 - a2;
    float r_first = 1.0 / alpha;
    float r_last = inversesqrt(0.5 + 0.5 * a2);
    float r = mix(r_first, r_last, (float(i) + 0.5) / float(task.samples));
    float r3 = r * r * r;
    float x = (1.0 / (r * r) - a2) / b;
    float n_dot_l = 1.0 - 2.0 * x;
    float pdf = b * r3 / (8.0 * PI * (r_first - r_last));
    float footprint = max(1.0 / (float(task.samples) * pdf), finest_footprint());

    // Reading each sample with a filter of variance s^2 = S q^(3/2) amounts to a mean with K + laplacian(s^2 K) / 2, up
    // to terms of s^4. So K - laplacian(s^2 K) / 2 replaces K, which about halves the error. The laplacian of g(x)
    // around an axis of the unit sphere is (1 - 2x) g' + x (1 - x) g'', here for g = (1 - 2x) q^(-1/2). S is footprint
    // times FILTER_VARIANCE over q^(3/2), which cancels against the 1 / pdf of the weight.
    float g1 = -2.0 * r - 0.5 * n_dot_l * b * r3;
    float g2 = 2.0 * b * r3 + 0.75 * n_dot_l * b * b * r3 * r * r;
    float laplacian = n_dot_l * g1 + x * (1.0 - x) * g2;
    float weight = n_dot_l * r;
    float sharpened = max(weight - 0.5 * FILTER_VARIANCE * footprint * laplacian, 0.0);
    return LobeSample(direction_from_cosine(n_dot_l, golden_turns(i)), footprint, weight, sharpened);
}

// rgb: the mean over the mip levels, without small lights. w: the integral of K.
vec4 filtered_mean(vec3 n, float alpha) {
    mat3 basis = basis_around(n);
    vec4 sum = vec4(0.0);
    float integral = 0.0;
    for (uint i = 0u; i < task.samples; ++i) {
        LobeSample lobe = lobe_sample(i, alpha);
        sum += vec4(filtered_radiance(basis * lobe.direction, lobe.footprint), 1.0) * lobe.sharpened;
        integral += lobe.weight;
    }
    float a2 = alpha * alpha;
    float scale = 8.0 * PI * (1.0 / alpha - inversesqrt(0.5 + 0.5 * a2)) / ((1.0 - a2) * float(task.samples));
    return vec4(sum.rgb / sum.w, integral * scale);
}

// The small lights: sum of K intensity. A light's variance widens the lobe.
vec3 small_light_sum(vec3 n, float alpha) {
    float a2 = alpha * alpha;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < listed_lights(); ++i) {
        SmallLight light = small_lights[i];
        vec3 chord = light.direction - n;
        float x = 0.25 * dot(chord, chord);   // not 1 - NoL, which loses its digits where a narrow lobe needs them
        float wide = a2 + light.spread;
        float q = wide + (1.0 - a2) * x;
        sum += light.intensity * (max(1.0 - 2.0 * x, 0.0) * wide / (a2 * q * q));
    }
    return sum;
}

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, task.size))) return;
    vec3 n = normalize(cube_position(texel_center(texel.xy, task.size), texel.z));

    vec3 radiance;
    if (task.level == 0u) {
        // A mirror. The source has as many texels a side, or twice as many: then n is where four of them meet, and
        // linear interpolation averages them.
        radiance = textureLod(source_cube, n, 0.0).rgb;
    } else {
        // 0.999: at alpha = 1, where K is the cosine, `scale` and x would be 0 / 0.
        float alpha = min(alpha_from_roughness(roughness_of_level(task.level, task.levels)), 0.999);
        vec4 mean = filtered_mean(n, alpha);
        radiance = mean.rgb + small_light_sum(n, alpha) / mean.w;
    }
    imageStore(target, ivec3(texel), vec4(rounded_to_half(radiance), 1.0));
}
