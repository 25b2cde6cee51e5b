// glTF's metallic-roughness material: textures times factors make a Surface.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"

// Where a material has no texture a neutral one is bound (white, or a flat normal): nothing here asks which exist.
layout(set = SET_MATERIAL, binding = BINDING_BASE_COLOR_TEXTURE) uniform sampler2D base_color_texture;
layout(set = SET_MATERIAL, binding = BINDING_METALLIC_ROUGHNESS_TEXTURE) uniform sampler2D metallic_roughness_texture;
layout(set = SET_MATERIAL, binding = BINDING_NORMAL_TEXTURE) uniform sampler2D normal_texture;
layout(set = SET_MATERIAL, binding = BINDING_OCCLUSION_TEXTURE) uniform sampler2D occlusion_texture;
layout(set = SET_MATERIAL, binding = BINDING_EMISSIVE_TEXTURE) uniform sampler2D emissive_texture;

bool has_texture(uint which) { return (material.texture_mask & 1u << which) != 0u; }

// Where texture `which` is read: its set of coordinates, moved by KHR_texture_transform.
vec2 texture_uv(Fragment f, uint which) {
    vec2 uv = (material.uv1_mask & 1u << which) != 0u ? f.uv1 : f.uv0;
    return material.uv_from_texture[which] * vec3(uv, 1.0);
}

// The normal texture, tangent space: 0..1 stands for -1..1, x and y are scaled (glTF 2.0, 3.9.3), and the length is
// made 1 again. A texel of no direction is flat.
vec3 normal_ts(Fragment f) {
    vec3 n = texture(normal_texture, texture_uv(f, TEXTURE_NORMAL)).xyz * 2.0 - 1.0;
    return safe_normalize(n * vec3(material.normal_scale, material.normal_scale, 1.0), vec3(0.0, 0.0, 1.0));
}

// glTF 2.0, 3.7.2.1. Not normalized: MikkTSpace bakers use the interpolated vectors as they are (Mikkelsen 2008).
vec3 bitangent_ws(Fragment f) {
    return cross(f.normal_ws, f.tangent_ws.xyz) * (f.tangent_ws.w < 0.0 ? -1.0 : 1.0);
}

// A direction of the front seen from behind is the opposite one. Mirrored meshes have their winding turned by the
// renderer, so gl_FrontFacing is right for them too.
vec3 towards_viewer(vec3 direction_ws) { return gl_FrontFacing ? direction_ws : -direction_ws; }

// The mesh's normal, interpolated. Where normals are zero or cancel out, the surface faces the eye.
vec3 geometric_normal(Fragment f, vec3 v) { return safe_normalize(towards_viewer(f.normal_ws), v); }

// The normal that is shaded. A zero tangent leaves the geometric normal, since its bitangent is zero too.
vec3 shading_normal(Fragment f, vec3 v) {
    vec3 geometric = geometric_normal(f, v);
    if ((FEATURES & FEATURE_NORMAL_TEXTURE) == 0u) return geometric;
    vec3 n = normal_ts(f);
    vec3 n_ws = f.tangent_ws.xyz * n.x + bitangent_ws(f) * n.y + f.normal_ws * n.z;
    return safe_normalize(towards_viewer(n_ws), geometric);
}

// `v`: unit, towards the eye, world space.
Surface make_surface(Fragment f, vec3 v) {
    vec4 base_color = texture(base_color_texture, texture_uv(f, TEXTURE_BASE_COLOR));
    vec4 metallic_roughness = texture(metallic_roughness_texture, texture_uv(f, TEXTURE_METALLIC_ROUGHNESS));
    float occlusion = texture(occlusion_texture, texture_uv(f, TEXTURE_OCCLUSION)).r;
    vec3 emissive = texture(emissive_texture, texture_uv(f, TEXTURE_EMISSIVE)).rgb;
    base_color *= material.base_color_factor * f.color;

    Surface s;
    s.position_ws = f.position_ws;
    s.n = shading_normal(f, v);
    s.base_color = base_color.rgb;
    s.coverage = ALPHA_MODE == ALPHA_OPAQUE ? 1.0 : base_color.a;
    s.metallic = saturate(metallic_roughness.b * material.metallic_factor);
    s.roughness = saturate(metallic_roughness.g * material.roughness_factor);
    s.occlusion = mix(1.0, occlusion, material.occlusion_strength);
    s.emissive = emissive * material.emissive_factor;
    return s;
}

#endif
