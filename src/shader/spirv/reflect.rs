//! Reflects a SPIR-V module for the contract check and the annotations: descriptors, blocks, constants, locations.
//!
//! Expects modules compiled by glslang at -O0, with names and with every declared global, used or not.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::interface::BindingKind;

use super::primitive::Primitive;
use super::reach::Used;

/// One member of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Name in GLSL.
    pub name: String,
    /// Offset from the start of the block, bytes.
    pub offset: u32,
    /// Type as GLSL spells it: `vec3`, `mat4x3`, `Light[]`.
    pub type_name: String,
    /// For arrays, the stride in bytes; else 0.
    pub stride: u32,
}

/// A struct with a memory layout.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Block {
    /// Name of the struct or block in GLSL.
    pub name: String,
    /// Size in bytes up to the end of the last member. A runtime array counts as empty.
    pub size: u32,
    /// Members in declaration order.
    pub members: Vec<Member>,
}

/// A descriptor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Descriptor {
    /// Descriptor set.
    pub set: u32,
    /// Binding within the set.
    pub binding: u32,
    /// `None` for a kind that the contract does not have; `glsl` then names it.
    pub kind: Option<BindingKind>,
    /// The declaration's type as GLSL spells it.
    pub glsl: String,
    /// The name of the block or the variable.
    pub name: String,
    /// The layout, if it is a block.
    pub block: Option<Block>,
    /// Whether it is a storage buffer that the stage may write: one that is not `readonly`.
    pub is_written: bool,
    /// The SPIR-V image format of a storage image; 0 is none.
    pub image_format: u32,
}

/// Type of a specialization constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// `bool`
    Bool,
    /// `int`
    Int,
    /// `uint`
    Uint,
    /// `float`
    Float,
}

/// A specialization constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpecConstant {
    /// `constant_id`
    pub id: u32,
    /// Name in GLSL.
    pub name: String,
    /// Type.
    pub scalar: Scalar,
    /// Bits of the default; 0 or 1 for `bool`.
    pub default: u32,
}

/// A user-defined input or output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// `location`
    pub location: u32,
    /// Name in GLSL.
    pub name: String,
    /// Type as GLSL spells it.
    pub type_name: String,
}

/// The declarations of a module.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reflection {
    /// Descriptors, ordered by set and binding.
    pub descriptors: Vec<Descriptor>,
    /// The push constant block.
    pub push_constants: Option<Block>,
    /// Specialization constants, ordered by id.
    pub constants: Vec<SpecConstant>,
    /// Inputs that the stage uses, ordered by location. Arrays with an element for each vertex count as one element.
    pub inputs: Vec<Location>,
    /// Outputs that the stage uses, ordered by location; arrays as in `inputs`.
    pub outputs: Vec<Location>,
    /// Every struct with member offsets, by name, including elements of arrays and targets of buffer references.
    pub structs: BTreeMap<String, Block>,
    /// Constants that glslang left without a value: it generates no code for `&&` and `||` of specialization constants.
    pub without_value: Vec<String>,
    /// Variables that have more than `interface::LARGEST_VARIABLE` bytes in each invocation, with their bytes.
    pub large_variables: Vec<(String, u64)>,
    /// The SPIR-V capabilities that the module declares.
    pub capabilities: Vec<u32>,
    /// Invocations of a workgroup along x, y and z; 0 in stages without workgroups.
    pub local_size: [u32; 3],
    /// Descriptors and push constants that functions called from the entry point use.
    pub reached: BTreeSet<Used>,
    /// The bytes that the stage may read of the block `Params`.
    pub params_read: Vec<Range<usize>>,
    /// The largest numbers of vertices and primitives that a workgroup of a mesh stage gives.
    pub mesh_outputs: [u32; 2],
    /// Whether the stage is a task stage with a message for mesh stages (`taskPayloadSharedEXT`), or a mesh stage that takes one.
    pub has_payload: bool,
    /// The primitives that a geometry stage takes.
    pub takes: Option<Primitive>,
    /// The primitives that a tessellation evaluation, a geometry or a mesh stage gives.
    pub gives: Option<Primitive>,
    /// Whether the stage reads `gl_PrimitiveID`, or `gl_PrimitiveIDIn`.
    pub reads_primitive_id: bool,
    /// Whether the stage writes `gl_PrimitiveID`.
    pub writes_primitive_id: bool,
}

