// The surface of a rock: how far it lies above the model.
#ifndef USER_ROCK_GLSL
#define USER_ROCK_GLSL

#include "common/sampling.glsl"
#include "user/params.glsl"

// Gradient noise: a random slope at each point of a lattice, blended by a quintic (Perlin 2002, "Improving Noise"; here with any
// slope instead of twelve). About -1..1, 0 at the points of the lattice.
float noise(vec3 p) {
    ivec3 cell = ivec3(floor(p));
    vec3 f = p - vec3(cell);
    vec3 blend = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        vec3 slope = 2.0 * random_numbers(uvec3(cell + corner + 4096)) - 1.0;
        vec3 weight = mix(1.0 - blend, blend, vec3(corner));
        sum += weight.x * weight.y * weight.z * dot(slope, f - vec3(corner));
    }
    return sum;
}

// Ridges: four octaves of 1 - |noise|, each half as high and half as wide as the one before (Musgrave 1994, in "Texturing and
// Modeling", chapter "Procedural Fractal Terrains"). Meters above a surface at `position_ws`.
float rock_above(vec3 position_ws) {
    vec3 p = position_ws / frame.scene_radius * rock_scale;
    float height = 0.0;
    float octave = 1.0;
    for (int i = 0; i < 4; ++i) {
        height += octave * (0.7 - abs(noise(p)));
        octave *= 0.5;
        p *= 2.03;    // not 2: the points of all lattices would meet, where the noise is 0
    }
    return rock_height * frame.scene_radius * height;
}

// The gradient of rock_above by forward differences: meters per meter.
vec3 rock_gradient(vec3 position_ws, float here) {
    float step_m = 0.01 * frame.scene_radius / rock_scale;
    vec2 along = vec2(step_m, 0.0);
    vec3 ahead = vec3(rock_above(position_ws + along.xyy), rock_above(position_ws + along.yxy),
                      rock_above(position_ws + along.yyx));
    return (ahead - here) / step_m;
}

#endif
