// Punctual lights (KHR_lights_punctual): directional, point and spot.
#ifndef LIGHTING_PUNCTUAL_GLSL
#define LIGHTING_PUNCTUAL_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "user.glsl"

struct Illumination {
    vec3 l;                    // unit, towards the light
    vec3 irradiance;           // on a plane perpendicular to l; the surface receives NoL times it
};

// Light `i` as the user's hook leaves it for this point.
Light light_at(uint i, vec3 position_ws) {
    Light light = lights[i];
    user_light(light, i, position_ws);
    return light;
}

// Distances are clamped to 0.1 mm, since 1 / distance^2 diverges.
const float MIN_DISTANCE_SQUARED = 1e-8;

// max(min(1 - (d / range)^4, 1), 0) (KHR_lights_punctual): fades 1 / d^2 smoothly to 0 at `range`.
float range_window(float distance_squared, float inverse_range) {
    float ratio_squared = distance_squared * (inverse_range * inverse_range);
    return saturate(1.0 - ratio_squared * ratio_squared);
}

// A squared linear ramp in the cosine, from the outer to the inner cone angle (KHR_lights_punctual).
float spot_falloff(float cos_angle, float scale, float offset) {
    float ramp = saturate(cos_angle * scale + offset);
    return ramp * ramp;
}

// One formula without branches for all kinds. A directional light is a point at infinity in homogeneous coordinates, at
// distance 1; a light that is not a spot has the constant ramp 1; unlimited range is inverse_range = 0.
Illumination illuminate(Light light, vec3 position_ws) {
    vec3 to_light = light.position_ws.xyz - light.position_ws.w * position_ws;
    float distance_squared = max(dot(to_light, to_light), MIN_DISTANCE_SQUARED);
    vec3 l = to_light * inversesqrt(distance_squared);
    float falloff = range_window(distance_squared, light.inverse_range)
                  * spot_falloff(dot(-l, light.direction_ws), light.angle_scale, light.angle_offset);
    return Illumination(l, light.intensity * (falloff / distance_squared));
}

#endif
