// The brightest spot of the environment. The alpha of each mip level holds the largest component of all texels below
// (ibl/cube.comp), so a descent through the levels finds it. Monte Carlo paths sample it on purpose: random directions
// would hardly ever hit a sun.
#ifndef LIGHTING_SUN_GLSL
#define LIGHTING_SUN_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "ibl/cube_map.glsl"
#include "lighting/environment.glsl"

// A cone around the spot, sampled uniformly.
struct Sun {
    vec3 axis;                 // unit, world space
    bool counts;               // bright enough to be sampled
};

// 1 degree. The brightest texel may lie on the rim of the real sun, which is 0.53 degrees wide, and the cube map's
// filter spreads it by a texel, which is 0.22 degrees at the center of a face.
const float ONE_MINUS_SUN_COSINE = 1.523e-4;
const float SUN_STERADIANS = 2.0 * PI * ONE_MINUS_SUN_COSINE;
// The spot is sampled if it can contribute more than this fraction of the irradiance.
const float SUN_PART = 0.02;

vec4 spot(vec2 st, uint face, int level) {
    return textureLod(environment_cube, cube_position(st, face), float(level));
}

Sun find_sun() {
    int level = textureQueryLevels(environment_cube) - 1;
    vec3 sum = vec3(0.0);
    uint face = 0u;
    float brightest = -1.0;
    for (uint i = 0u; i < 6u; ++i) {
        vec4 whole = spot(vec2(0.0), i, level);
        sum += whole.rgb;
        if (whole.a > brightest) {
            brightest = whole.a;
            face = i;
        }
    }
    vec2 st = vec2(0.0);
    float reach = 0.5;
    while (--level >= 0) {
        vec2 best = st;
        float found = -1.0;
        for (uint i = 0u; i < 4u; ++i) {
            vec2 quarter = st + reach * (2.0 * vec2(i & 1u, i >> 1) - 1.0);
            float value = spot(quarter, face, level).a;
            if (value > found) {
                found = value;
                best = quarter;
            }
        }
        st = best;
        reach *= 0.5;
    }
    vec3 axis = normalize(world_from_map(cube_position(st, face)));
    return Sun(axis, brightest * SUN_STERADIANS > SUN_PART * PI * max_component(sum / 6.0));
}

vec3 sample_sun(Sun sun, vec2 u) {
    return basis_around(sun.axis) * direction_from_cosine(1.0 - u.x * ONE_MINUS_SUN_COSINE, u.y);
}

// Tests the chord, since a cosine this close to 1 has lost its digits.
float pdf_sun(Sun sun, vec3 l) {
    vec3 chord = l - sun.axis;
    return sun.counts && dot(chord, chord) <= 2.0 * ONE_MINUS_SUN_COSINE ? 1.0 / SUN_STERADIANS : 0.0;
}

#endif
