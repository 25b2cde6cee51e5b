// Small lights: sources far brighter than their surroundings and smaller than any lobe, such as suns, lamps and their
// glints. Most of the light is then in a few texels, and a mip level does not know where in a texel it comes from: its
// highlights are off by up to half a texel. That was most of the prefilter's error (10 % RMSE under a sun, at level 2
// with 64 samples; 0.02 % once they are removed). So level 0 keeps the full picture, while the levels below clip texels
// at a limit. The clipped light becomes a list of directions, which the bake adds exactly.
//
// With environment.suns, the brightest of these sources that are as small as a sun are not in the list: irradiance and
// prefiltered levels leave them out, and lighting/sun.glsl lights the surface with them as directional lights. For a sun, a level would
// need texels much smaller than its lobe, and the split sum, whose lobe is that of v = n, would be off by up to half of the light.
#ifndef IBL_SMALL_LIGHTS_LIST_GLSL
#define IBL_SMALL_LIGHTS_LIST_GLSL

#include "interface.glsl"

const uint BRIGHTNESS_STEPS = 64u;
// A sun of 0.53 degrees covers 5 to 25 texels at 512 x 512, and up to 150 if the map has 1024 columns.
const uint LARGEST_COUNT = 192u;

struct SmallLight {
    vec3 direction;            // unit, to the center of the clipped light
    vec3 intensity;            // radiance above the limit times solid angle, for one texel of level 1
    float spread;              // variance of its directions along one axis, radians squared
};

// One buffer for the whole bake, zeroed at its start. Rust reads the suns, so their place is the first.
struct SmallLightList {
    uint sun_count;
    SmallLight suns[MAX_SUNS];                 // the brightest first
    uint brightness_count[BRIGHTNESS_STEPS];   // histogram of level 0 by brightness_step
    uint count;                                // can exceed the list, see brightness_limit
    SmallLight lights[LARGEST_COUNT];
};

// Half octaves: step 32 starts at 1, step 63 ends at the largest half float. 1e-9 falls into step 0.
uint brightness_step(float brightness) {
    return uint(clamp(int(floor(2.0 * log2(max(brightness, 1e-9)))) + 32, 0, int(BRIGHTNESS_STEPS) - 1));
}

#endif
