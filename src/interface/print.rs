//! Prints the contract as GLSL.

use std::fmt::Write as _;

use super::*;

/// The contract as GLSL: the content of `shaders/interface.glsl`.
pub fn glsl() -> String {
    let mut out = String::from(
        "// Printed by src/interface.rs. Do not edit: Rust writes this memory, and a test compares this file with what Rust prints.\n\
         // The sets, bindings, specialization constants and structs that every shader may use, all in scalar layout.\n\
         #ifndef SPECULA_INTERFACE_GLSL\n#define SPECULA_INTERFACE_GLSL\n\n\
         #extension GL_EXT_scalar_block_layout : require\n\
         #extension GL_EXT_buffer_reference : require\n\
         #extension GL_EXT_buffer_reference2 : require\n\n",
    );
    let mut constant = |kind: &str, name: &str, value: String| {
        let _ = writeln!(out, "const {kind} {name} = {value};");
    };
    constant("uint", "INTERFACE_VERSION", format!("{VERSION}u"));
    for (name, value) in
        [("SET_FRAME", SET_FRAME), ("SET_MATERIAL", SET_MATERIAL), ("SET_PASS", SET_PASS), ("SET_TASK", SET_TASK)]
    {
        constant("int", name, value.to_string());
    }
    for b in BINDINGS {
        constant("int", b.name, b.binding.to_string());
    }
    constant("int", "USER_CONSTANTS", USER_CONSTANTS.to_string());
    for (name, value) in UINTS {
        constant("uint", name, if *value > 0xffff { format!("0x{value:x}u") } else { format!("{value}u") });
    }
    constant("int", "TEXTURE_COUNT", TEXTURE_COUNT.to_string());
    constant("int", "MAX_LIGHTS", MAX_LIGHTS.to_string());
    out.push('\n');
    for s in SPECIALIZATION {
        let _ = writeln!(out, "layout(constant_id = {}) const uint {} = 0u; // {}", s.id, s.name, s.doc);
    }
    out.push_str(STRUCTS);
    out.push_str("\n#endif\n");
    out
}

const UINTS: &[(&str, u32)] = &[
    ("ALPHA_OPAQUE", ALPHA_OPAQUE),
    ("ALPHA_MASK", ALPHA_MASK),
    ("ALPHA_BLEND", ALPHA_BLEND),
    ("FEATURE_UNLIT", FEATURE_UNLIT),
    ("FEATURE_NORMAL_TEXTURE", FEATURE_NORMAL_TEXTURE),
    ("FEATURE_CLEARCOAT", FEATURE_CLEARCOAT),
    ("FEATURE_CLEARCOAT_NORMAL", FEATURE_CLEARCOAT_NORMAL),
    ("FEATURE_ANISOTROPY", FEATURE_ANISOTROPY),
    ("FEATURE_SHEEN", FEATURE_SHEEN),
    ("FEATURE_SPECULAR", FEATURE_SPECULAR),
    ("FEATURE_IRIDESCENCE", FEATURE_IRIDESCENCE),
    ("FEATURE_TRANSMISSION", FEATURE_TRANSMISSION),
    ("FEATURE_VOLUME", FEATURE_VOLUME),
    ("FEATURE_DISPERSION", FEATURE_DISPERSION),
    ("FEATURE_DIFFUSE_TRANSMISSION", FEATURE_DIFFUSE_TRANSMISSION),
    ("FEATURE_SPECULAR_GLOSSINESS", FEATURE_SPECULAR_GLOSSINESS),
    ("FEATURE_CONDUCTOR", FEATURE_CONDUCTOR),
    ("FEATURE_PACKED_OCCLUSION", FEATURE_PACKED_OCCLUSION),
    ("FEATURE_ENVIRONMENT", FEATURE_ENVIRONMENT),
    ("FEATURE_RECT_LIGHTS", FEATURE_RECT_LIGHTS),
    ("FEATURE_TEXTURE_COORDINATES", FEATURE_TEXTURE_COORDINATES),
    ("FEATURE_UV1", FEATURE_UV1),
    ("FEATURE_VERTEX_COLOR", FEATURE_VERTEX_COLOR),
    ("TEXTURE_BASE_COLOR", TEXTURE_BASE_COLOR),
    ("TEXTURE_METALLIC_ROUGHNESS", TEXTURE_METALLIC_ROUGHNESS),
    ("TEXTURE_NORMAL", TEXTURE_NORMAL),
    ("TEXTURE_OCCLUSION", TEXTURE_OCCLUSION),
    ("TEXTURE_EMISSIVE", TEXTURE_EMISSIVE),
    ("TEXTURE_CLEARCOAT", TEXTURE_CLEARCOAT),
    ("TEXTURE_CLEARCOAT_ROUGHNESS", TEXTURE_CLEARCOAT_ROUGHNESS),
    ("TEXTURE_CLEARCOAT_NORMAL", TEXTURE_CLEARCOAT_NORMAL),
    ("TEXTURE_ANISOTROPY", TEXTURE_ANISOTROPY),
    ("TEXTURE_SHEEN_COLOR", TEXTURE_SHEEN_COLOR),
    ("TEXTURE_SHEEN_ROUGHNESS", TEXTURE_SHEEN_ROUGHNESS),
    ("TEXTURE_SPECULAR", TEXTURE_SPECULAR),
    ("TEXTURE_SPECULAR_COLOR", TEXTURE_SPECULAR_COLOR),
    ("TEXTURE_IRIDESCENCE", TEXTURE_IRIDESCENCE),
    ("TEXTURE_IRIDESCENCE_THICKNESS", TEXTURE_IRIDESCENCE_THICKNESS),
    ("TEXTURE_TRANSMISSION", TEXTURE_TRANSMISSION),
    ("TEXTURE_THICKNESS", TEXTURE_THICKNESS),
    ("TEXTURE_DIFFUSE_TRANSMISSION", TEXTURE_DIFFUSE_TRANSMISSION),
    ("TEXTURE_DIFFUSE_TRANSMISSION_COLOR", TEXTURE_DIFFUSE_TRANSMISSION_COLOR),
    ("ATTRIBUTE_NORMAL", ATTRIBUTE_NORMAL),
    ("ATTRIBUTE_TANGENT", ATTRIBUTE_TANGENT),
    ("ATTRIBUTE_UV0", ATTRIBUTE_UV0),
    ("ATTRIBUTE_UV1", ATTRIBUTE_UV1),
    ("ATTRIBUTE_COLOR", ATTRIBUTE_COLOR),
    ("ATTRIBUTE_TANGENT_FRAME", ATTRIBUTE_TANGENT_FRAME),
    ("LIGHT_DIRECTIONAL", LIGHT_DIRECTIONAL),
    ("LIGHT_POINT", LIGHT_POINT),
    ("LIGHT_SPOT", LIGHT_SPOT),
    ("LIGHT_RECT", LIGHT_RECT),
    ("MEASURED_NONE", MEASURED_NONE),
    ("MEASURED_MERL", MEASURED_MERL),
    ("MEASURED_UTIA", MEASURED_UTIA),
    ("ENCODE_COLOR", ENCODE_COLOR),
    ("ENCODE_DATA", ENCODE_DATA),
    ("ENCODE_VECTOR", ENCODE_VECTOR),
    ("TONEMAP_OFF", TONEMAP_OFF),
];

/// The structs in GLSL. Field for field the twins of the Rust structs above; the contract check compares their offsets.
const STRUCTS: &str = r"
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
";
