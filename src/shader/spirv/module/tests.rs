//! Tests on modules that glslang compiles.

use super::words::MAGIC;
use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::op::Op;
use crate::shader::spirv::{optimize, specialize, validate};

fn compiled(name: &str, text: &str) -> Vec<u32> {
    let source = Source::memory([(name, text)]);
    Compiler::new().unwrap().compile(&Snapshot::new(&source), &name.into()).result.unwrap()
}

const TEXT: &str = "#version 460
    layout(set = 1, binding = 2) uniform Block { vec4 a; float b[3]; } block;
    layout(location = 0) out vec4 color;
    float unused(float x) { return x; }
    float third(float x) { return x + block.b[1]; }
    float second(float x) { return third(x) * third(2.0); }
    void main() { color = block.a * second(1.0) + third(3.0); }";

#[test]
fn what_is_read_is_written_again() {
    for (name, text) in [
        ("m.frag", TEXT),
        (
            "m.comp",
            "#version 460\nlayout(local_size_x = 8) in; shared uint all; void main() { atomicAdd(all, 1u); barrier(); }",
        ),
        ("m.vert", "#version 460\nvoid main() { gl_Position = vec4(gl_VertexIndex); }"),
    ] {
        let words = compiled(name, text);
        assert_eq!(Module::parse(&words).unwrap().write(), words, "{name}");
    }
}

#[test]
fn unknown_operations_stay() {
    let text = "#version 460\n#extension GL_EXT_ray_query : require\nlayout(location = 0) out vec4 color;
        layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
        layout(constant_id = 7) const uint KIND = 0u;
        bool is_hit() {
            rayQueryEXT ray;
            rayQueryInitializeEXT(ray, scene, 0u, 255u, vec3(0.0), 0.0, vec3(1.0), 9.0);
            return rayQueryProceedEXT(ray);
        }
        void main() { color = vec4(0.0); if (KIND == 1u && is_hit()) color = vec4(1.0); }";
    let words = compiled("m.frag", text);
    assert!(Module::parse(&words).unwrap().code().any(|i| i.op == Op::Unknown));
    assert_eq!(Module::parse(&words).unwrap().write(), words);
    assert_eq!(optimize(words.clone()), words);
    for kind in [0, 1] {
        let specialized = specialize(&words, &[(7, kind)]);
        let has_ray = Module::parse(&specialized).unwrap().code().any(|i| i.op == Op::Unknown);
        assert_eq!((has_ray, validate(&specialized)), (kind == 1, Ok(())));
    }
}

#[test]
fn callees_come_before_their_callers() {
    let module = Module::parse(&compiled("m.frag", TEXT)).unwrap();
    let order = module.callees_first(module.entry_function().unwrap()).unwrap();
    let names: Vec<String> = order.iter().map(|at| module.name(module.functions[*at].id).unwrap()).collect();
    assert_eq!(names, ["third(f1;", "second(f1;", "main"]);
}

#[test]
fn declarations_are_shared() {
    let mut module = Module::parse(&compiled("m.frag", TEXT)).unwrap();
    let count = module.globals.len();
    let float = module.declare(Op::TypeFloat, &[32]);
    assert_eq!(module.get_type(float), Some(Type::Float { bits: 32 }));
    let one = module.constant(float, 1.0_f32.to_bits());
    assert_eq!((module.globals.len(), module.number(one)), (count, Some(1.0_f32.to_bits())));
    let other = module.constant(float, 17.0_f32.to_bits());
    assert_eq!((module.globals.len(), module.type_of(other)), (count + 1, float));
    assert_eq!(validate(&module.write()), Ok(()));
}

#[test]
fn words_that_are_no_module_are_refused() {
    const OF: [u32; 5] = [MAGIC, 0x0001_0500, 0, 9, 0];
    assert!(Module::parse(&OF).is_some());
    for words in [vec![], vec![1, 2, 3], vec![0; 40], vec![MAGIC, 0, 0, 1 << 30, 0]] {
        assert!(Module::parse(&words).is_none());
    }
    // A length of 0, one beyond the end, a load without its pointer, and a result beyond the bound
    for rest in [&[0][..], &[0xffff_0036], &[3 << 16 | 61, 1, 2], &[2 << 16 | 19, 9]] {
        assert!(Module::parse(&[&OF[..], rest].concat()).is_none());
    }
}
