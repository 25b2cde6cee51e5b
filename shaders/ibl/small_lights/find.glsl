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
// The largest variance of a sun along one axis: that of a disk with a radius of 0.9 degrees. A disk that fills the reach has 1e-4,
// so a source that goes on beyond the reach, such as a window, is no sun.
const float LARGEST_SUN_VARIANCE = 6e-5;
// The least part of the map's light that makes a source a sun. The split sum is off by up to half of a small source's light (a
// metal at roughness 0.8), so what stays in the levels is off by at most 1 % of all light for each source.
const float LEAST_SUN_SHARE = 0.02;
// Sources that are looked at: the brightest ones. More than MAX_SUNS, since some are too large.
const uint MOST_SOURCES = 16u;

// A bit for each light of the list that belongs to a source which is no sun.
uint rejected[LARGEST_COUNT / 32u];

bool is_candidate(uint i) {
    return (rejected[i / 32u] & (1u << (i % 32u))) == 0u && max_component(found.lights[i].intensity) > 0.0;
}

bool is_within(vec3 a, vec3 b, float reach) { return dot(a - b, a - b) < reach * reach; }

// The brightest candidate, or `count`.
uint brightest_light(uint count) {
    uint brightest = count;
    float most = 0.0;
    for (uint i = 0u; i < count; ++i) {
        float brightness = max_component(found.lights[i].intensity);
        if (!is_candidate(i) || brightness <= most) continue;
        brightest = i;
        most = brightness;
    }
    return brightest;
}

// The candidates around `center` as one light.
SmallLight source_around(vec3 center, uint count) {
    SmallLight source = SmallLight(vec3(0.0), vec3(0.0), 0.0);
    vec3 mean_chord = vec3(0.0);
    float squared = 0.0;       // of the distances to the center
    float weights = 0.0;
    for (uint i = 0u; i < count; ++i) {
        SmallLight light = found.lights[i];
        if (!is_candidate(i) || !is_within(light.direction, center, SUN_REACH)) continue;
        float weight = max_component(light.intensity);
        vec3 chord = light.direction - center;
        source.intensity += light.intensity;
        source.spread += light.spread * weight;
        mean_chord += chord * weight;
        squared += dot(chord, chord) * weight;
        weights += weight;
    }
    mean_chord /= weights;
    source.direction = normalize(center + mean_chord);
    // Half of the distances' variance is along one axis.
    source.spread = source.spread / weights + 0.5 * (squared / weights - dot(mean_chord, mean_chord));
    return source;
}

// Takes the suns out of the complete list. `whole`: the integral of the map's radiance. For a single invocation.
void separate_suns(vec3 whole) {
    uint count = min(found.count, LARGEST_COUNT);
    for (uint i = 0u; i < LARGEST_COUNT / 32u; ++i) rejected[i] = 0u;
    float least = LEAST_SUN_SHARE * max_component(whole);
    for (uint round = 0u; round < MOST_SOURCES && found.sun_count < uint(MAX_SUNS); ++round) {
        uint brightest = brightest_light(count);
        if (brightest == count) break;
        vec3 center = found.lights[brightest].direction;
        SmallLight source = source_around(center, count);
        bool is_sun = source.spread <= LARGEST_SUN_VARIANCE && max_component(source.intensity) >= least;
        // Of a source that is too large, no rest near its border may pass for a small one.
        float reach = is_sun ? SUN_REACH : 3.0 * SUN_REACH;
        for (uint i = 0u; i < count; ++i) {
            if (!is_candidate(i) || !is_within(found.lights[i].direction, center, reach)) continue;
            if (is_sun) found.lights[i].intensity = vec3(0.0);
            else rejected[i / 32u] |= 1u << (i % 32u);
        }
        if (is_sun) found.suns[found.sun_count++] = source;
    }
    uint others = 0u;
    for (uint i = 0u; i < count; ++i) {
        SmallLight light = found.lights[i];
        if (max_component(light.intensity) > 0.0) found.lights[others++] = light;
    }
    found.count = others;
}

#endif
