// Filtered importance sampling of a cube map (Krivanek & Colbert 2008): few samples, each read at the level whose texels
// are as large as the part of the sphere that the sample stands for. The samples then cover the lobe without gaps, and a
// small bright sun is met by all of them near it, not by one in a thousand: no noise, no fireflies.
//
// The lobe is seen along its axis, N = V = R (Karis 2013), so it is the same around every texel. A group works it out
// once, in shared memory; a texel only turns it into place.
#ifndef IBL_FILTER_GLSL
#define IBL_FILTER_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"

layout(set = SET_TASK, binding = BINDING_SOURCE_CUBE) uniform samplerCube source_cube;

const uint LOBE_SIZE = 256u;

struct LobeSample {
    vec3 direction;            // tangent space; z = NoL is its weight
    float lod;
};

shared LobeSample lobe[LOBE_SIZE];

// Points on a spiral, turned by the golden ratio of a turn each: evenly spread however the warp stretches the radius,
// and around the axis at any count. (Hammersley's points are aligned to it.)
vec2 spiral(uint i, uint count) {
    return vec2((float(i) + 0.5) / float(count), fract(float(i) * 0.618033988));
}

// Levels above the even fit. Footprints of samples have to overlap, or a sun between two is lost and one on top of a sample
// counts twice; too wide ones blur. Measured against brute force: half a level has the least error.
const float LOD_BIAS = 0.5;

// Light that is reflected by h when seen along the normal, and the level to read. `pdf` is the density of the direction.
//
// The sample stands for 1 / (count pdf) steradians, a texel in the middle of a face for 4 / side^2, and for four times as
// much on the next level: lod = log2(ratio) / 2 (Krivanek & Colbert 2008; Colbert & Krivanek 2007, eq. 13).
LobeSample lobe_sample(vec3 h, float pdf, uint count) {
    vec3 l = vec3(2.0 * h.z * h.xy, 2.0 * h.z * h.z - 1.0);
    float side = float(textureSize(source_cube, 0).x);
    return LobeSample(l, 0.5 * log2(side * side / (4.0 * float(count) * pdf)) + LOD_BIAS);
}

// Adds `count` samples of the lobe around basis[2]: radiance times weight, and the weight.
void gather(mat3 basis, uint count, inout vec4 sum) {
    for (uint i = 0u; i < count; ++i) {
        vec3 d = basis * lobe[i].direction;
        // Texels shrink towards the edges of a face with the cube of d's largest component, down to a fifth.
        float lod = lobe[i].lod - 1.5 * log2(max_component(abs(d)));
        sum += vec4(textureLod(source_cube, d, lod).rgb, 1.0) * lobe[i].direction.z;
    }
}

#endif
