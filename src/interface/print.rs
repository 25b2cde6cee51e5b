//! Prints the contract as GLSL.

use std::fmt::Write as _;

use super::bindings::{BINDINGS, FEW_LIGHTS, MAX_LIGHTS};
use super::blocks::{Block, Member};
use super::limits::{
    COLORMAP_STEPS, MAX_LIGHT_VIEWS, MAX_SUNS, SET_FRAME, SET_MATERIAL, SET_PASS, SET_TASK, USER_CONSTANTS, VERSION,
};
use super::lists::{blocks, constants};
use super::material::{TEXTURE_COUNT, TEXTURES};
use super::specialization::SPECIALIZATION;

/// The contract as GLSL: the content of `shaders/interface.glsl`.
pub fn glsl() -> String {
    let mut out = String::from(
        "// Printed by src/interface.rs. Do not edit: Rust writes this memory, and a test compares this file with what Rust prints.\n\
         // The sets, bindings, specialization constants and structs that every shader may use, all in scalar layout.\n\
         #ifndef SPECULA_INTERFACE_GLSL\n#define SPECULA_INTERFACE_GLSL\n\n\
         #extension GL_EXT_scalar_block_layout : require\n\
         #extension GL_EXT_buffer_reference : require\n\
         #extension GL_EXT_buffer_reference2 : require\n\
         #extension GL_EXT_control_flow_attributes : require\n\n",
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
    // The binding that works around a driver's crash is not printed: a shader that declares it is refused.
    for b in BINDINGS.iter().filter(|b| b.name != "BINDING_UNUSED") {
        constant("int", b.name, b.binding.to_string());
    }
    constant("int", "USER_CONSTANTS", USER_CONSTANTS.to_string());
    let textures = (0..).zip(TEXTURES).map(|(index, texture)| (texture.name, index));
    for (name, value) in constants().chain(textures) {
        constant("uint", name, if value > 0xffff { format!("0x{value:x}u") } else { format!("{value}u") });
    }
    constant("int", "TEXTURE_COUNT", TEXTURE_COUNT.to_string());
    constant("int", "MAX_LIGHTS", MAX_LIGHTS.to_string());
    constant("int", "FEW_LIGHTS", FEW_LIGHTS.to_string());
    constant("int", "MAX_SUNS", MAX_SUNS.to_string());
    constant("int", "MAX_LIGHT_VIEWS", MAX_LIGHT_VIEWS.to_string());
    constant("int", "COLORMAP_STEPS", COLORMAP_STEPS.to_string());
    out.push('\n');
    for s in SPECIALIZATION {
        let _ = writeln!(out, "layout(constant_id = {}) const uint {} = 0u; // {}", s.id, s.name, s.doc);
    }
    for block in blocks() {
        // A `String` takes everything.
        let _ = print_block(&mut out, block);
    }
    out.push_str("\n#endif\n");
    out
}

/// A block with its members. A struct that is an element of something is followed by the declaration of that.
fn print_block(out: &mut String, block: &Block) -> std::fmt::Result {
    let [before, after] = block.around;
    writeln!(out, "\n{before} {{")?;
    for Member { name, type_name, doc, .. } in block.members {
        // Rust writes `[mat3; N]`, GLSL `mat3 name[N]`.
        let array = type_name.strip_prefix('[').and_then(|array| array.trim_end_matches(']').split_once("; "));
        let declared = match array {
            Some((element, count)) => format!("{element} {name}[{count}];"),
            None => format!("{type_name} {name};"),
        };
        writeln!(out, "    {declared:<34} // {doc}")?;
    }
    let space = if after.is_empty() { "" } else { " " };
    writeln!(out, "}}{space}{after};")?;
    match block.name {
        "Light" => out.write_str(LIGHTS),
        "Vertex" => out.write_str(VERTICES),
        "Before" => out.write_str(BEFORES),
        "Displacement" => out.write_str(DEFORMATIONS),
        _ => Ok(()),
    }
}

const LIGHTS: &str = "
layout(set = SET_FRAME, binding = BINDING_LIGHTS, scalar) readonly buffer Lights {
    Light lights[]; // frame.light_count lights, then SUN_COUNT suns
};

layout(set = SET_FRAME, binding = BINDING_FEW_LIGHTS, scalar) uniform FewLights {
    Light few_lights[FEW_LIGHTS + MAX_SUNS]; // the same, if MANY_LIGHTS is 0
};
";

const VERTICES: &str = "
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vertices {
    Vertex at[];
};

// Vertices of a triangle. A struct: of two arrays of plain uint in one module, an edit could not tell which is meant.
struct Corners {
    uint vertex[3];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Indices {
    Corners at[];
};
";

const DEFORMATIONS: &str = "
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer MovedVertices {
    Vertex at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Influences {
    Influence at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Displacements {
    Displacement at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Joints {
    mat4 at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Weights {
    float at[];
};
";

const BEFORES: &str = "
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Befores {
    Before at[];
};
";
