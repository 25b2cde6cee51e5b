// Modes of the group Geometry: the mesh, and the density of its textures on screen.
#ifndef DEBUG_GEOMETRY_GLSL
#define DEBUG_GEOMETRY_GLSL

#include "interface.glsl"
#include "brdf/surface.glsl"
#include "common/color.glsl"
#include "common/fragment.glsl"
#include "debug/absent.glsl"
#include "debug/modes.glsl"
#include "material/material.glsl"

const vec3 GOOD = vec3(0.05, 0.5, 0.1);
const vec3 BAD = vec3(0.8, 0.06, 0.03);

bool has_attribute(uint bit) { return (draw.attributes & bit) != 0u; }

// The mip level at which the base color texture is sampled.
float mip_level(Fragment f) { return textureQueryLod(base_color_texture, texture_uv(f, TEXTURE_BASE_COLOR)).x; }

// Texels per meter as a power of 2: the square root of a pixel's area in texels over its area in the world.
float texel_density_log2(Fragment f) {
    vec2 texel = texture_uv(f, TEXTURE_BASE_COLOR) * vec2(textureSize(base_color_texture, 0));
    float texels = abs(determinant(mat2(dFdx(texel), dFdy(texel))));
    float area = length(cross(dFdx(f.position_ws), dFdy(f.position_ws)));
    // 1e-20: a triangle may have zero area in UV or world space.
    return 0.5 * log2(max(texels, 1e-20) / max(area, 1e-20));
}

vec3 tangent_sign(Fragment f) { return f.tangent_ws.w < 0.0 ? number_or_color(0u, BAD) : number_or_color(1u, GOOD); }

vec3 facing() { return gl_FrontFacing ? number_or_color(0u, GOOD) : number_or_color(1u, BAD); }

vec3 id_or_color(uint id) { return number_or_color(id, color_from_id(id)); }

bool debug_geometry(Fragment f, Surface s, vec3 v, out vec3 value) {
    bool has_frame = has_attribute(ATTRIBUTE_TANGENT_FRAME);
    bool has_base_color = has_texture(TEXTURE_BASE_COLOR);
    bool known = true;
    if (MODE == MODE_POSITION) value = f.position_ws;
    else if (MODE == MODE_DEPTH) value = vec3(-(frame.view_from_world * vec4(f.position_ws, 1.0)).z);
    else if (MODE == MODE_GEOMETRIC_NORMAL) value = geometric_normal(f, v);
    else if (MODE == MODE_SHADING_NORMAL) value = s.n;
    else if (MODE == MODE_FACET_NORMAL) value = facet_normal(f, v);
    else if (MODE == MODE_TANGENT) value = if_present(has_frame, safe_normalize(f.tangent_ws.xyz, vec3(0.0)));
    else if (MODE == MODE_BITANGENT) value = if_present(has_frame, safe_normalize(bitangent_ws(f), vec3(0.0)));
    else if (MODE == MODE_TANGENT_SIGN) value = if_present(has_frame, tangent_sign(f));
    else if (MODE == MODE_UV0) value = if_present(has_attribute(ATTRIBUTE_UV0), vec3(f.uv0, 0.0));
    else if (MODE == MODE_UV1) value = if_present(has_attribute(ATTRIBUTE_UV1), vec3(f.uv1, 0.0));
    else if (MODE == MODE_VERTEX_COLOR) value = if_present(has_attribute(ATTRIBUTE_COLOR), f.color.rgb);
    else if (MODE == MODE_FACE_ORIENTATION) value = facing();
    else if (MODE == MODE_TRIANGLE_ID) value = id_or_color(uint(gl_PrimitiveID));
    else if (MODE == MODE_MESH_ID) value = id_or_color(draw.primitive_id);
    else if (MODE == MODE_NODE_ID) value = id_or_color(draw.node_id);
    else if (MODE == MODE_MATERIAL_ID) value = id_or_color(material.id);
    else if (MODE == MODE_MIP_LEVEL) value = if_present(has_base_color, vec3(mip_level(f)));
    else if (MODE == MODE_TEXEL_DENSITY) value = if_present(has_base_color, vec3(texel_density_log2(f)));
    else if (MODE == MODE_WIREFRAME) value = vec3(0.02 + 0.6 * pow(abs(dot(s.n, v)), 3.0));
    else if (MODE == MODE_OVERDRAW) value = vec3(1.0);
    else known = false;
    return known;
}

#endif
