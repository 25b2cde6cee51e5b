// Light of the environment that no model of a surface has a part in: unfiltered and diffuse, as baked by ibl/cube.comp and
// ibl/irradiance.comp, and its suns. Directions are in world space and need not be unit.
#ifndef LIGHTING_ENVIRONMENT_MAP_GLSL
#define LIGHTING_ENVIRONMENT_MAP_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "ibl/maps/levels.glsl"
#include "ibl/maps/octahedral.glsl"

layout(set = SET_FRAME, binding = BINDING_ENVIRONMENT) uniform samplerCube environment_cube;
layout(set = SET_FRAME, binding = BINDING_IRRADIANCE) uniform sampler2D irradiance_map;

// Rotates a direction from the world into the map. The map turns by an angle around +Y, counterclockwise from above:
// the camera sees its center column when it looks down -Z at 0 degrees, down -X at 90.
vec3 map_from_world(vec3 d) {
    float cosine = frame.environment_rotation.x;
    float sine = frame.environment_rotation.y;
    return vec3(cosine * d.x - sine * d.z, d.y, sine * d.x + cosine * d.z);
}

vec3 world_from_map(vec3 d) {
    float cosine = frame.environment_rotation.x;
    float sine = frame.environment_rotation.y;
    return vec3(cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x);
}

// Level `lod` of the unfiltered cube.
vec3 environment_radiance(vec3 direction, float lod) {
    return frame.environment_intensity * textureLod(environment_cube, map_from_world(direction), lod).rgb;
}

// Without an environment, the ambient light of the settings arrives from everywhere.
const bool HAS_ENVIRONMENT = (FEATURES & FEATURE_ENVIRONMENT) != 0u;

// Sun i of the map as a directional light. Irradiance and prefiltered levels leave out SUN_COUNT suns (ibl/small_lights/list.glsl). Its
// intensity includes that of the environment.
Light sun_at(uint i) {
    if (MANY_LIGHTS == 0u) return few_lights[frame.light_count + i];
    return lights[frame.light_count + i];
}

// E / pi of all but the suns.
vec3 irradiance_over_pi_without_suns(vec3 n) {
    if (!HAS_ENVIRONMENT) return frame.ambient;
    vec2 place = place_in_tile(octahedral_point(map_from_world(n)), irradiance_tile());
    return frame.environment_intensity * textureLod(irradiance_map, place / float(IRRADIANCE_SIDE), 0.0).rgb;
}

// E / pi: the radiance that a white Lambertian surface with the normal n reflects. n: unit if the map has suns.
vec3 irradiance_over_pi(vec3 n) {
    vec3 radiance = irradiance_over_pi_without_suns(n);
    [[unroll]] for (uint i = 0u; i < SUN_COUNT; ++i) {
        Light sun = sun_at(i);
        radiance += sun.intensity * (max(dot(n, sun.position_ws.xyz), 0.0) / PI);
    }
    return radiance;
}

#endif
