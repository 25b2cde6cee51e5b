// Builds a Surface from a glTF material: textures times factors. An extension's textures are read only if its FEATURES
// bit is set.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL

#include "interface.glsl"
#include "brdf/fresnel.glsl"
#include "brdf/surface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/textures.glsl"

// For debug modes. Code that must vanish where the bit is not set writes the comparison out instead (shaders/README.md,
// "Features").
bool has_feature(uint feature) { return (FEATURES & feature) != 0u; }

// Decodes a texel of a normal texture into tangent space: 0..1 maps to -1..1, then x and y are scaled (glTF 2.0,
// 3.9.3). The result is not normalized: mapped_normal normalizes it in world space.
vec3 normal_texel(vec4 texel, float scale) { return (texel.xyz * 2.0 - 1.0) * vec3(scale, scale, 1.0); }

// The normal from the normal texture: tangent space, unit. A texel that decodes to zero counts as flat.
vec3 normal_ts(Fragment f) {
    vec4 texel = texture(normal_texture, texture_uv(f, TEXTURE_NORMAL));
    return safe_normalize(normal_texel(texel, material.normal_scale), vec3(0.0, 0.0, 1.0));
}

// glTF 2.0, 3.7.2.1. Not normalized, since MikkTSpace bakers use the interpolated vectors as they are (Mikkelsen 2008).
vec3 bitangent_ws(Fragment f) {
    return cross(f.normal_ws, f.tangent_ws.xyz) * (f.tangent_ws.w < 0.0 ? -1.0 : 1.0);
}

// Flips a direction of the front face for a back face. The renderer reverses the winding of mirrored meshes, so
// gl_FrontFacing is right for them too.
vec3 towards_viewer(vec3 direction_ws) { return gl_FrontFacing ? direction_ws : -direction_ws; }

// The interpolated vertex normal, unit, on the viewer's side. Falls back to v where normals are zero or cancel out.
vec3 geometric_normal(Fragment f, vec3 v) { return safe_normalize(towards_viewer(f.normal_ws), v); }

// The triangle's normal, on the viewer's side. Falls back to v where the triangle is edge-on and derivatives vanish.
vec3 facet_normal(Fragment f, vec3 v) {
    vec3 n = safe_normalize(cross(dFdx(f.position_ws), dFdy(f.position_ws)), v);
    return dot(n, v) < 0.0 ? -n : n;
}

// Transforms a decoded normal texel to world space. Where the result is zero (a texel that decodes to zero, say), this
// returns the geometric normal. A zero tangent makes the bitangent zero too, so the geometric normal is all that is
// left. The fallback is selected before normalizing, so that only one vector is normalized.
vec3 mapped_normal(Fragment f, vec3 v, vec3 texel) {
    vec3 n_ws = f.tangent_ws.xyz * texel.x + bitangent_ws(f) * texel.y + f.normal_ws * texel.z;
    return safe_normalize(towards_viewer(dot(n_ws, n_ws) > 1e-20 ? n_ws : f.normal_ws), v);
}

// The shading normal: unit, world space.
vec3 shading_normal(Fragment f, vec3 v) {
    if ((FEATURES & FEATURE_NORMAL_TEXTURE) == 0u) return geometric_normal(f, v);
    vec4 texel = texture(normal_texture, texture_uv(f, TEXTURE_NORMAL));
    return mapped_normal(f, v, normal_texel(texel, material.normal_scale));
}

// The clear coat has its own normal texture and ignores the base's (KHR_materials_clearcoat).
vec3 clearcoat_normal(Fragment f, vec3 v) {
    if ((FEATURES & FEATURE_CLEARCOAT_NORMAL) == 0u) return geometric_normal(f, v);
    vec4 texel = texture(clearcoat_normal_texture, texture_uv(f, TEXTURE_CLEARCOAT_NORMAL));
    return mapped_normal(f, v, normal_texel(texel, material.clearcoat_normal_scale));
}

