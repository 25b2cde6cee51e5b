// Modes of the group Material: the surface as it is shaded, textures times factors.
#ifndef DEBUG_SURFACE_GLSL
#define DEBUG_SURFACE_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "material.glsl"

bool debug_surface(Fragment f, Surface s, out vec3 value) {
    bool known = true;
    if (MODE == MODE_BASE_COLOR) value = s.base_color;
    else if (MODE == MODE_ALPHA) value = vec3(s.coverage);
    else if (MODE == MODE_METALLIC) value = vec3(s.metallic);
    else if (MODE == MODE_ROUGHNESS) value = vec3(s.roughness);
    else if (MODE == MODE_GGX_ALPHA) value = vec3(alpha_from_roughness(s.roughness));
    else if (MODE == MODE_OCCLUSION) value = vec3(s.occlusion);
    else if (MODE == MODE_EMISSIVE) value = s.emissive;
    else if (MODE == MODE_NORMAL_TEXTURE) value = if_present(has_texture(TEXTURE_NORMAL), normal_ts(f));
    else if (MODE == MODE_DIFFUSE_COLOR) value = s.base_color * (1.0 - s.metallic);
    else if (MODE == MODE_F0) value = mix(vec3(DIELECTRIC_F0), s.base_color, s.metallic);
    else if (MODE == MODE_F90) value = vec3(1.0);
    else known = false;
    return known;
}

#endif
