// Looks up light from the environment, as baked by ibl/*.comp: unfiltered, diffuse, and prefiltered for rough surfaces.
// Directions are in world space and need not be unit.
#ifndef LIGHTING_ENVIRONMENT_GLSL
#define LIGHTING_ENVIRONMENT_GLSL

#include "interface.glsl"
#include "ibl/levels.glsl"

layout(set = SET_FRAME, binding = BINDING_ENVIRONMENT) uniform samplerCube environment_cube;
layout(set = SET_FRAME, binding = BINDING_PREFILTERED) uniform samplerCube prefiltered_even;
layout(set = SET_FRAME, binding = BINDING_PREFILTERED_ODD) uniform samplerCube prefiltered_odd;
layout(set = SET_FRAME, binding = BINDING_PREFILTERED_SHEEN) uniform samplerCube prefiltered_sheen_cube;
layout(set = SET_FRAME, binding = BINDING_IRRADIANCE) uniform samplerCube irradiance_cube;

// Rotates a direction from the world into the map. The map turns by an angle around +Y, counterclockwise from above:
// the camera sees its center column when it looks down -Z at 0 degrees, down -X at 90.
vec3 map_from_world(vec3 d) {
    float c = frame.environment_rotation.x;
    float s = frame.environment_rotation.y;
    return vec3(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}

vec3 world_from_map(vec3 d) {
    float c = frame.environment_rotation.x;
    float s = frame.environment_rotation.y;
    return vec3(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
}

// Level `lod` of the unfiltered cube.
vec3 environment_radiance(vec3 direction, float lod) {
    return frame.environment_intensity * textureLod(environment_cube, map_from_world(direction), lod).rgb;
}

// Without an environment, the ambient light of the settings arrives from everywhere.
const bool HAS_ENVIRONMENT = (FEATURES & FEATURE_ENVIRONMENT) != 0u;

// E / pi: the radiance that a white Lambertian surface with the normal n reflects.
vec3 irradiance_over_pi(vec3 n) {
    if (!HAS_ENVIRONMENT) return frame.ambient;
    return frame.environment_intensity * textureLod(irradiance_cube, map_from_world(n), 0.0).rgb;
}

// The mean of radiance around r, weighted by the lobe of the selected models for v = n: the first factor of the split sum
// (Karis 2013). The levels are in two cube maps (ibl/levels.glsl), so a lookup mixes an even with an odd level.
vec3 prefiltered_level(vec3 r, float level) {
    vec3 direction = map_from_world(r);
    float odd = min(floor(0.5 * level), 0.5 * SPECULAR_LEVELS - 1.0);
    vec3 even_radiance = textureLod(prefiltered_even, direction, floor(0.5 * level + 0.5)).rgb;
    vec3 odd_radiance = textureLod(prefiltered_odd, direction, odd).rgb;
    return frame.environment_intensity * mix(even_radiance, odd_radiance, 1.0 - abs(level - 2.0 * odd - 1.0));
}

vec3 prefiltered_radiance(vec3 r, float roughness) {
    return HAS_ENVIRONMENT ? prefiltered_level(r, specular_level(roughness)) : frame.ambient;
}

// The same with the sheen distribution.
vec3 prefiltered_sheen(vec3 r, float roughness) {
    if (!HAS_ENVIRONMENT) return frame.ambient;
    float lod = level_of_roughness(roughness, textureQueryLevels(prefiltered_sheen_cube));
    return frame.environment_intensity * textureLod(prefiltered_sheen_cube, map_from_world(r), lod).rgb;
}

// The background. environment_blur acts as a roughness. Below level 1 this blends with the unfiltered cube, which has
// more texels than level 0 of the prefiltered one.
vec3 background_radiance(vec3 direction) {
    float level = specular_level(frame.environment_blur);
    if (level <= 0.0) return environment_radiance(direction, 0.0);
    if (level >= 1.0) return prefiltered_level(direction, level);
    vec3 blurred = textureLod(prefiltered_odd, map_from_world(direction), 0.0).rgb * frame.environment_intensity;
    return mix(environment_radiance(direction, 0.0), blurred, level);
}

#endif
