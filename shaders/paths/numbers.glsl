// The random numbers of a path: six for its first reflection, hashed ones for all others.
#ifndef PATHS_NUMBERS_GLSL
#define PATHS_NUMBERS_GLSL

#include "interface.glsl"
#include "common/sampling.glsl"

// A path's random numbers, each uniform in 0 <= x < 1.
struct PathNumbers {
    uvec3 pixel;               // random bits of the pixel
    uint path;                 // index of the path within its pixel
};

PathNumbers path_numbers(uint path) { return PathNumbers(random_words(uvec3(gl_FragCoord.xy, 0u)), path); }

// Additive recurrence in six dimensions: point i is the fraction of i times (1/g, .. 1/g^6), g^7 = g + 1 (Roberts 2018,
// "The unreasonable effectiveness of quasirandom sequences"). Every contiguous run fills the cube evenly, so each frame
// continues where the last one stopped. Integers, with 2^32 for 1, never lose digits. A random shift per pixel (Cranley &
// Patterson 1976) decorrelates neighboring pixels. Beyond the first reflection, light varies so much with every dimension
// that evenness gains nothing.
const uvec3 STEPS_TO_LIGHT = uvec3(3859688306u, 3468523226u, 3117001274u);
const uvec3 STEPS_OF_LOBE = uvec3(2801104767u, 2517223199u, 2262111973u);

vec3 recurrence(uvec3 shift, uint i, uvec3 steps) { return vec3((shift + i * steps) >> 8) * exp2(-24.0); }

// Numbers to draw a direction at reflection `vertex`, counted from 0: towards a light or of a lobe.
vec3 numbers_of(PathNumbers numbers, uint vertex, bool to_light) {
    uint dimension = 2u * vertex + (to_light ? 1u : 0u);
    if (vertex > 0u) return random_numbers(numbers.pixel + uvec3(numbers.path, dimension, 1u));
    uvec3 shift = numbers.pixel ^ (to_light ? 0x55555555u : 0u);
    return recurrence(shift, numbers.path, to_light ? STEPS_TO_LIGHT : STEPS_OF_LOBE);
}

// Random bits for the ray that follows.
uint seed_of(PathNumbers numbers, uint vertex, bool to_light) {
    return random_words(numbers.pixel + uvec3(numbers.path, 2u * vertex + (to_light ? 1u : 0u), 3u)).x;
}

#endif
