#version 460
#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/filter.glsl"
#include "ibl/half.glsl"
#include "ibl/levels.glsl"
#include "ibl/lobe.glsl"
#include "ibl/small_lights.glsl"

// Prefilters one level for the specular lobe: the mean of radiance weighted by K = D V NoL with n = v (Karis 2013).
// ibl/lobe.comp has chosen the samples and their weights for the selected D and V.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray target;

// The mean over the mip levels, without small lights.
vec3 filtered_mean(vec3 n) {
    mat3 basis = basis_around(n);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < task.samples; ++i) {
        LobeSample lobe = lobes[task.level].samples[i];
        float sin_theta = 2.0 * sqrt(lobe.x * (1.0 - lobe.x));
        float phi = 2.0 * PI * golden_turns(i);
        vec3 direction = basis * vec3(sin_theta * cos(phi), sin_theta * sin(phi), 1.0 - 2.0 * lobe.x);
        sum += vec4(filtered_radiance(direction, lobe.footprint), 1.0) * lobe.weight;
    }
    return sum.rgb / max(sum.w, 1e-30);
}

// The small lights: sum of K intensity. A light's variance widens the lobe.
vec3 small_light_sum(vec3 n, float alpha) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < listed_lights(); ++i) {
        SmallLight light = small_lights[i];
        vec3 chord = light.direction - n;
        float x = 0.25 * dot(chord, chord);   // not 1 - NoL, which loses its digits where a narrow lobe needs them
        float k = lobe_weight(x, sqrt(alpha * alpha + light.spread));
        if (is_weight(k)) sum += light.intensity * k;
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
        float alpha = min(alpha_from_roughness(roughness_of_level(task.level, task.levels)), 0.999);
        radiance = filtered_mean(n) + small_light_sum(n, alpha) / max(lobes[task.level].integral, 1e-30);
    }
    imageStore(target, ivec3(texel), vec4(rounded_to_half(radiance), 1.0));
}
