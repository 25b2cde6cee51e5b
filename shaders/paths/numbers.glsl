// The random numbers of a path: even points for its first reflection, hashed ones for all others.
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

// Additive recurrence in three dimensions: point i is the fraction of i times (1/g, 1/g^2, 1/g^3), g^4 = g + 1 (Roberts
// 2018, "The unreasonable effectiveness of quasirandom sequences"). Every contiguous run fills the cube evenly, so each
// frame continues where the last one stopped. Integers, with 2^32 for 1, never lose digits. A random shift (Cranley &
// Patterson 1976) decorrelates neighboring pixels.
vec3 recurrence(uvec3 shift, uint i) {
    return vec3((shift + i * uvec3(3518319155u, 2882110345u, 2360945575u)) >> 8) * exp2(-24.0);
}

// Numbers to draw a direction at reflection `vertex`, counted from 0: towards a light or of a lobe. At the first reflection
// both take the same points with different shifts, since their light is added: two integrals over three dimensions each.
// After it, light depends on all the numbers before, and even points gain nothing.
vec3 numbers_of(PathNumbers numbers, uint vertex, bool to_light) {
    uvec3 shift = random_words(numbers.pixel + uvec3(0u, 2u * vertex + (to_light ? 1u : 0u), 0u));
    if (vertex > 0u) return random_numbers(shift + uvec3(numbers.path, 0u, 0u));
    return recurrence(shift, numbers.path);
}

// Random bits for the ray that follows.
uint seed_of(PathNumbers numbers, uint vertex, bool to_light) {
    return random_words(numbers.pixel + uvec3(numbers.path, 2u * vertex + (to_light ? 1u : 0u), 3u)).x;
}

#endif
