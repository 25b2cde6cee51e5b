// What is far brighter than all around it and smaller than any lobe: suns, lamps, their glints. A few texels of the
// cube map hold most of the light then, and a mip level cannot say where in a texel it comes from: a highlight made
// from it is off by up to half a texel, which was most of the prefilter's error (under a sun 10 % RMSE at level 2 with
// 64 samples; now 0.02 %). So they are taken out. Level 0 keeps the picture; the levels below hold what is left when
// texels are cut off at a limit; what was cut is a list of directions, and the bake adds it up exactly.
#ifndef IBL_SMALL_LIGHTS_GLSL
#define IBL_SMALL_LIGHTS_GLSL

#include "interface.glsl"

const uint BRIGHTNESS_STEPS = 64u;
// A sun of 0.53 degrees covers 5 to 25 texels of 512 x 512, and up to 150 when it comes from a map with 1024 columns.
const uint LARGEST_COUNT = 192u;

struct SmallLight {
    vec3 direction;            // unit, to the center of its light
    vec3 intensity;            // radiance above the limit times solid angle, all of one texel of level 1
    float spread;              // variance of the directions along one axis, radians squared
};

// One buffer for a whole bake, all 0 before it.
layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) buffer Results {
    uint brightness_count[BRIGHTNESS_STEPS];   // texels of level 0 by brightness_step
    uint small_light_count;
    SmallLight small_lights[LARGEST_COUNT];
};

// Half octaves: 32 starts at 1, 63 ends at the brightest half float. 1e-9 is below all of them.
uint brightness_step(float brightness) {
    return uint(clamp(int(floor(2.0 * log2(max(brightness, 1e-9)))) + 32, 0, int(BRIGHTNESS_STEPS) - 1));
}

// The lowest brightness with no more texels above it than the list holds.
float brightness_limit() {
    uint lowest = BRIGHTNESS_STEPS;
    for (uint above = 0u; lowest > 0u; --lowest) {
        above += brightness_count[lowest - 1u];
        if (above > LARGEST_COUNT) break;
    }
    return exp2(0.5 * (float(lowest) - 32.0));
}

// No more than the list holds, whatever the rounding of a logarithm did.
uint listed_lights() { return min(small_light_count, LARGEST_COUNT); }

#endif
