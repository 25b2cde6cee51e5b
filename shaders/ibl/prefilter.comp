#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/filter.glsl"
#include "ibl/half.glsl"
#include "ibl/lobe.glsl"
#include "ibl/small_lights.glsl"

// Prefilters two levels for the specular lobe, an even one and the odd one before it, which have the same size: the mean
// of radiance weighted by K = D V NoL with n = v (Karis 2013). Both read the same samples, with weights of their own;
// ibl/lobe.comp has chosen them for the selected D and V.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = SET_TASK, binding = BINDING_TARGET, rgba16f) writeonly uniform image2DArray even_target;
layout(set = SET_TASK, binding = BINDING_TARGET_ODD, rgba16f) writeonly uniform image2DArray odd_target;

struct Radiances {
    vec3 even;
    vec3 odd;
};

// The means over the mip levels, without small lights.
Radiances filtered_means(vec3 n) {
    mat3 basis = basis_around(n);
    Radiances sum = Radiances(vec3(0.0), vec3(0.0));
    vec2 weight = vec2(0.0);
    for (uint i = 0u; i < task.samples; ++i) {
        LobeSample lobe = lobes[task.level].samples[i];
        float sin_theta = 2.0 * sqrt(lobe.x * (1.0 - lobe.x));
        float phi = 2.0 * PI * golden_turns(i);
        vec3 direction = basis * vec3(sin_theta * cos(phi), sin_theta * sin(phi), 1.0 - 2.0 * lobe.x);
        vec3 radiance = filtered_radiance(direction, lobe.footprint);
        sum.even += radiance * lobe.weight.x;
        sum.odd += radiance * lobe.weight.y;
        weight += lobe.weight;
    }
    return Radiances(sum.even / max(weight.x, 1e-30), sum.odd / max(weight.y, 1e-30));
}

// The small lights: sum of K intensity over the integral of K. A light's variance widens the lobe.
void add_small_lights(vec3 n, inout Radiances to) {
    vec2 alpha = alpha_of_lobes(task.level);
    vec2 scale = 1.0 / max(lobes[task.level].integral, vec2(1e-30));
    for (uint i = 0u; i < listed_lights(); ++i) {
        SmallLight light = small_lights[i];
        vec3 chord = light.direction - n;
        float x = 0.25 * dot(chord, chord);   // not 1 - NoL, which loses its digits where a narrow lobe needs them
        float even = lobe_weight(x, sqrt(alpha.x * alpha.x + light.spread));
        float odd = lobe_weight(x, sqrt(alpha.y * alpha.y + light.spread));
        if (is_weight(even)) to.even += light.intensity * (even * scale.x);
        if (is_weight(odd)) to.odd += light.intensity * (odd * scale.y);
    }
}

void main() {
    uvec3 texel = gl_GlobalInvocationID;
    if (any(greaterThanEqual(texel.xy, task.size))) return;
    vec3 n = normalize(cube_position(texel_center(texel.xy, task.size), texel.z));
    if (task.level == 0u) {
        // A mirror. The source has as many texels a side, or twice as many: then n is where four of them meet, and
        // linear interpolation averages them.
        imageStore(even_target, ivec3(texel), vec4(rounded_to_half(textureLod(source_cube, n, 0.0).rgb), 1.0));
        return;
    }
    Radiances radiance = filtered_means(n);
    add_small_lights(n, radiance);
    imageStore(even_target, ivec3(texel), vec4(rounded_to_half(radiance.even), 1.0));
    imageStore(odd_target, ivec3(texel), vec4(rounded_to_half(radiance.odd), 1.0));
}
