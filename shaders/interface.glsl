// Printed by src/interface.rs. Do not edit: Rust writes this memory, and a test compares this file with what Rust prints.
// The sets, bindings, specialization constants and structs that every shader may use, all in scalar layout.
#ifndef SPECULA_INTERFACE_GLSL
#define SPECULA_INTERFACE_GLSL

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require

const uint INTERFACE_VERSION = 1u;
const int SET_FRAME = 0;
const int SET_MATERIAL = 1;
const int SET_PASS = 2;
const int BINDING_FRAME = 0;
const int BINDING_LIGHTS = 1;
const int BINDING_PARAMS = 2;
const int BINDING_MATERIAL = 0;
const int BINDING_BASE_COLOR_TEXTURE = 1;
const int BINDING_METALLIC_ROUGHNESS_TEXTURE = 2;
const int BINDING_NORMAL_TEXTURE = 3;
const int BINDING_OCCLUSION_TEXTURE = 4;
const int BINDING_EMISSIVE_TEXTURE = 5;
const int BINDING_SCENE_COLOR = 0;
const int USER_CONSTANTS = 32;
const uint ALPHA_OPAQUE = 0u;
const uint ALPHA_MASK = 1u;
const uint ALPHA_BLEND = 2u;
const uint FEATURE_UNLIT = 1u;
const uint FEATURE_NORMAL_TEXTURE = 2u;
const uint TEXTURE_BASE_COLOR = 0u;
const uint TEXTURE_METALLIC_ROUGHNESS = 1u;
const uint TEXTURE_NORMAL = 2u;
const uint TEXTURE_OCCLUSION = 3u;
const uint TEXTURE_EMISSIVE = 4u;
const uint ATTRIBUTE_NORMAL = 1u;
const uint ATTRIBUTE_TANGENT = 2u;
const uint ATTRIBUTE_UV0 = 4u;
const uint ATTRIBUTE_UV1 = 8u;
const uint ATTRIBUTE_COLOR = 16u;
const uint ATTRIBUTE_TANGENT_FRAME = 32u;
const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;
const uint ENCODE_COLOR = 0u;
const uint ENCODE_DATA = 1u;
const uint ENCODE_VECTOR = 2u;
const uint TONEMAP_OFF = 0xffffffffu;
const int TEXTURE_COUNT = 5;

layout(constant_id = 0) const uint MODE = 0u; // debug mode, one of MODE_* in debug/modes.glsl
layout(constant_id = 1) const uint ALPHA_MODE = 0u; // glTF alphaMode, one of ALPHA_*
layout(constant_id = 2) const uint FEATURES = 0u; // what the material uses, FEATURE_* bits

layout(set = SET_FRAME, binding = BINDING_FRAME, scalar) uniform Frame {
    mat4 clip_from_world;      // reversed depth: 1 near, 0 at infinity
    mat4 world_from_clip;
    mat4 view_from_world;
    vec3 eye_ws;
    float exposure;            // 1 / (1.2 * 2^EV100)
    vec3 ambient;              // radiance from everywhere
    float time_s;
    vec4 background;           // linear RGB, alpha
    vec3 scene_center_ws;
    float scene_radius;
    vec2 viewport_px;
    vec2 viewport_origin_px;
    float near;
    float far;
    uint light_count;
    uint chosen_light;         // 0 all, else 1-based
    uint tonemap;
    uint encode;
    uint mode;
    float largest_value;       // of the HDR target: 65504 for half floats
} frame;

struct Light {
    vec3 position_ws;
    uint kind;                 // LIGHT_*
    vec3 direction_ws;         // where it shines to
    float range;               // meters, 0 without end
    vec3 intensity;            // linear RGB times candela (point, spot) or lux (directional)
    float cos_inner;
    float cos_outer;
};

layout(set = SET_FRAME, binding = BINDING_LIGHTS, scalar) readonly buffer Lights {
    Light lights[];
};

layout(set = SET_MATERIAL, binding = BINDING_MATERIAL, scalar) uniform Material {
    vec4 base_color_factor;
    vec3 emissive_factor;
    float metallic_factor;
    float roughness_factor;
    float normal_scale;
    float occlusion_strength;
    float alpha_cutoff;
    uint texture_mask;         // bit TEXTURE_*: it exists
    uint uv1_mask;             // bit TEXTURE_*: it reads TEXCOORD_1
    uint id;
    mat3x2 uv_from_texture[TEXTURE_COUNT];
} material;

struct Vertex {
    vec3 position;
    vec3 normal;
    vec4 tangent;
    vec2 uv0;
    vec2 uv1;
    vec4 color;
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vertices {
    Vertex at[];
};

layout(push_constant, scalar) uniform Draw {
    Vertices vertices;
    mat4x3 world_from_object;
    mat3 normal_ws_from_object;
    uint attributes;           // ATTRIBUTE_* bits
    uint primitive_id;
    uint node_id;
} draw;

#endif