// KHR_materials_anisotropy: rotates the texture's direction by the material's rotation and projects it into the tangent
// plane of the shading normal. Without a texture the direction is the tangent.
void read_anisotropy(Fragment f, inout Surface s) {
    vec2 direction = vec2(1.0, 0.0);
    s.anisotropy = material.anisotropy_strength;
    if (has_texture(TEXTURE_ANISOTROPY)) {
        vec3 texel = texture(anisotropy_texture, texture_uv(f, TEXTURE_ANISOTROPY)).xyz;
        direction = texel.xy * 2.0 - 1.0;
        s.anisotropy *= texel.z;
    }
    vec2 turn = material.anisotropy_rotation;
    direction = mat2(turn.x, turn.y, -turn.y, turn.x) * direction;
    vec3 t = f.tangent_ws.xyz * direction.x + bitangent_ws(f) * direction.y;
    s.t = safe_normalize(t - s.n * dot(s.n, t), any_perpendicular(s.n));
    s.b = cross(s.n, s.t);
}

// KHR_materials_pbrSpecularGlossiness: the base color slot holds the diffuse color, the metallic-roughness slot holds
// F0 (RGB) and glossiness (A). The diffuse color is scaled by 1 - max(F0). Metals have a black diffuse color there, so
// metallic stays 0.
void read_specular_glossiness(vec4 specular_glossiness, inout Surface s) {
    s.f0 = saturate(specular_glossiness.rgb * material.specular_color);
    s.base_color *= 1.0 - max_component(s.f0);
    s.metallic = 0.0;
    s.roughness = saturate(1.0 - specular_glossiness.a * material.roughness_factor);
}

// KHR_materials_specular: F0 = min(F0 color, 1) factor, F90 = factor.
void read_specular(Fragment f, inout Surface s) {
    float factor = material.specular_factor * texture(specular_texture, texture_uv(f, TEXTURE_SPECULAR)).a;
    vec3 color = texture(specular_color_texture, texture_uv(f, TEXTURE_SPECULAR_COLOR)).rgb;
    s.f0 = min(s.f0 * material.specular_color * color, 1.0) * factor;
    s.f90 = factor;
}

// Reads the layers: clear coat, sheen and thin film.
void read_layers(Fragment f, vec3 v, inout Surface s) {
    if ((FEATURES & FEATURE_CLEARCOAT) != 0u) {
        vec2 roughness_uv = texture_uv(f, TEXTURE_CLEARCOAT_ROUGHNESS);
        s.clearcoat_n = clearcoat_normal(f, v);
        s.clearcoat = material.clearcoat_factor * texture(clearcoat_texture, texture_uv(f, TEXTURE_CLEARCOAT)).r;
        s.clearcoat_roughness = material.clearcoat_roughness * texture(clearcoat_roughness_texture, roughness_uv).g;
    }
    if ((FEATURES & FEATURE_SHEEN) != 0u) {
        vec2 roughness_uv = texture_uv(f, TEXTURE_SHEEN_ROUGHNESS);
        s.sheen_color = material.sheen_color * texture(sheen_color_texture, texture_uv(f, TEXTURE_SHEEN_COLOR)).rgb;
        s.sheen_roughness = material.sheen_roughness * texture(sheen_roughness_texture, roughness_uv).a;
    }
    if ((FEATURES & FEATURE_IRIDESCENCE) != 0u) {
        float texel = texture(iridescence_texture, texture_uv(f, TEXTURE_IRIDESCENCE)).r;
        float thickness = texture(iridescence_thickness_texture, texture_uv(f, TEXTURE_IRIDESCENCE_THICKNESS)).g;
        s.iridescence = material.iridescence_factor * texel;
        s.iridescence_ior = material.iridescence_ior;
        s.iridescence_nm = mix(material.iridescence_thickness_nm.x, material.iridescence_thickness_nm.y, thickness);
    }
}

// The length in the world, along the unit vector d_ws, of a path of length 1 in object space, in which
// KHR_materials_volume gives the thickness: 1 / |M^-1 d|. M^-1 = (b x c, c x a, a x b)^T / det for M with the columns a, b,
// c. 0 for a model without depth along d. 1e-30: a model that is a line.
float object_scale(vec3 d_ws) {
    mat3 m = mat3(draw.world_from_object);
    vec3 b_x_c = cross(m[1], m[2]);
    vec3 d_times_det = vec3(dot(b_x_c, d_ws), dot(cross(m[2], m[0]), d_ws), dot(cross(m[0], m[1]), d_ws));
    return abs(dot(m[0], b_x_c)) / max(length(d_times_det), 1e-30);
}

