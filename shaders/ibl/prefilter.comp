#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/maps/levels.glsl"
#include "ibl/maps/octahedral.glsl"
#include "ibl/maps/shared_exponent.glsl"
#include "ibl/sampling/filter.glsl"
#include "ibl/sampling/lobe.glsl"
#include "ibl/small_lights/add.glsl"

// Prefilters a pair of levels for the specular lobe, an odd one and the even one after it, which have the same size: the
// mean of radiance weighted by K = D V NoL with n = v (Karis 2013). Both read the same samples, with weights of their own;
// ibl/lobe.comp has chosen them for the selected D and V. Pair 0 is the mirror alone.

layout(local_size_x = 8, local_size_y = 8) in;
// A uniform block: a software device reads a storage buffer separately for each invocation of a group.
layout(set = SET_TASK, binding = BINDING_LOBE, scalar) uniform Source { Lobe lobe; };

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
        vec3 radiance = filtered_radiance(basis * lobe.samples[i].direction, lobe.samples[i].footprint);
        sum.even += radiance * lobe.samples[i].weight.x;
        sum.odd += radiance * lobe.samples[i].weight.y;
        weight += lobe.samples[i].weight;
    }
    return Radiances(sum.even / max(weight.x, 1e-30), sum.odd / max(weight.y, 1e-30));
}

// The small lights but the suns: sum of K intensity over the integral of K.
void add_small_lights(vec3 n, inout Radiances to) {
    vec2 alpha = alpha_of_lobes(task.level);
    vec2 scale = 1.0 / max(lobe.integral, vec2(1e-30));
    for (uint i = 0u; i < listed_lights(); ++i) {
        SmallLight light = listed.lights[i];
        vec3 chord = light.direction - n;
        float x = 0.25 * dot(chord, chord);   // not 1 - NoL, which loses its digits where a narrow lobe needs them
        to.even += light.intensity * (lobe_weight_of_light(x, alpha.x, light.spread) * scale.x);
        to.odd += light.intensity * (lobe_weight_of_light(x, alpha.y, light.spread) * scale.y);
    }
}

void store(Tile tile, ivec2 within, vec3 radiance) {
    store_texel(ivec2(floor(tile.corner)) + within, SPECULAR_WIDTH, radiance);
}

// The mirror: the mean of 2 x 2 points of the texel, which may be larger than one of the source.
vec3 mirrored(ivec2 texel, Tile tile) {
    vec2 p = point_of_texel(texel, tile);
    float reach = 0.25 * (point_of_texel(texel + 1, tile) - p).x;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 shift = vec2((i & 1) == 0 ? -reach : reach, i < 2 ? -reach : reach);
        sum += textureLod(source_cube, octahedral_direction(p + shift), 0.0).rgb;
    }
    return 0.25 * sum;
}

void main() {
    // The tile of the even level is a whole number of texels to the right of that of the odd one.
    float row = float(task.level);
    Tile tile = even_tile(row, scale_of_row(row));
    ivec2 within = ivec2(gl_GlobalInvocationID.xy);
    ivec2 texel = ivec2(floor(tile.corner)) + within;
    if (!contains(tile, texel)) return;
    if (task.level == 0u) {
        store(tile, within, mirrored(texel, tile));
        return;
    }
    vec3 n = octahedral_direction(point_of_texel(texel, tile));
    Radiances radiance = filtered_means(n);
    add_small_lights(n, radiance);
    store(tile, within, radiance.even);
    store(odd_tile(scale_of_row(row)), within, radiance.odd);
}
