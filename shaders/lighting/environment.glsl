// Looks up light from the environment, prefiltered for rough surfaces as baked by ibl/*.comp. environment_map.glsl has it unfiltered.
// Directions are in world space and need not be unit.
#ifndef LIGHTING_ENVIRONMENT_GLSL
#define LIGHTING_ENVIRONMENT_GLSL

#include "interface.glsl"
#include "brdf/energy/dfg_table.glsl"
#include "ibl/maps/levels.glsl"
#include "ibl/maps/octahedral.glsl"
#include "ibl/sampling/lobe_weight.glsl"
#include "lighting/environment_map.glsl"

layout(set = SET_FRAME, binding = BINDING_PREFILTERED) uniform sampler2D prefiltered_levels;
layout(set = SET_FRAME, binding = BINDING_PREFILTERED_SHEEN) uniform samplerCube prefiltered_sheen_cube;

// The prefiltered radiance of one level, without the environment's intensity.
vec3 prefiltered_at(vec2 p, Tile tile) {
    vec2 place = place_in_tile(p, tile);
    return textureLod(prefiltered_levels, place / vec2(SPECULAR_WIDTH, SPECULAR_HEIGHT), 0.0).rgb;
}

// The suns' part of that mean, exact for every roughness: intensity K over the integral of K, where K is the lobe's weight
// (ibl/sampling/lobe_weight.glsl). The levels from 1 on do not have the suns (ibl/small_lights/list.glsl).
vec3 sun_radiance(vec3 r, float roughness) {
    vec3 d = normalize(r);
    vec3 sum = vec3(0.0);
    [[unroll]] for (uint i = 0u; i < SUN_COUNT; ++i) {
        Light sun = sun_at(i);
        vec3 chord = sun.position_ws.xyz - d;
        sum += sun.intensity * lobe_weight_of_light(0.25 * dot(chord, chord), lobe_alpha(roughness), frame.sun_variance[i]);
    }
    return sum / max(facing_albedo(roughness), 1e-3);   // 1e-3: a D of 0
}

// The prefiltered radiance at a level, interpolated between an even and an odd one (ibl/maps/levels.glsl), without suns and
// without the environment's intensity. d: of any length, in the map.
vec3 prefiltered_sky(vec3 d, float level) {
    vec2 p = octahedral_point(d);
    float odd_row = min(floor(0.5 * level), float(SPECULAR_LEVELS / 2u - 1u)) + 1.0;
    float even_row = floor(0.5 * level + 0.5);   // the same, or the one above
    float scale = scale_of_row(odd_row);
    vec3 odd = prefiltered_at(p, odd_tile(scale));
    vec3 even = prefiltered_at(p, even_tile(even_row, even_row < odd_row ? scale / ROW_RATIO : scale));
    return between_levels(even, odd, 1.0 - abs(level - (2.0 * odd_row - 1.0)));
}

// The mean of radiance around r, weighted by the lobe of the selected models for v = n: the first factor of the split sum
// (Karis 2013), without suns. But level 0 shows the suns themselves.
vec3 prefiltered_without_suns(vec3 r, float roughness) {
    if (!HAS_ENVIRONMENT) return frame.ambient;
    vec3 sky = prefiltered_sky(map_from_world(r), specular_level(roughness));
    return frame.environment_intensity * sky;
}

// The part of the suns that prefiltered_without_suns leaves out at this roughness: 0 for a mirror, whose level shows them, 1 from
// level 1 on.
float missing_suns(float roughness) { return min(specular_level(roughness), 1.0); }

// The same with the suns, as lobes for v = n.
vec3 prefiltered_radiance(vec3 r, float roughness) {
    vec3 radiance = prefiltered_without_suns(r, roughness);
    if (SUN_COUNT != 0u) radiance += missing_suns(roughness) * sun_radiance(r, roughness);
    return radiance;
}

// The same with the sheen distribution.
vec3 prefiltered_sheen(vec3 r, float roughness) {
    if (!HAS_ENVIRONMENT) return frame.ambient;
    float lod = level_of_roughness(roughness, textureQueryLevels(prefiltered_sheen_cube));
    return frame.environment_intensity * textureLod(prefiltered_sheen_cube, map_from_world(r), lod).rgb;
}

// The background. environment_blur acts as a roughness. Below level 1 this blends with the unfiltered cube, which has
// more texels than level 0 of the prefiltered levels.
vec3 background_radiance(vec3 direction) {
    float level = specular_level(frame.environment_blur);
    if (level >= 1.0) return prefiltered_radiance(direction, frame.environment_blur);
    vec3 sharp = environment_radiance(direction, 0.0);
    if (level <= 0.0) return sharp;
    return mix(sharp, prefiltered_radiance(direction, roughness_of_specular_level(1.0)), level);
}

#endif
