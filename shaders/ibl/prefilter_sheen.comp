#version 460
#include "interface.glsl"
#include "brdf/sheen.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/filter.glsl"
#include "ibl/half.glsl"
#include "ibl/levels.glsl"
#include "ibl/small_lights.glsl"

// Prefilters one level for sheen: the mean of radiance weighted by K = D NoL of "Charlie", with N = V = R
// (KHR_materials_sheen). ibl/prefilter.comp explains the notation.
//
// D is proportional to sin^(1 / alpha) = x^p, p = 1 / (2 alpha), so K = (1 - 2x) (2x)^p up to factors that cancel. Its
// integral is 4 pi times the one over x from 0 to 1/2: 2 pi / ((p + 1) (p + 2)).

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

// With a density proportional to (2x)^p, (2x)^(p + 1) is uniform. The samples form a ring near the horizon; NoL is
// their weight.
vec3 filtered_mean(vec3 n, float p) {
    mat3 basis = basis_around(n);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < task.samples; ++i) {
        float two_x = pow((float(i) + 0.5) / float(task.samples), 1.0 / (p + 1.0));
        float pdf = (p + 1.0) * pow(two_x, p) / (2.0 * PI);
        float n_dot_l = 1.0 - two_x;
        vec3 d = basis * direction_from_cosine(n_dot_l, golden_turns(i));
        sum += vec4(filtered_radiance(d, 1.0 / (float(task.samples) * pdf)), 1.0) * n_dot_l;
    }
    return sum.rgb / sum.w;
}

vec3 small_light_sum(vec3 n, float p) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < listed_lights(); ++i) {
        float n_dot_l = dot(small_lights[i].direction, n);
        if (n_dot_l > 0.0) sum += small_lights[i].intensity * (n_dot_l * pow(1.0 - n_dot_l, p));
    }
    return sum;
}

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, task.size))) return;
    vec3 n = normalize(cube_position(texel_center(texel.xy, task.size), texel.z));
    float p = 0.5 / sheen_alpha(roughness_of_level(task.level, task.levels));
    float integral = 2.0 * PI / ((p + 1.0) * (p + 2.0));
    vec3 radiance = filtered_mean(n, p) + small_light_sum(n, p) / integral;
    imageStore(target, ivec3(texel), vec4(rounded_to_half(radiance), 1.0));
}
