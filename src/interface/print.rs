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
    for (name, value) in [("SET_FRAME", SET_FRAME), ("SET_MATERIAL", SET_MATERIAL), ("SET_PASS", SET_PASS)] {
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
    ("TEXTURE_BASE_COLOR", TEXTURE_BASE_COLOR),
    ("TEXTURE_METALLIC_ROUGHNESS", TEXTURE_METALLIC_ROUGHNESS),
    ("TEXTURE_NORMAL", TEXTURE_NORMAL),
    ("TEXTURE_OCCLUSION", TEXTURE_OCCLUSION),
    ("TEXTURE_EMISSIVE", TEXTURE_EMISSIVE),
    ("ATTRIBUTE_NORMAL", ATTRIBUTE_NORMAL),
    ("ATTRIBUTE_TANGENT", ATTRIBUTE_TANGENT),
    ("ATTRIBUTE_UV0", ATTRIBUTE_UV0),
    ("ATTRIBUTE_UV1", ATTRIBUTE_UV1),
    ("ATTRIBUTE_COLOR", ATTRIBUTE_COLOR),
    ("ATTRIBUTE_TANGENT_FRAME", ATTRIBUTE_TANGENT_FRAME),
    ("LIGHT_DIRECTIONAL", LIGHT_DIRECTIONAL),
    ("LIGHT_POINT", LIGHT_POINT),
    ("LIGHT_SPOT", LIGHT_SPOT),
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
";
