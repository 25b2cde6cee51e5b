#version 460
#include "interface.glsl"
#include "brdf/energy/dfg.glsl"
#include "brdf/layers/sheen.glsl"
#include "brdf/visibility.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/maps/half.glsl"

// Directional albedo of the selected sheen, for brdf/energy/albedo.glsl: E = integral of f NoL dl. Columns are
// sqrt(NoV) and rows roughness, each 0 in the first and 1 in the last. The samples cover the whole hemisphere, since
// most of Charlie's distribution lies below it. They are a lattice with the cosine 3 u^2 - 2 u^3, weighted by its
// derivative, as in ibl/dfg.comp.
//
// Charlie's E exceeds 1 (up to 2.2) for grazing v on smooth sheen, where V is unbounded: the lobe gains that energy.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, task.size))) return;

    float n_dot_v = max(cosine_of_column(texel.x, task.size.x), MIN_N_DOT_V);
    float roughness = float(texel.y) / float(task.size.y - 1u);
    vec3 v = vec3(sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
    float sum = 0.0;
    for (uint i = 0u; i < task.samples; ++i) {
        float u = (float(i) + 0.5) / float(task.samples);
        vec3 l = direction_from_cosine(u * u * (3.0 - 2.0 * u), fract(float(i) * 0.618033988));
        vec3 h = normalize(l + v);
        sum += 6.0 * u * (1.0 - u) * f_sheen(l.z, v.z, h.z, dot(v, h), roughness) * l.z;
    }
    float albedo = 2.0 * PI * sum / float(task.samples);
    imageStore(target, ivec3(texel, 0), vec4(rounded_to_half(vec3(albedo)), 1.0));
}
