// Samples directions towards light: punctual lights, rectangles and the environment ("next event estimation").
#ifndef PATHS_LIGHTS_GLSL
#define PATHS_LIGHTS_GLSL

#include "interface.glsl"
#include "common/color.glsl"
#include "common/math.glsl"
#include "lighting/light_grid.glsl"
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

LightSample sample_of_rectangle(Light light, vec3 position_ws, vec2 u, float probability) {
    vec2 at = 2.0 * u - 1.0;
    vec3 to_light = light.position_ws.xyz + light.half_x_ws * at.x + light.half_y_ws * at.y - position_ws;
    float distance = length(to_light);
    float pdf = pdf_of_rectangle(light, to_light) * probability;
    return LightSample(to_light / distance, distance, light.intensity, pdf, false, false);
}

LightSample sample_of_point(Light light, vec3 position_ws, float probability) {
    Illumination lit = illuminate(light, position_ws);
    float distance = light.position_ws.w == 0.0 ? FAR_AWAY : length(light.position_ws.xyz - position_ws);
    return LightSample(lit.l, distance, lit.irradiance, probability, true, false);
}

// Of many lights, the rectangle is drawn with this probability. It is the last light.
const float RECTANGLE_SHARE = 0.25;
bool has_rectangle() { return (FEATURES & FEATURE_RECT_LIGHTS) != 0u; }
// Lights that are compared with each other to draw one of them.
const uint CANDIDATES = 16u;

// Of many lights, one of those that may reach the point. Candidates are taken from their lists at equal steps from a random place; one of
// them is drawn with a probability proportional to its illuminance without shadows (resampled importance sampling: Talbot, Cline and
// Egbert 2005). So a light's mean does not depend on how often it is drawn, and steps of 1 compare all lights.
LightSample sample_of_many(vec3 position_ws, vec3 u, float probability) {
    if (has_rectangle()) {
        if (u.z < RECTANGLE_SHARE) {
            Light light = light_at(frame.light_count - 1u, position_ws);
            return sample_of_rectangle(light, position_ws, u.xy, probability * RECTANGLE_SHARE);
        }
        u.z = (u.z - RECTANGLE_SHARE) / (1.0 - RECTANGLE_SHARE);
        probability *= 1.0 - RECTANGLE_SHARE;
    }
    uint cell = light_cell(position_ws);
    uint first = light_words[cell].word;
    // Each list has NO_LIGHT behind it.
    uint in_cell = light_words[cell + 1u].word - 1u - first;
    uint everywhere = light_grid.everywhere_count;
    uint count = in_cell + everywhere;
    float stride = max(float(count) / float(CANDIDATES), 1.0);
    float sum = 0.0;
    float chosen_weight = 0.0;
    uint chosen = NO_LIGHT;
    for (uint n = 0u; n < CANDIDATES; ++n) {
        float at = (float(n) + u.z) * stride;
        if (at >= float(count)) break;
        uint place = min(uint(at), count - 1u);
        uint i = light_words[place < in_cell ? first + place : light_grid.everywhere + (place - in_cell)].word;
        Light light = light_at(i, position_ws);
        if (light.kind == LIGHT_RECT) continue;
        float weight = luminance(illuminate(light, position_ws).irradiance);
        if (weight <= 0.0) continue;
        sum += weight;
        // The newest of all so far is kept with its share of their sum. The rest of the random number is used again.
        float share = weight / sum;
        if (u.x < share) {
            chosen = i;
            chosen_weight = weight;
            u.x /= share;
        } else {
            u.x = (u.x - share) / (1.0 - share);
        }
    }
    if (chosen == NO_LIGHT) return LightSample(vec3(0.0), 0.0, vec3(0.0), 0.0, false, false);
    return sample_of_point(light_at(chosen, position_ws), position_ws, probability * chosen_weight / (sum * stride));
}

LightSample sample_lamp(vec3 position_ws, vec3 u, float probability) {
    if (MANY_LIGHTS != 0u) return sample_of_many(position_ws, u, probability);
    uint index = min(uint(u.z * float(lamp_count())), lamp_count() - 1u);
    Light light = light_at(index, position_ws);
    probability /= float(lamp_count());
    if (light.kind == LIGHT_RECT) return sample_of_rectangle(light, position_ws, u.xy, probability);
    return sample_of_point(light, position_ws, probability);
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
    bool is_last = MANY_LIGHTS != 0u;
    float probability = (1.0 - sky_probability(true)) * (is_last ? RECTANGLE_SHARE : 1.0 / float(lamp_count()));
    for (uint i = is_last ? lamp_count() - 1u : 0u; i < lamp_count(); ++i) {
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
