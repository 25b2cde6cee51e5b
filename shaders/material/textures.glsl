// The textures of a material and their texture coordinates.
#ifndef MATERIAL_TEXTURES_GLSL
#define MATERIAL_TEXTURES_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"

// A slot without a texture has a neutral one bound (white, or a flat normal), so shaders rarely need has_texture.
layout(set = SET_MATERIAL, binding = BINDING_BASE_COLOR_TEXTURE) uniform sampler2D base_color_texture;
layout(set = SET_MATERIAL, binding = BINDING_METALLIC_ROUGHNESS_TEXTURE) uniform sampler2D metallic_roughness_texture;
layout(set = SET_MATERIAL, binding = BINDING_NORMAL_TEXTURE) uniform sampler2D normal_texture;
layout(set = SET_MATERIAL, binding = BINDING_OCCLUSION_TEXTURE) uniform sampler2D occlusion_texture;
layout(set = SET_MATERIAL, binding = BINDING_EMISSIVE_TEXTURE) uniform sampler2D emissive_texture;
layout(set = SET_MATERIAL, binding = BINDING_CLEARCOAT_TEXTURE) uniform sampler2D clearcoat_texture;
layout(set = SET_MATERIAL, binding = BINDING_CLEARCOAT_ROUGHNESS_TEXTURE) uniform sampler2D clearcoat_roughness_texture;
layout(set = SET_MATERIAL, binding = BINDING_CLEARCOAT_NORMAL_TEXTURE) uniform sampler2D clearcoat_normal_texture;
layout(set = SET_MATERIAL, binding = BINDING_ANISOTROPY_TEXTURE) uniform sampler2D anisotropy_texture;
layout(set = SET_MATERIAL, binding = BINDING_SHEEN_COLOR_TEXTURE) uniform sampler2D sheen_color_texture;
layout(set = SET_MATERIAL, binding = BINDING_SHEEN_ROUGHNESS_TEXTURE) uniform sampler2D sheen_roughness_texture;
layout(set = SET_MATERIAL, binding = BINDING_SPECULAR_TEXTURE) uniform sampler2D specular_texture;
layout(set = SET_MATERIAL, binding = BINDING_SPECULAR_COLOR_TEXTURE) uniform sampler2D specular_color_texture;
layout(set = SET_MATERIAL, binding = BINDING_IRIDESCENCE_TEXTURE) uniform sampler2D iridescence_texture;
layout(set = SET_MATERIAL, binding = BINDING_IRIDESCENCE_THICKNESS_TEXTURE)
    uniform sampler2D iridescence_thickness_texture;
layout(set = SET_MATERIAL, binding = BINDING_TRANSMISSION_TEXTURE) uniform sampler2D transmission_texture;
layout(set = SET_MATERIAL, binding = BINDING_THICKNESS_TEXTURE) uniform sampler2D thickness_texture;
layout(set = SET_MATERIAL, binding = BINDING_DIFFUSE_TRANSMISSION_TEXTURE)
    uniform sampler2D diffuse_transmission_texture;
layout(set = SET_MATERIAL, binding = BINDING_DIFFUSE_TRANSMISSION_COLOR_TEXTURE)
    uniform sampler2D diffuse_transmission_color_texture;

bool has_texture(uint which) { return (material.texture_mask & 1u << which) != 0u; }

// Coordinates of texture `which`: its TEXCOORD set, transformed by KHR_texture_transform.
vec2 texture_uv(Fragment f, uint which) {
    if ((FEATURES & FEATURE_TEXTURE_COORDINATES) == 0u) return f.uv0;
    vec2 uv = (material.uv1_mask & 1u << which) != 0u ? f.uv1 : f.uv0;
    return material.uv_from_texture[which] * vec3(uv, 1.0);
}

#endif
