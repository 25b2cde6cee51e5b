// Samples directions towards light: punctual lights, rectangles and the environment ("next event estimation").
#ifndef PATHS_LIGHTS_GLSL
#define PATHS_LIGHTS_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "lighting/punctual.glsl"
#include "paths/environment_sampling.glsl"
#include "paths/lobe_sampling.glsl"
#include "paths/scene.glsl"

// Light from a drawn direction.
struct LightSample {
    vec3 l;                    // unit, world space
    float distance;            // meters
    vec3 radiance;             // of a punctual light: its irradiance, whose solid angle is counted in as 1
    float pdf;                 // 1/sr; of a punctual light: its probability. 0: contributes nothing
    bool is_point;             // a punctual light, which no other way of sampling can hit
    bool is_sky;
};

const float FAR_AWAY = 1e30;

uint lamp_count() { return LIGHT_COUNT != 0u ? LIGHT_COUNT : frame.light_count; }

// Probability of sampling the environment instead of a light.
float sky_probability(bool with_lamps) {
    if (!environment_has_light()) return 0.0;
    return with_lamps && lamp_count() > 0u ? 0.5 : 1.0;
}

// Density per solid angle of a uniform point of a rectangle, seen at `to_light`. 0 from behind.
float pdf_of_rectangle(Light light, vec3 to_light) {
    float distance_squared = dot(to_light, to_light);
    float cosine = dot(-to_light, light.direction_ws) * inversesqrt(distance_squared);
    float area = 4.0 * length(cross(light.half_x_ws, light.half_y_ws));
    return cosine > 0.0 ? distance_squared / (cosine * area) : 0.0;
}

LightSample sample_lamp(vec3 position_ws, vec3 u, float probability) {
    uint index = min(uint(u.z * float(lamp_count())), lamp_count() - 1u);
    Light light = light_at(index, position_ws);
    probability /= float(lamp_count());
    if (light.kind == LIGHT_RECT) {
        vec2 at = 2.0 * u.xy - 1.0;
        vec3 to_light = light.position_ws.xyz + light.half_x_ws * at.x + light.half_y_ws * at.y - position_ws;
        float distance = length(to_light);
        float pdf = pdf_of_rectangle(light, to_light) * probability;
        return LightSample(to_light / distance, distance, light.intensity, pdf, false, false);
    }
    Illumination lit = illuminate(light, position_ws);
    float distance = light.position_ws.w == 0.0 ? FAR_AWAY : length(light.position_ws.xyz - position_ws);
    return LightSample(lit.l, distance, lit.irradiance, probability, true, false);
}

// Without `with_lamps`, only the environment counts.
LightSample sample_light(vec3 position_ws, vec3 u, bool with_lamps) {
    float sky = sky_probability(with_lamps);
    if (u.z < sky) {
        DirectionSample drawn = sample_environment(vec3(u.xy, u.z / sky));
        return LightSample(drawn.l, FAR_AWAY, sky_radiance(drawn.l), drawn.pdf * sky, false, true);
    }
    if (!with_lamps || lamp_count() == 0u) return LightSample(vec3(0.0), 0.0, vec3(0.0), 0.0, false, false);
    return sample_lamp(position_ws, vec3(u.xy, (u.z - sky) / (1.0 - sky)), 1.0 - sky);
}

// The balance heuristic (Veach 1997, eq. 9.8): the share of a direction that was drawn with density `own` and could have
// been drawn with density `other`.
float balance(float own, float other) { return own / (own + other); }

// Light of the rectangles closer than `farthest` along a ray whose direction was drawn of a lobe with density `pdf`.
// They are not part of the model and hide nothing.
vec3 rectangles_along(Ray ray, float farthest, float pdf) {
    vec3 sum = vec3(0.0);
    if ((FEATURES & FEATURE_RECT_LIGHTS) == 0u) return sum;
    float probability = (1.0 - sky_probability(true)) / float(lamp_count());
    for (uint i = 0u; i < lamp_count(); ++i) {
        Light light = light_at(i, ray.origin_ws);
        float facing = dot(ray.direction_ws, light.direction_ws);
        if (light.kind != LIGHT_RECT || facing >= 0.0) continue;
        float distance = dot(light.position_ws.xyz - ray.origin_ws, light.direction_ws) / facing;
        vec3 from_center = ray.origin_ws + ray.direction_ws * distance - light.position_ws.xyz;
        float x = dot(from_center, light.half_x_ws) / dot(light.half_x_ws, light.half_x_ws);
        float y = dot(from_center, light.half_y_ws) / dot(light.half_y_ws, light.half_y_ws);
        if (distance <= 0.0 || distance >= farthest || abs(x) > 1.0 || abs(y) > 1.0) continue;
        sum += light.intensity * balance(pdf, probability * pdf_of_rectangle(light, ray.direction_ws * distance));
    }
    return sum;
}

#endif
