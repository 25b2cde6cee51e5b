// The list of small lights, for the stages that make it.
#ifndef IBL_SMALL_LIGHTS_FIND_GLSL
#define IBL_SMALL_LIGHTS_FIND_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/small_lights/list.glsl"

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

// Light of the list within this distance of the brightest light belongs to the same source. Radians: a sun has a radius of
// 0.0046, and a texel of a map with 1024 columns is 0.006 wide.
const float SUN_REACH = 0.02;
// The largest variance of a sun. A disk that fills the reach has 1e-4.
const float LARGEST_SUN_VARIANCE = 6e-5;

bool belongs_to_sun(SmallLight light, vec3 direction) {
    vec3 chord = light.direction - direction;
    return dot(chord, chord) < SUN_REACH * SUN_REACH;
}

// Takes the sun, if there is one, out of the complete list. For a single invocation.
void separate_sun() {
    uint count = min(found.count, LARGEST_COUNT);
    SmallLight brightest = SmallLight(vec3(0.0), vec3(0.0), 0.0);
    for (uint i = 0u; i < count; ++i) {
        SmallLight light = found.lights[i];
        if (max_component(light.intensity) > max_component(brightest.intensity)) brightest = light;
    }
    SmallLight sun = SmallLight(vec3(0.0), vec3(0.0), 0.0);
    float squared = 0.0;       // of the distances to the brightest light
    float weights = 0.0;
    for (uint i = 0u; i < count; ++i) {
        SmallLight light = found.lights[i];
        if (!belongs_to_sun(light, brightest.direction)) continue;
        float weight = max_component(light.intensity);
        vec3 chord = light.direction - brightest.direction;
        sun.intensity += light.intensity;
        sun.direction += chord * weight;
        sun.spread += light.spread * weight;
        squared += dot(chord, chord) * weight;
        weights += weight;
    }
    if (weights <= 0.0) return;
    vec3 mean_chord = sun.direction / weights;
    sun.direction = normalize(brightest.direction + mean_chord);
    // Half of the distances' variance is along one axis.
    sun.spread = sun.spread / weights + 0.5 * (squared / weights - dot(mean_chord, mean_chord));
    if (sun.spread > LARGEST_SUN_VARIANCE) return;

    uint others = 0u;
    for (uint i = 0u; i < count; ++i) {
        SmallLight light = found.lights[i];
        if (!belongs_to_sun(light, brightest.direction)) found.lights[others++] = light;
    }
    found.count = others;
    found.sun = sun;
}

#endif
