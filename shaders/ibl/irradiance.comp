#version 460
#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "ibl/small_lights.glsl"

// Diffuse light from the environment as nine numbers for each color: irradiance is radiance smoothed by a cosine, and
// of what is left spherical harmonics of three bands hold 99 % of the energy (Ramamoorthi & Hanrahan 2001, section 3).
// Against the integral: off by 3 % of the mean under a studio's lamps, by 8 % under a sun and a clear sky.
//
//   L_i = integral of L Y_i                 over all directions, here the texels of one level of the cube map
//   E(n) = sum of A_i L_i Y_i(n)            (eq. 9), A = pi, 2 pi / 3, pi / 4 for the bands 0, 1, 2 (eq. 8)
//
// Stored is what the lookup needs, E / pi as a polynomial: constants of Y and A multiplied in, in this order:
//
//   E(n) / pi = sh0 + sh1 y + sh2 z + sh3 x + sh4 xy + sh5 yz + sh6 z^2 + sh7 xz + sh8 (x^2 - y^2)
//
// One group of 256 invocations: each sums up every 256th texel, then the sums are added as a tree.

const uint THREADS = 256u;
layout(local_size_x = 256) in;
layout(set = SET_TASK, binding = BINDING_SOURCE_CUBE) uniform samplerCube source_cube;

shared vec3 partial[THREADS];

const float Y0 = 0.28209479;   // sqrt(1 / 4 pi)
const float Y1 = 0.48860251;   // sqrt(3 / 4 pi)
const float Y2 = 1.09254843;   // sqrt(15 / 4 pi); half of it for x^2 - y^2
const float Y20 = 0.31539157;  // sqrt(5 / 16 pi), of 3 z^2 - 1
const float BAND_1 = 2.0 / 3.0;   // A / pi
const float BAND_2 = 1.0 / 4.0;

float[9] harmonics(vec3 d) {
    return float[9](Y0, Y1 * d.y, Y1 * d.z, Y1 * d.x, Y2 * d.x * d.y, Y2 * d.y * d.z, Y20 * (3.0 * d.z * d.z - 1.0),
                    Y2 * d.x * d.z, 0.5 * Y2 * (d.x * d.x - d.y * d.y));
}

// What all invocations hold, added up. Each of them gets the sum.
vec3 sum_of_all(vec3 value) {
    uint id = gl_LocalInvocationIndex;
    barrier();                 // the sum before has been read
    partial[id] = value;
    barrier();
    for (uint half_count = THREADS / 2u; half_count > 0u; half_count /= 2u) {
        if (id < half_count) partial[id] += partial[id + half_count];
        barrier();
    }
    return partial[0];
}

// The least of what all hold.
float least_of_all(float value) {
    uint id = gl_LocalInvocationIndex;
    barrier();
    partial[id].x = value;
    barrier();
    for (uint half_count = THREADS / 2u; half_count > 0u; half_count /= 2u) {
        if (id < half_count) partial[id].x = min(partial[id].x, partial[id + half_count].x);
        barrier();
    }
    return partial[0].x;
}

// Three bands of a small sun in a black sky ring: they fall to -4 % of its irradiance on the far side, and light must
// not be negative. Then all that depends on the direction is scaled by one factor, the largest that leaves 0, as a
// window does (Sloan 2008, "Stupid spherical harmonics tricks", windowing), but only as far as this environment needs:
// any with a tenth of its light from elsewhere keeps every bit. One factor for all colors, or rings would be tinted.
float window(vec3 sh[9]) {
    uint id = gl_LocalInvocationIndex;
    // As many directions as there are invocations, evenly spread: a spiral, the golden ratio of a turn for each.
    vec3 n = direction_from_cosine(1.0 - (2.0 * float(id) + 1.0) / float(THREADS), fract(float(id) * 0.61803399));
    float y[9] = harmonics(n);
    vec3 directed = vec3(0.0);
    for (int i = 1; i < 9; ++i) directed += sh[i] * y[i];
    // mean + k directed >= 0. 1e-20: black has no factor, and needs none.
    vec3 mean = sh[0] * Y0;
    return least_of_all(min(1.0, min_component(mean / max(-directed, vec3(1e-20)))));
}

void main() {
    vec3 sh[9];
    for (int i = 0; i < 9; ++i) sh[i] = vec3(0.0);

    uint side = task.size.x;
    for (uint i = gl_LocalInvocationIndex; i < 6u * side * side; i += THREADS) {
        vec2 st = texel_center(uvec2(i % side, i / side % side), task.size);
        vec3 d = cube_position(st, i / (side * side));
        vec3 light = textureLod(source_cube, d, float(task.level)).rgb * solid_angle(st, 1.0 / float(side));
        float y[9] = harmonics(normalize(d));
        for (int j = 0; j < 9; ++j) sh[j] += light * y[j];
    }
    // The levels lack the small lights.
    for (uint i = gl_LocalInvocationIndex; i < listed_lights(); i += THREADS) {
        float y[9] = harmonics(small_lights[i].direction);
        for (int j = 0; j < 9; ++j) sh[j] += small_lights[i].intensity * y[j];
    }
    for (int i = 0; i < 9; ++i) {
        float band = i == 0 ? 1.0 : i < 4 ? BAND_1 : BAND_2;
        sh[i] = sum_of_all(sh[i]) * band;
    }

    float k = window(sh);
    if (gl_LocalInvocationIndex != 0u) return;
    // Y_i's own constants, and the -1 of 3 z^2 - 1 to where the other constant is.
    irradiance_sh[0] = sh[0] * Y0 - k * sh[6] * Y20;
    for (int i = 1; i < 4; ++i) irradiance_sh[i] = k * sh[i] * Y1;
    irradiance_sh[4] = k * sh[4] * Y2;
    irradiance_sh[5] = k * sh[5] * Y2;
    irradiance_sh[6] = k * sh[6] * (3.0 * Y20);
    irradiance_sh[7] = k * sh[7] * Y2;
    irradiance_sh[8] = k * sh[8] * (0.5 * Y2);
}
