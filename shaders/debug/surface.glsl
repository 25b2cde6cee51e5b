// Modes of the group Material: the surface as shaded, textures times factors.
#ifndef DEBUG_SURFACE_GLSL
#define DEBUG_SURFACE_GLSL

#include "interface.glsl"
#include "brdf/reflectance.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "material/material.glsl"

// True if the material has the extension, or the normal texture, that the mode shows.
bool has_shown_feature() {
    switch (MODE) {
        case MODE_NORMAL_TEXTURE: return has_texture(TEXTURE_NORMAL);
        case MODE_CLEARCOAT:
        case MODE_CLEARCOAT_ROUGHNESS:
        case MODE_CLEARCOAT_NORMAL: return has_feature(FEATURE_CLEARCOAT);
        case MODE_ANISOTROPY:
        case MODE_ANISOTROPY_DIRECTION: return has_feature(FEATURE_ANISOTROPY);
        case MODE_SHEEN_COLOR:
        case MODE_SHEEN_ROUGHNESS: return has_feature(FEATURE_SHEEN);
        case MODE_SPECULAR_FACTOR: return has_feature(FEATURE_SPECULAR);
        case MODE_SPECULAR_COLOR: return has_feature(FEATURE_SPECULAR | FEATURE_SPECULAR_GLOSSINESS);
        case MODE_IRIDESCENCE:
        case MODE_IRIDESCENCE_THICKNESS: return has_feature(FEATURE_IRIDESCENCE);
        case MODE_TRANSMISSION: return has_feature(FEATURE_TRANSMISSION);
        case MODE_THICKNESS:
        case MODE_ATTENUATION_COLOR: return has_feature(FEATURE_VOLUME);
        case MODE_DISPERSION: return has_feature(FEATURE_DISPERSION);
        case MODE_DIFFUSE_TRANSMISSION:
        case MODE_DIFFUSE_TRANSMISSION_COLOR: return has_feature(FEATURE_DIFFUSE_TRANSMISSION);
        default: return true;
    }
}

// F of the whole surface at normal incidence, as shading uses it: of the metal, by its n and k or its base color, and of
// the dielectric, with the thin film over both.
vec3 f0_of(Surface s) { return mix(dielectric_fresnel(s, 1.0), metal_fresnel(s, 1.0), s.metallic); }

bool debug_surface(Fragment f, Surface s, out vec3 value) {
    bool known = true;
    if (MODE == MODE_BASE_COLOR) value = s.base_color;
    else if (MODE == MODE_ALPHA) value = vec3(s.coverage);
    else if (MODE == MODE_METALLIC) value = vec3(s.metallic);
    else if (MODE == MODE_ROUGHNESS) value = vec3(s.roughness);
    else if (MODE == MODE_GGX_ALPHA) value = vec3(alpha_from_roughness(s.roughness));
    else if (MODE == MODE_OCCLUSION) value = vec3(s.occlusion);
    else if (MODE == MODE_EMISSIVE) value = s.emissive;
    else if (MODE == MODE_NORMAL_TEXTURE) value = normal_ts(f);
    else if (MODE == MODE_DIFFUSE_COLOR) value = s.base_color * (1.0 - s.metallic);
    else if (MODE == MODE_F0) value = f0_of(s);
    else if (MODE == MODE_F90) value = vec3(mix(s.f90, 1.0, s.metallic));
    else if (MODE == MODE_IOR) value = vec3(s.ior);
    else if (MODE == MODE_CLEARCOAT) value = vec3(s.clearcoat);
    else if (MODE == MODE_CLEARCOAT_ROUGHNESS) value = vec3(s.clearcoat_roughness);
    else if (MODE == MODE_CLEARCOAT_NORMAL) value = s.clearcoat_n;
    else if (MODE == MODE_ANISOTROPY) value = vec3(s.anisotropy);
    else if (MODE == MODE_ANISOTROPY_DIRECTION) value = s.t;
    else if (MODE == MODE_SHEEN_COLOR) value = s.sheen_color;
    else if (MODE == MODE_SHEEN_ROUGHNESS) value = vec3(s.sheen_roughness);
    else if (MODE == MODE_SPECULAR_FACTOR) value = vec3(s.f90);
    else if (MODE == MODE_SPECULAR_COLOR) value = s.f0;
    else if (MODE == MODE_IRIDESCENCE) value = vec3(s.iridescence);
    else if (MODE == MODE_IRIDESCENCE_THICKNESS) value = vec3(s.iridescence_nm * 1e-3);   // micrometers
    else if (MODE == MODE_TRANSMISSION) value = vec3(s.transmission);
    else if (MODE == MODE_THICKNESS) value = vec3(s.thickness);
    else if (MODE == MODE_ATTENUATION_COLOR) value = s.attenuation_color;
    else if (MODE == MODE_DISPERSION) value = vec3(s.dispersion);
    else if (MODE == MODE_DIFFUSE_TRANSMISSION) value = vec3(s.diffuse_transmission);
    else if (MODE == MODE_DIFFUSE_TRANSMISSION_COLOR) value = s.diffuse_transmission_color;
    else known = false;
    if (known) value = if_present(has_shown_feature(), value);
    return known;
}

#endif
