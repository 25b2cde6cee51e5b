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

// max(min(1 - (d / range)^4, 1), 0) (KHR_lights_punctual): brings 1 / d^2 smoothly to 0 at `range`.
float range_window(float distance_squared, float inverse_range) {
    float ratio_squared = distance_squared * (inverse_range * inverse_range);
    return saturate(1.0 - ratio_squared * ratio_squared);
}

// Square of a ramp in the cosine, from the outer cone to the inner one (KHR_lights_punctual).
float spot_falloff(float cos_angle, float scale, float offset) {
    float ramp = saturate(cos_angle * scale + offset);
    return ramp * ramp;
}

// One formula for all kinds: a directional light is a point at infinity, in homogeneous coordinates, seen from a
// distance of 1; a light that is no spot has a ramp that is 1 everywhere; one without end has the range 1 / 0.
Illumination illuminate(Light light, vec3 position_ws) {
    vec3 to_light = light.position_ws.xyz - light.position_ws.w * position_ws;
    float distance_squared = max(dot(to_light, to_light), MIN_DISTANCE_SQUARED);
    vec3 l = to_light * inversesqrt(distance_squared);
    float falloff = range_window(distance_squared, light.inverse_range)
                  * spot_falloff(dot(-l, light.direction_ws), light.angle_scale, light.angle_offset);
    return Illumination(l, light.intensity * (falloff / distance_squared));
}

#endif
