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

// Light `i`, or sun i - frame.light_count. A software device reads a uniform block once for a group of pixels, a buffer once for each pixel
// and member, so it reads what a light of this kind has alone. A point light has no direction here.
Light given_light(uint i) {
    if (MANY_LIGHTS == 0u) return few_lights[i];
    vec4 position_ws = lights[i].position_ws;
    uint kind = lights[i].kind;
    Light light = Light(position_ws, -position_ws.xyz, kind, lights[i].intensity, lights[i].inverse_range, 0.0, 1.0,
                        vec3(0.0), vec3(0.0));
    bool is_rectangle = (FEATURES & FEATURE_RECT_LIGHTS) != 0u && kind == LIGHT_RECT;
    if (kind == LIGHT_SPOT || is_rectangle) {
        light.direction_ws = lights[i].direction_ws;
        light.angle_scale = lights[i].angle_scale;
        light.angle_offset = lights[i].angle_offset;
    }
    if (is_rectangle) {
        light.half_x_ws = lights[i].half_x_ws;
        light.half_y_ws = lights[i].half_y_ws;
    }
    return light;
}

// Light `i` as the user's hook leaves it for this point.
Light light_at(uint i, vec3 position_ws) {
    Light light = given_light(i);
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