void read_transmission(Fragment f, vec3 v, inout Surface s) {
    if ((FEATURES & FEATURE_TRANSMISSION) != 0u) {
        vec2 uv = texture_uv(f, TEXTURE_TRANSMISSION);
        s.transmission = material.transmission_factor * texture(transmission_texture, uv).r;
    }
    if ((FEATURES & FEATURE_VOLUME) != 0u) {
        float texel = texture(thickness_texture, texture_uv(f, TEXTURE_THICKNESS)).g;
        s.thickness = material.thickness * texel * object_scale(refracted(s.n, v, s.ior));
        s.attenuation_color = material.attenuation_color;
        s.attenuation_distance = material.attenuation_distance;
    }
    if ((FEATURES & FEATURE_DISPERSION) != 0u) s.dispersion = material.dispersion;
    if ((FEATURES & FEATURE_DIFFUSE_TRANSMISSION) != 0u) {
        vec2 uv = texture_uv(f, TEXTURE_DIFFUSE_TRANSMISSION);
        vec2 color_uv = texture_uv(f, TEXTURE_DIFFUSE_TRANSMISSION_COLOR);
        vec3 color = texture(diffuse_transmission_color_texture, color_uv).rgb;
        s.diffuse_transmission = material.diffuse_transmission_factor * texture(diffuse_transmission_texture, uv).a;
        s.diffuse_transmission_color = material.diffuse_transmission_color * color;
    }
}

// `v`: towards the eye, world space, unit. complete_surface (brdf/energy/multiscatter.glsl) fills in the rest.
Surface make_surface(Fragment f, vec3 v) {
    vec4 base_color = texture(base_color_texture, texture_uv(f, TEXTURE_BASE_COLOR));
    vec4 metallic_roughness = texture(metallic_roughness_texture, texture_uv(f, TEXTURE_METALLIC_ROUGHNESS));
    vec3 emissive = texture(emissive_texture, texture_uv(f, TEXTURE_EMISSIVE)).rgb;
    float occlusion = metallic_roughness.r;
    if ((FEATURES & FEATURE_PACKED_OCCLUSION) == 0u) {
        occlusion = texture(occlusion_texture, texture_uv(f, TEXTURE_OCCLUSION)).r;
    }
    base_color *= material.base_color_factor;
    // With multisampling, an edge pixel's center may lie outside of the triangle, where a color is extrapolated below 0.
    if ((FEATURES & FEATURE_VERTEX_COLOR) != 0u) base_color *= max(f.color, vec4(0.0));

    Surface s;
    s.position_ws = f.position_ws;
    s.n = shading_normal(f, v);
    s.ng = geometric_normal(f, v);
    s.base_color = base_color.rgb;
    s.coverage = ALPHA_MODE == ALPHA_OPAQUE ? 1.0 : base_color.a;
    s.metallic = saturate(metallic_roughness.b * material.metallic_factor);
    s.roughness = saturate(metallic_roughness.g * material.roughness_factor);
    s.occlusion = mix(1.0, occlusion, material.occlusion_strength);
    s.emissive = emissive * material.emissive_factor;
    s.ior = material.ior;
    s.f0 = vec3(f0_from_ior(s.ior));
    s.f90 = 1.0;
    clear_extensions(s);

    if ((FEATURES & FEATURE_SPECULAR_GLOSSINESS) != 0u) read_specular_glossiness(metallic_roughness, s);
    if ((FEATURES & FEATURE_SPECULAR) != 0u) read_specular(f, s);
    if ((FEATURES & FEATURE_ANISOTROPY) != 0u) read_anisotropy(f, s);
    if ((FEATURES & FEATURE_CONDUCTOR) != 0u) {
        s.conductor_n = material.conductor_n;
        s.conductor_k = material.conductor_k;
    }
    read_layers(f, v, s);
    read_transmission(f, v, s);
    return s;
}

#endif
