// Modes of the group Light, and clay: parts of the picture, in the picture's own units.
#ifndef DEBUG_LIGHT_GLSL
#define DEBUG_LIGHT_GLSL

#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "common/color.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"

// Diffuse reflection as if every light stood above the point: no cosine, no Fresnel.
vec3 lambert_without_cosine(Surface s, LightRange range) {
    vec3 irradiance = vec3(0.0);
    for (uint i = range.first; i < range.end; ++i) irradiance += illuminate(lights[i], s.position_ws).irradiance;
    return f_lambert(s.base_color) * irradiance;
}

// Light number `i` alone, with all that is reflected of it and of ambient light.
vec3 radiance_of_light(Surface s, vec3 v, uint i) {
    bool present = i < frame.light_count && (FEATURES & FEATURE_UNLIT) == 0u;
    LightRange range = LightRange(i, present ? i + 1u : i);
    return if_present(present, reflected_radiance(shade(s, v, range)));
}

// The picture, were the material all dielectric (metallic 0) or all metal (1). The picture is their mix.
vec3 radiance_with_metallic(Surface s, vec3 v, float metallic) {
    s.metallic = metallic;
    return outgoing_radiance(s, v, chosen_lights());
}

Surface as_clay(Surface s) {
    s.base_color = vec3(0.5);
    s.metallic = 0.0;
    s.roughness = 1.0;
    s.emissive = vec3(0.0);
    return s;
}

bool debug_light(Surface s, vec3 v, out vec3 value) {
    LightRange range = chosen_lights();
    bool present = !is_empty(range);
    bool is_lit = (FEATURES & FEATURE_UNLIT) == 0u;
    bool has_picture = is_lit && frame.chosen_light <= frame.light_count;   // of all lights there may be none
    bool known = true;
    if (MODE == MODE_CLAY) value = outgoing_radiance(as_clay(s), v, all_lights());
    else if (MODE == MODE_DIELECTRIC) value = if_present(has_picture, radiance_with_metallic(s, v, 0.0));
    else if (MODE == MODE_METAL) value = if_present(has_picture, radiance_with_metallic(s, v, 1.0));
    else if (MODE == MODE_DIRECT_DIFFUSE) value = if_present(present, shade(s, v, range).diffuse);
    else if (MODE == MODE_DIRECT_SPECULAR) value = if_present(present, shade(s, v, range).specular);
    else if (MODE == MODE_LAMBERT) value = if_present(present, lambert_without_cosine(s, range));
    else if (MODE == MODE_AMBIENT) value = if_present(is_lit, ambient_radiance(s));
    else if (MODE == MODE_EMISSIVE_ONLY) value = s.emissive;
    else if (MODE == MODE_LIGHT_1) value = radiance_of_light(s, v, 0u);
    else if (MODE == MODE_LIGHT_2) value = radiance_of_light(s, v, 1u);
    else if (MODE == MODE_LIGHT_3) value = radiance_of_light(s, v, 2u);
    else if (MODE == MODE_LUMINANCE) value = vec3(luminance(outgoing_radiance(s, v, all_lights())));
    else known = false;
    return known;
}

#endif
