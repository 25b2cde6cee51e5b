// The list of small lights, for the stages that make it.
#ifndef IBL_FIND_SMALL_LIGHTS_GLSL
#define IBL_FIND_SMALL_LIGHTS_GLSL

#include "interface.glsl"
#include "ibl/small_lights.glsl"

layout(set = SET_TASK, binding = BINDING_RESULTS, scalar) buffer Results { SmallLightList found; };

// The lowest limit with at most LARGEST_COUNT texels above it. A few more may pass, since the logarithm of a brightness is
// rounded.
float brightness_limit() {
    uint lowest = BRIGHTNESS_STEPS;
    for (uint above = 0u; lowest > 0u; --lowest) {
        above += found.brightness_count[lowest - 1u];
        if (above > LARGEST_COUNT) break;
    }
    return exp2(0.5 * (float(lowest) - 32.0));
}

#endif
