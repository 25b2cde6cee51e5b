// Lights without a size (KHR_lights_punctual): directional, point and spot.
#ifndef LIGHTING_PUNCTUAL_GLSL
#define LIGHTING_PUNCTUAL_GLSL

#include "interface.glsl"
#include "common/math.glsl"

struct Illumination {
    vec3 l;                    // unit, towards the light
    vec3 irradiance;           // on a plane that faces the light; times NoL on the surface
};

// A surface closer than 0.1 mm is lit as from there: 1 / distance^2 has no limit at 0.
const float MIN_DISTANCE_SQUARED = 1e-8;

// max(min(1 - (d / range)^4, 1), 0) (KHR_lights_punctual): brings 1 / d^2 smoothly to 0 at `range`. Range 0 is endless.
float range_window(float distance_squared, float range) {
    if (range <= 0.0) return 1.0;
    float ratio_squared = distance_squared / (range * range);
    return saturate(1.0 - ratio_squared * ratio_squared);
}

// Square of a ramp in the cosine, from the outer cone to the inner one (KHR_lights_punctual). Where both cones are
// the same the ramp is a step; 1e-3, from the extension as well, keeps it divisible.
float spot_falloff(float cos_angle, float cos_inner, float cos_outer) {
    float ramp = saturate((cos_angle - cos_outer) / max(cos_inner - cos_outer, 1e-3));
    return ramp * ramp;
}

Illumination illuminate(Light light, vec3 position_ws) {
    if (light.kind == LIGHT_DIRECTIONAL) return Illumination(-light.direction_ws, light.intensity);

    vec3 to_light = light.position_ws - position_ws;
    float distance_squared = max(dot(to_light, to_light), MIN_DISTANCE_SQUARED);
    vec3 l = to_light * inversesqrt(distance_squared);
    vec3 irradiance = light.intensity * (range_window(distance_squared, light.range) / distance_squared);
    if (light.kind == LIGHT_SPOT) {
        irradiance *= spot_falloff(dot(-l, light.direction_ws), light.cos_inner, light.cos_outer);
    }
    return Illumination(l, irradiance);
}

#endif
