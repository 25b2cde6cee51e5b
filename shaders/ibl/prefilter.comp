#version 460
#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/filter.glsl"
#include "ibl/half.glsl"
#include "ibl/levels.glsl"

// Light from the environment as a rough surface mirrors it, one level: the mean of radiance, weighted with D NoL of GGX.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

// Below the horizon there is no light, so no samples: seen along the normal, light at the horizon is mirrored by facets
// at 45 degrees. By the warp, tan^2 = alpha^2 u / (1 - u), these are at u = 1 / (1 + alpha^2).
LobeSample ggx_lobe(uint i, float alpha) {
    float above = 1.0 / (1.0 + alpha * alpha);
    vec2 u = spiral(i, task.samples);
    vec3 h = sample_ggx(vec2(u.x * above, u.y), alpha);
    return lobe_sample(h, pdf_reflected(pdf_ggx(h.z, alpha), h.z) / above, task.samples);
}

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    bool inside = all(lessThan(texel.xy, task.size));
    vec3 n = normalize(cube_position(texel_center(texel.xy, task.size), texel.z));
    mat3 basis = basis_around(n);
    vec4 sum = vec4(0.0);

    if (task.level == 0u) {
        // A mirror: only the size changes.
        float lod = log2(float(textureSize(source_cube, 0).x) / float(task.size.x));
        sum = vec4(textureLod(source_cube, n, lod).rgb, 1.0);
    } else {
        float alpha = alpha_from_roughness(roughness_of_level(task.level, task.levels));
        for (uint first = 0u; first < task.samples; first += LOBE_SIZE) {
            uint count = min(LOBE_SIZE, task.samples - first);
            barrier();         // all have gathered what is overwritten
            for (uint i = gl_LocalInvocationIndex; i < count; i += 64u) lobe[i] = ggx_lobe(first + i, alpha);
            barrier();
            if (inside) gather(basis, count, sum);
        }
    }
    if (inside) imageStore(target, ivec3(texel), vec4(rounded_to_half(sum.rgb / sum.w), 1.0));
}
