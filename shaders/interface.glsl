// Printed by src/interface.rs. Do not edit: Rust writes this memory, and a test compares this file with what Rust prints.
// The sets, bindings, specialization constants and structs that every shader may use, all in scalar layout.
#ifndef SPECULA_INTERFACE_GLSL
#define SPECULA_INTERFACE_GLSL

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require

const uint INTERFACE_VERSION = 3u;
const int SET_FRAME = 0;
const int SET_MATERIAL = 1;
const int SET_PASS = 2;
const int SET_TASK = 3;
const int BINDING_FRAME = 0;
const int BINDING_LIGHTS = 1;
const int BINDING_PARAMS = 2;
const int BINDING_ENVIRONMENT = 3;
const int BINDING_PREFILTERED = 4;
const int BINDING_PREFILTERED_SHEEN = 5;
const int BINDING_IRRADIANCE = 6;
const int BINDING_DFG = 7;
const int BINDING_LTC = 8;
const int BINDING_MEASURED = 9;
const int BINDING_SHEEN_ALBEDO = 10;
const int BINDING_UNUSED = 11;
const int BINDING_MATERIAL = 0;
const int BINDING_BASE_COLOR_TEXTURE = 1;
const int BINDING_METALLIC_ROUGHNESS_TEXTURE = 2;
const int BINDING_NORMAL_TEXTURE = 3;
const int BINDING_OCCLUSION_TEXTURE = 4;
const int BINDING_EMISSIVE_TEXTURE = 5;
const int BINDING_CLEARCOAT_TEXTURE = 6;
const int BINDING_CLEARCOAT_ROUGHNESS_TEXTURE = 7;
const int BINDING_CLEARCOAT_NORMAL_TEXTURE = 8;
const int BINDING_ANISOTROPY_TEXTURE = 9;
const int BINDING_SHEEN_COLOR_TEXTURE = 10;
const int BINDING_SHEEN_ROUGHNESS_TEXTURE = 11;
const int BINDING_SPECULAR_TEXTURE = 12;
const int BINDING_SPECULAR_COLOR_TEXTURE = 13;
const int BINDING_IRIDESCENCE_TEXTURE = 14;
const int BINDING_IRIDESCENCE_THICKNESS_TEXTURE = 15;
const int BINDING_TRANSMISSION_TEXTURE = 16;
const int BINDING_THICKNESS_TEXTURE = 17;
const int BINDING_DIFFUSE_TRANSMISSION_TEXTURE = 18;
const int BINDING_DIFFUSE_TRANSMISSION_COLOR_TEXTURE = 19;
const int BINDING_SCENE_COLOR = 0;
const int BINDING_BEHIND = 1;
const int BINDING_TASK = 0;
const int BINDING_SOURCE = 1;
const int BINDING_SOURCE_CUBE = 2;
const int BINDING_TARGET = 3;
const int BINDING_LEVEL_ABOVE = 4;
const int BINDING_RESULTS = 5;
const int USER_CONSTANTS = 32;
const uint ALPHA_OPAQUE = 0u;
const uint ALPHA_MASK = 1u;
const uint ALPHA_BLEND = 2u;
const uint FEATURE_UNLIT = 1u;
const uint FEATURE_NORMAL_TEXTURE = 2u;
const uint FEATURE_CLEARCOAT = 4u;
const uint FEATURE_CLEARCOAT_NORMAL = 8u;
const uint FEATURE_ANISOTROPY = 16u;
const uint FEATURE_SHEEN = 32u;
const uint FEATURE_SPECULAR = 64u;
const uint FEATURE_IRIDESCENCE = 128u;
const uint FEATURE_TRANSMISSION = 256u;
const uint FEATURE_VOLUME = 512u;
const uint FEATURE_DISPERSION = 1024u;
const uint FEATURE_DIFFUSE_TRANSMISSION = 2048u;
const uint FEATURE_SPECULAR_GLOSSINESS = 4096u;
const uint FEATURE_CONDUCTOR = 8192u;
const uint FEATURE_PACKED_OCCLUSION = 16384u;
const uint FEATURE_ENVIRONMENT = 32768u;
const uint FEATURE_RECT_LIGHTS = 0x10000u;
const uint FEATURE_TEXTURE_COORDINATES = 0x20000u;
const uint FEATURE_UV1 = 0x40000u;
const uint FEATURE_VERTEX_COLOR = 0x80000u;
const uint TEXTURE_BASE_COLOR = 0u;
const uint TEXTURE_METALLIC_ROUGHNESS = 1u;
const uint TEXTURE_NORMAL = 2u;
const uint TEXTURE_OCCLUSION = 3u;
const uint TEXTURE_EMISSIVE = 4u;
const uint TEXTURE_CLEARCOAT = 5u;
const uint TEXTURE_CLEARCOAT_ROUGHNESS = 6u;
const uint TEXTURE_CLEARCOAT_NORMAL = 7u;
const uint TEXTURE_ANISOTROPY = 8u;
const uint TEXTURE_SHEEN_COLOR = 9u;
const uint TEXTURE_SHEEN_ROUGHNESS = 10u;
const uint TEXTURE_SPECULAR = 11u;
const uint TEXTURE_SPECULAR_COLOR = 12u;
const uint TEXTURE_IRIDESCENCE = 13u;
const uint TEXTURE_IRIDESCENCE_THICKNESS = 14u;
const uint TEXTURE_TRANSMISSION = 15u;
const uint TEXTURE_THICKNESS = 16u;
const uint TEXTURE_DIFFUSE_TRANSMISSION = 17u;
const uint TEXTURE_DIFFUSE_TRANSMISSION_COLOR = 18u;
const uint ATTRIBUTE_NORMAL = 1u;
const uint ATTRIBUTE_TANGENT = 2u;
const uint ATTRIBUTE_UV0 = 4u;
const uint ATTRIBUTE_UV1 = 8u;
const uint ATTRIBUTE_COLOR = 16u;
const uint ATTRIBUTE_TANGENT_FRAME = 32u;
const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;
const uint LIGHT_RECT = 3u;
const uint MEASURED_NONE = 0u;
const uint MEASURED_MERL = 1u;
const uint MEASURED_UTIA = 2u;
const uint ENCODE_COLOR = 0u;
const uint ENCODE_DATA = 1u;
const uint ENCODE_VECTOR = 2u;
const uint TONEMAP_OFF = 0xffffffffu;
const int TEXTURE_COUNT = 19;
const int MAX_LIGHTS = 204;

