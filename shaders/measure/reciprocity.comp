#version 460
#include "interface.glsl"
#include "measure/surface.glsl"

// Helmholtz reciprocity: f(l, v) = f(v, l). Tests many pairs of directions per roughness (row). Each column searches
// its own share and keeps the largest |f(l, v) - f(v, l)| relative to the mean of both.

layout(local_size_x = 8, local_size_y = 8) in;

struct Worst {
    float error;
    vec3 l;
    vec3 v;
};

layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) writeonly buffer Results { Worst worst[]; };

// cos 85 degrees. Closer to the horizon the difference is rounding error.
const float LEAST_COSINE = 0.0872;

vec3 direction_above(vec2 u) { return direction_from_cosine(mix(1.0, LEAST_COSINE, u.x), u.y); }

vec3 value_of(float roughness, vec3 l, vec3 v) { return evaluate_brdf(measured_surface(roughness, v), l, v).value; }

// The largest error of the channels. 1e-6 avoids 0 / 0 for black. NaN compares false to everything, so NaN and infinity
// return an error larger than any other.
float error_between(vec3 there, vec3 back) {
    float error = max_component(abs(there - back) / max(0.5 * abs(there + back), vec3(1e-6)));
    bool is_number = !any(isnan(there)) && !any(isnan(back)) && !any(isinf(there)) && !any(isinf(back));
    return is_number ? error : 1e30;
}

void main() {
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(cell, task.size))) return;
    float roughness = roughness_of_row(cell.y);
    vec2 alpha = vec2(alpha_from_roughness(roughness));
    Worst found = Worst(0.0, vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < task.samples; ++i) {
        vec3 a = random_numbers(uvec3(i, cell));
        vec3 b = random_numbers(uvec3(i, cell.x, cell.y + task.size.y));
        vec3 v = direction_above(a.xy);
        // Half of the pairs lie in the lobe, where f is large and changes fast.
        bool in_lobe = a.z < 0.5;
        vec3 l = in_lobe ? reflect(-v, sample_ggx_vndf(b.xy, v, alpha)) : direction_above(b.xy);
        if (l.z < LEAST_COSINE) continue;
        float error = error_between(value_of(roughness, l, v), value_of(roughness, v, l));
        if (error > found.error) found = Worst(error, l, v);
    }
    worst[cell.y * task.size.x + cell.x] = found;
}
