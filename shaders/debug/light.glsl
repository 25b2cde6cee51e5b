// Modes of the group Light, and clay: parts of the picture, in the picture's units.
//
// The shader shades only once. A mode selects what is shaded (surface_of_mode, lights_of_mode) and what of the result
// is shown.
#ifndef DEBUG_LIGHT_GLSL
#define DEBUG_LIGHT_GLSL

#include "interface.glsl"
#include "brdf/diffuse.glsl"
#include "common/color.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "debug/terms.glsl"
#include "lighting/environment.glsl"
#include "lighting/punctual.glsl"
#include "lighting/radiance.glsl"
#include "lighting/shade.glsl"
#include "material/material.glsl"

// Matte gray, without extensions.
Surface as_clay(Surface s) {
    s.base_color = vec3(0.5);
    s.metallic = 0.0;
    s.roughness = 1.0;
    s.emissive = vec3(0.0);
    s.ior = 1.5;
    s.f0 = vec3(0.04);
    s.f90 = 1.0;
    s.anisotropy = 0.0;
    s.clearcoat = 0.0;
    s.sheen_color = vec3(0.0);
    s.iridescence = 0.0;
    s.transmission = 0.0;
    s.diffuse_transmission = 0.0;
    return s;
}

// The surface that the mode shades. The picture is the blend of `dielectric` and `metal` by metallic.
Surface surface_of_mode(Surface s) {
    if (MODE == MODE_CLAY) return as_clay(s);
    if (MODE == MODE_DIELECTRIC) s.metallic = 0.0;
    if (MODE == MODE_METAL) s.metallic = 1.0;
    return s;
}

// Light `i` alone; empty if there are fewer lights.
LightRange one_light(uint i) { return LightRange(i, min(i + 1u, frame.light_count), false); }

LightRange lights_of_mode() {
    if (shows_terms()) return lights_of_terms();
    switch (MODE) {
        case MODE_LIGHT_1: return one_light(0u);
        case MODE_LIGHT_2: return one_light(1u);
        case MODE_LIGHT_3: return one_light(2u);
        case MODE_DIELECTRIC:
        case MODE_METAL:
        case MODE_DIRECT_DIFFUSE:
        case MODE_DIRECT_SPECULAR:
        case MODE_LAMBERT:
        case MODE_CLEARCOAT_LIGHT:
        case MODE_SHEEN_LIGHT:
        case MODE_TRANSMITTED_LIGHT:
        case MODE_MULTIPLE_SCATTERING:
        case MODE_AREA_LIGHT:
        case MODE_MEASURED:
        case MODE_MEASURED_SPLIT:
        case MODE_MEASURED_ERROR: return chosen_lights();
        default: return all_lights();
    }
}

// Diffuse reflection with every light at normal incidence: no cosine, no Fresnel. Rectangles are left out, since their
// irradiance has no single direction.
vec3 lambert_without_cosine(Surface s, LightRange range) {
    vec3 irradiance = vec3(0.0);
    for (uint i = range.first; i < range.end; ++i) {
        Light light = light_at(i, s.position_ws);
        if (light.kind != LIGHT_RECT) irradiance += illuminate(light, s.position_ws).irradiance;
    }
    return f_lambert(s.base_color) * irradiance;
}

// The picture without multiple scattering.
vec3 single_scattering(Surface s, vec3 v, Lit lit) {
    lit.punctual.all -= lit.punctual.multiple;
    lit.area.all -= lit.area.multiple;
    lit.ambient.all -= lit.ambient.multiple;
    return outgoing_radiance(s, v, lit);
}

bool debug_environment(Surface s, vec3 v, Lit lit, out vec3 value) {
    bool known = true;
    if (MODE == MODE_IBL_DIFFUSE) value = lit.ambient.diffuse;
    else if (MODE == MODE_IBL_SPECULAR) value = lit.ambient.specular;
    else if (MODE == MODE_IRRADIANCE) value = PI * irradiance_over_pi(s.n);
    else if (MODE == MODE_PREFILTERED) value = specular_radiance(s, v);
    else if (MODE == MODE_ENVIRONMENT) value = environment_radiance(reflect(-v, s.n), 0.0);
    else known = false;
    if (known) value = if_present(has_feature(FEATURE_ENVIRONMENT) && !has_feature(FEATURE_UNLIT), value);
    return known;
}

// `lit` and `radiance`: the surface of surface_of_mode under lights_of_mode.
bool debug_light(Surface s, vec3 v, Lit lit, vec3 radiance, out vec3 value) {
    LightRange range = lights_of_mode();
    bool is_lit = !has_feature(FEATURE_UNLIT);
    bool present = is_lit && !is_empty(range);
    bool has_picture = is_lit && frame.chosen_light <= frame.light_count;   // 0 selects all lights, if any
    bool has_area = present && has_feature(FEATURE_RECT_LIGHTS);
    bool has_transmission = has_feature(FEATURE_TRANSMISSION | FEATURE_DIFFUSE_TRANSMISSION);
    bool known = true;
    if (MODE == MODE_CLAY) value = radiance;
    else if (MODE == MODE_DIELECTRIC) value = if_present(has_picture, radiance);
    else if (MODE == MODE_METAL) value = if_present(has_picture, radiance);
    else if (MODE == MODE_DIRECT_DIFFUSE) value = if_present(present, lit.punctual.diffuse + lit.area.diffuse);
    else if (MODE == MODE_DIRECT_SPECULAR) value = if_present(present, lit.punctual.specular + lit.area.specular);
    else if (MODE == MODE_LAMBERT) value = if_present(present, lambert_without_cosine(s, range));
    else if (MODE == MODE_AMBIENT) value = if_present(is_lit, lit.ambient.all + lit.behind);
    else if (MODE == MODE_EMISSIVE_ONLY) value = lit.emitted;
    else if (MODE == MODE_LIGHT_1) value = if_present(present, lit.punctual.all + lit.area.all);
    else if (MODE == MODE_LIGHT_2) value = if_present(present, lit.punctual.all + lit.area.all);
    else if (MODE == MODE_LIGHT_3) value = if_present(present, lit.punctual.all + lit.area.all);
    else if (MODE == MODE_LUMINANCE) value = vec3(luminance(radiance));
    else if (MODE == MODE_DFG) value = if_present(is_lit, vec3(s.dfg.a, s.dfg.b, s.dfg.e));
    else if (MODE == MODE_CLEARCOAT_LIGHT) {
        vec3 light = lit.punctual.clearcoat + lit.area.clearcoat + lit.ambient.clearcoat;
        value = if_present(has_feature(FEATURE_CLEARCOAT), light);
    } else if (MODE == MODE_SHEEN_LIGHT) {
        value = if_present(has_feature(FEATURE_SHEEN), lit.punctual.sheen + lit.area.sheen + lit.ambient.sheen);
    } else if (MODE == MODE_TRANSMITTED_LIGHT) {
        vec3 light = lit.punctual.transmitted + lit.area.transmitted + lit.ambient.transmitted + lit.behind;
        value = if_present(has_transmission, light);
    } else if (MODE == MODE_MULTIPLE_SCATTERING) {
        value = if_present(is_lit, lit.punctual.multiple + lit.area.multiple + lit.ambient.multiple);
    } else if (MODE == MODE_AREA_LIGHT) value = if_present(has_area, lit.area.all);
    else if (MODE == MODE_SINGLE_SCATTERING) value = single_scattering(s, v, lit);
    else known = debug_environment(s, v, lit, value);
    return known;
}

#endif
