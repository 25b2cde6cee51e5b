#version 460
#include "interface.glsl"
#include "brdf/sheen.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/filter.glsl"
#include "ibl/half.glsl"
#include "ibl/levels.glsl"

// Light from the environment as sheen reflects it, one level: the mean of radiance, weighted with D NoL of "Charlie".

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

// Below the horizon there is no light, so no samples: seen along the normal, light at the horizon is reflected by fibers
// at 45 degrees. Their sine is sqrt(1/2), and u = sin^(2 + 1/alpha) by the warp. Most fibers stand steeper.
LobeSample charlie_lobe(uint i, float alpha) {
    float above = pow(0.5, 1.0 + 0.5 / alpha);
    vec2 u = spiral(i, task.samples);
    vec3 h = sample_charlie(vec2(u.x * above, u.y), alpha);
    return lobe_sample(h, pdf_reflected(pdf_charlie(h.z, alpha), h.z) / above, task.samples);
}

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    bool inside = all(lessThan(texel.xy, task.size));
    vec3 n = normalize(cube_position(texel_center(texel.xy, task.size), texel.z));
    mat3 basis = basis_around(n);
    vec4 sum = vec4(0.0);

    // Mesa 22.3's lavapipe ends the process at a loop with barriers that no branch precedes.
    if (task.samples == 0u) return;
    float alpha = sheen_alpha(roughness_of_level(task.level, task.levels));
    for (uint first = 0u; first < task.samples; first += LOBE_SIZE) {
        uint count = min(LOBE_SIZE, task.samples - first);
        barrier();             // all have gathered what is overwritten
        for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) lobe[i] = charlie_lobe(first + i, alpha);
        barrier();
        if (inside) gather(basis, count, sum);
    }
    if (inside) imageStore(target, ivec3(texel), vec4(rounded_to_half(sum.rgb / sum.w), 1.0));
}