impl Reflection {
    /// The descriptor with this set and binding.
    pub fn descriptor(&self, set: u32, binding: u32) -> Option<&Descriptor> {
        self.descriptors.iter().find(|found| (found.set, found.binding) == (set, binding))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;

    fn reflect(name: &str, text: &str) -> Reflection {
        let source = Source::memory([(name, text)]);
        let compiled = Compiler::new().unwrap().compile(&Snapshot::new(&source), &name.into());
        Reflection::of(&compiled.result.unwrap())
    }

    #[test]
    fn blocks_and_samplers() {
        let reflection = reflect(
            "m.frag",
            "#version 460\n#extension GL_EXT_scalar_block_layout : require\n
             struct S { vec3 a; float b[3]; };
             layout(set = 0, binding = 2, scalar) uniform Params { float x; vec3 y; mat4x3 m; S s[2]; bool on; };
             layout(set = 1, binding = 3) uniform sampler2D image;
             layout(set = 1, binding = 4) uniform samplerCube cube;
             layout(set = 0, binding = 1, scalar) readonly buffer List { uint count; S all[]; } list;
             layout(set = 3, binding = 0, rgba8) uniform image2D other;
             void main() {}",
        );
        let kinds: Vec<_> =
            reflection.descriptors.iter().map(|d| (d.set, d.binding, d.kind, d.name.as_str())).collect();
        use BindingKind::{Sampler2D, SamplerCube, StorageBuffer, UniformBuffer};
        let expected = [
            (0, 1, Some(StorageBuffer), "List"),
            (0, 2, Some(UniformBuffer), "Params"),
            (1, 3, Some(Sampler2D), "image"),
            (1, 4, Some(SamplerCube), "cube"),
            (3, 0, None, "other"),
        ];
        assert_eq!(kinds, expected);
        assert_eq!(reflection.descriptors[4].glsl, "image2D");
        let block = reflection.descriptor(0, 2).unwrap().block.as_ref().unwrap();
        let members: Vec<_> = block.members.iter().map(|m| (m.name.as_str(), m.offset, m.type_name.as_str())).collect();
        let expected =
            [("x", 0, "float"), ("y", 4, "vec3"), ("m", 16, "mat4x3"), ("s", 64, "S[2]"), ("on", 112, "uint")];
        assert_eq!(members, expected);
        assert_eq!(block.size, 116);
        assert_eq!(reflection.structs["S"].size, 24);
        let list = reflection.descriptor(0, 1).unwrap().block.as_ref().unwrap();
        assert_eq!((list.size, list.members[1].stride), (4, 24));
    }

    #[test]
    fn constants_keep_type_and_default_even_unused() {
        let reflection = reflect(
            "m.frag",
            "#version 460
             layout(constant_id = 33) const bool B = true;
             layout(constant_id = 32) const uint U = 7u;
             layout(constant_id = 34) const int I = -2;
             layout(constant_id = 35) const float F = 0.5;
             void main() {}",
        );
        let constants: Vec<_> =
            reflection.constants.iter().map(|c| (c.id, c.name.as_str(), c.scalar, c.default)).collect();
        let expected = [
            (32, "U", Scalar::Uint, 7),
            (33, "B", Scalar::Bool, 1),
            (34, "I", Scalar::Int, (-2_i32).cast_unsigned()),
            (35, "F", Scalar::Float, 0.5_f32.to_bits()),
        ];
        assert_eq!(constants, expected);
    }

    #[test]
    fn locations_without_built_ins() {
        let reflection = reflect(
            "m.vert",
            "#version 460
             layout(location = 1) out vec3 normal; layout(location = 0) out flat uint id; layout(location = 2) in vec2 uv;
             layout(location = 3) out Pair { vec4 a; vec2 b; } pair;
             void main() { normal = vec3(uv, 0.0); id = uint(gl_VertexIndex); gl_Position = vec4(0.0); pair.a = vec4(1); }",
        );
        let names = |list: &[Location]| {
            list.iter().map(|l| (l.location, l.name.clone(), l.type_name.clone())).collect::<Vec<_>>()
        };
        let row = |location: u32, name: &str, kind: &str| (location, name.to_owned(), kind.to_owned());
        assert_eq!(names(&reflection.inputs), [row(2, "uv", "vec2")]);
        let expected =
            [row(0, "id", "uint"), row(1, "normal", "vec3"), row(3, "Pair.a", "vec4"), row(4, "Pair.b", "vec2")];
        assert_eq!(names(&reflection.outputs), expected);
    }

    #[test]
    fn stages_between_vertices_and_fragments() {
        let names = |list: &[Location]| -> Vec<String> {
            list.iter().map(|l| format!("{} {} {}", l.location, l.type_name, l.name)).collect()
        };
        let structure = "struct S { vec3 a; vec2 b; };";
        let geometry = reflect(
            "m.geom",
            &format!(
                "#version 460\n{structure}
                 layout(triangles) in;
                 layout(line_strip, max_vertices = 2) out;
                 layout(location = 0) in S from[]; layout(location = 0) out S to; layout(location = 5) out float list[2];
                 void main() {{
                     to = from[1]; list[0] = 1.0; gl_Position = gl_in[0].gl_Position; gl_PrimitiveID = gl_PrimitiveIDIn;
                     EmitVertex();
                 }}"
            ),
        );
        assert_eq!((geometry.takes, geometry.gives), (Some(Primitive::Triangles), Some(Primitive::Lines)));
        assert!(geometry.reads_primitive_id && geometry.writes_primitive_id);
        assert_eq!(names(&geometry.inputs), ["0 vec3 S.a", "1 vec2 S.b"]);
        assert_eq!(names(&geometry.outputs), ["0 vec3 S.a", "1 vec2 S.b", "5 float[2] list"]);
        let control = reflect(
            "m.tesc",
            &format!(
                "#version 460\n{structure}
                 layout(vertices = 3) out;
                 layout(location = 0) in S from[]; layout(location = 0) out S to[]; layout(location = 2) patch out vec4 all;
                 void main() {{ to[gl_InvocationID] = from[gl_InvocationID]; all = vec4(1.0); gl_TessLevelInner[0] = 2.0; }}"
            ),
        );
        assert_eq!(names(&control.inputs), ["0 vec3 S.a", "1 vec2 S.b"]);
        assert_eq!(names(&control.outputs), ["0 vec3 S.a", "1 vec2 S.b", "2 patch vec4 all"]);
        let evaluation = |layout: &str| {
            let text = format!(
                "#version 460\n{structure}\nlayout({layout}) in;\nlayout(location = 0) in S from[];
                 layout(location = 2) patch in vec4 all; layout(location = 0) out vec4 to;
                 void main() {{ to = all + from[0].a.xxxx; gl_Position = gl_in[0].gl_Position; }}"
            );
            reflect("m.tese", &text)
        };
        let triangles = evaluation("triangles");
        assert_eq!(names(&triangles.inputs), ["0 vec3 S.a", "1 vec2 S.b", "2 patch vec4 all"]);
        assert_eq!(names(&triangles.outputs), ["0 vec4 to"]);
        assert_eq!((triangles.takes, triangles.gives), (None, Some(Primitive::Triangles)));
        assert_eq!(evaluation("isolines").gives, Some(Primitive::Lines));
        assert_eq!(evaluation("quads, point_mode").gives, Some(Primitive::Points));
    }

    #[test]
    fn stages_of_a_mesh_pipeline() {
        let names = |list: &[Location]| -> Vec<String> {
            list.iter().map(|l| format!("{} {} {}", l.location, l.type_name, l.name)).collect()
        };
        let head = "#version 460\n#extension GL_EXT_mesh_shader : require\nstruct Sent { uint a; };\n\
            taskPayloadSharedEXT Sent sent;\nlayout(local_size_x = 16) in;\n";
        let mesh = reflect(
            "m.mesh",
            &format!(
                "{head}struct S {{ vec3 a; vec2 b; }};
                 layout(triangles, max_vertices = 9, max_primitives = 3) out;
                 layout(location = 0) out S to[]; layout(location = 4) perprimitiveEXT out vec4 all[];
                 void main() {{
                     SetMeshOutputsEXT(9, 3); to[1].a = vec3(sent.a); all[0] = vec4(1.0); gl_MeshPrimitivesEXT[0].gl_PrimitiveID = 7;
                 }}"
            ),
        );
        assert_eq!(names(&mesh.outputs), ["0 vec3 S.a", "1 vec2 S.b", "4 perprimitiveEXT vec4 all"]);
        assert_eq!((mesh.local_size, mesh.mesh_outputs), ([16, 1, 1], [9, 3]));
        assert_eq!((mesh.gives, mesh.takes), (Some(Primitive::Triangles), None));
        assert!(mesh.has_payload && mesh.writes_primitive_id && mesh.inputs.is_empty());
        let task = reflect("m.task", &format!("{head}void main() {{ sent.a = 5u; EmitMeshTasksEXT(1, 1, 1); }}"));
        assert!(task.has_payload && task.outputs.is_empty());
        assert_eq!(task.local_size, [16, 1, 1]);
    }

    #[test]
    fn garbage_is_no_panic() {
        for words in [vec![], vec![1, 2, 3], vec![0x0723_0203, 0, 0, 9, 0, 0xffff_003b, 1], vec![0; 40]] {
            assert_eq!(Reflection::of(&words), Reflection::default());
        }
    }
}