layout(constant_id = 0) const uint MODE = 0u; // debug mode, one of MODE_* in debug/modes.glsl
layout(constant_id = 1) const uint ALPHA_MODE = 0u; // glTF alphaMode, one of ALPHA_*
layout(constant_id = 2) const uint FEATURES = 0u; // what the material uses, FEATURE_* bits
layout(constant_id = 3) const uint TONEMAP = 0u; // tone map, one of TONEMAP_* in common/tonemap.glsl
layout(constant_id = 4) const uint ENCODE = 0u; // how the picture stores values, one of ENCODE_*
layout(constant_id = 5) const uint LIGHT_COUNT = 0u; // lights, if they are few; 0: see frame.light_count

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
    uint mode;
    float largest_value;       // of the HDR target: 65504 for half floats
    vec2 environment_rotation; // cos, sin of the turn around +Y
    float environment_intensity; // from the environment's images to radiance
    float environment_blur;    // behind the model: 0 sharp .. 1, as a roughness
    uint sample_index;         // accumulating modes: frames since the picture changed
    uint sample_count;         // accumulating modes: paths a pixel in each frame
} frame;

struct Light {
    vec4 position_ws;          // w 1; directional: towards it, unit, w 0
    vec3 direction_ws;         // where it shines to
    uint kind;                 // LIGHT_*
    vec3 intensity;            // linear RGB times candela (point, spot), lux (directional), radiance (rectangle)
    float inverse_range;       // 1/m, 0 without end
    float angle_scale;         // falloff: square of scale times cosine plus offset, within 0..1; no spot: 0
    float angle_offset;         // no spot: 1
    vec3 half_x_ws;            // rectangle: from the center to an edge, meters
    vec3 half_y_ws;
};

layout(set = SET_FRAME, binding = BINDING_LIGHTS, scalar) uniform Lights {
    Light lights[MAX_LIGHTS];
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
    float clearcoat_factor;
    float clearcoat_roughness;
    float clearcoat_normal_scale;
    float anisotropy_strength;
    vec2 anisotropy_rotation;  // cos, sin
    float sheen_roughness;
    vec3 sheen_color;
    float specular_factor;
    vec3 specular_color;       // specular-glossiness: F0
    float ior;                 // 0: infinite
    float iridescence_factor;
    float iridescence_ior;
    vec2 iridescence_thickness_nm; // where the texture is 0 and 1
    float transmission_factor;
    float thickness;           // meters in object space, 0: thin wall
    vec3 attenuation_color;
    float attenuation_distance; // meters
    float dispersion;          // 20 / Abbe number
    float diffuse_transmission_factor;
    vec3 diffuse_transmission_color;
    vec3 conductor_n;          // index of refraction of the metal, n + i k
    vec3 conductor_k;
    mat3x2 uv_from_texture[TEXTURE_COUNT];
} material;

layout(set = SET_TASK, binding = BINDING_TASK, scalar) uniform Task {
    uvec2 size;                // texels, or columns and rows of results
    uint level;                // mip level that is written
    uint levels;
    uint samples;              // for each texel or result
    float radiance_scale;      // fits radiance into half floats
    float roughness_first;     // of the first row
    float roughness_last;
    float theta_first;         // angle to the normal of the first column, degrees
    float theta_last;
    vec3 base_color;           // of the measured surface
    float metallic;
} task;

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
