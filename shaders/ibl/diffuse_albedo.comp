#version 460
#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "brdf/energy/dfg.glsl"
#include "brdf/surface.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/maps/half.glsl"

// Integrates the selected diffuse model, for brdf/energy/albedo.glsl: albedo = integral of f_diffuse NoL dl, for three
// base colors at once, one per channel; and how the half vectors of that light are distributed. Columns are sqrt(NoV)
// and rows roughness, each 0 in the first and 1 in the last.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, task.size))) return;
    float n_dot_v = max(cosine_of_column(texel.x, DIFFUSE_SIDE), MIN_N_DOT_V);
    float roughness = float(texel.y) / float(DIFFUSE_SIDE - 1u);
    vec3 v = vec3(sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
    vec3 base_color = vec3(1.0, 2.0, 3.0) / 3.0;

    vec3 albedo = vec3(0.0);
    vec4 weights = vec4(0.0);
    bool wrong = false;
    for (uint i = 0u; i < task.samples; ++i) {
        vec2 u = vec2((float(i) + 0.5) / float(task.samples), fract(float(i) * 0.618033988));
        vec3 l = sample_cosine(u);
        vec3 h = normalize(l + v);
        Cosines cosines = Cosines(l.z, v.z, h.z, dot(v, h), dot(l, v));
        vec3 reflected = f_diffuse(base_color, roughness, alpha_from_roughness(roughness), cosines) * PI;
        bool is_wrong = any(isnan(reflected)) || any(isinf(reflected)) || any(lessThan(reflected, vec3(0.0)));
        is_wrong = is_wrong || any(greaterThan(reflected, vec3(1e3)));
        wrong = wrong || is_wrong;
        if (is_wrong) continue;
        albedo += reflected;
        weights += reflected.z * f_weights(cosines.v_dot_h);
    }
    vec3 q = albedo / (base_color * float(task.samples));
    weights /= max(albedo.z, 1e-6);
    imageStore(target, ivec3(texel, 0), vec4(rounded_to_half(q), wrong ? 1.0 : 0.0));
    ivec3 below = ivec3(texel.x, texel.y + DIFFUSE_WEIGHTS * DIFFUSE_SIDE, 0);
    imageStore(target, below, rounded_to_half(weights));
}
