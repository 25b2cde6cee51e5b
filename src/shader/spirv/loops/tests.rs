use super::place::{name, seed};
use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::specialize;
use crate::shader::spirv::initial::initialize;
use crate::shader::spirv::module::Module;
use crate::shader::spirv::module::{Block, Id, Instruction};
use crate::shader::spirv::op::Op;

const BOUNDS: Bounds =
    Bounds { rounds: 1000, rounds_after: 10, report: Some((0, 20)), mark: Some([1.0, 0.0, 1.0, 257.0]) };

/// A fragment stage with this `main` and these functions.
fn module(functions: &str, main: &str) -> Vec<u32> {
    let text = format!(
        "#version 460\nlayout(constant_id = 7) const uint COUNT = 5u;\n\
         layout(location = 0) in flat uvec4 given;\nlayout(location = 1) in vec4 x;\n\
         layout(location = 0) out vec4 color;\n\
         {functions}\nvoid main() {{ color = x;\n{main}\n}}\n"
    );
    let source = Source::memory([("m.frag", text.as_str())]);
    Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap()
}

/// How many loops of a module count their rounds.
fn counting(words: &[u32]) -> usize {
    let specialized = specialize(words, &[]);
    let mut module = Module::parse(&specialized).expect("a module");
    initialize(&mut module);
    let specialized = module.write();
    if !bound(&mut module, words, &BOUNDS) {
        assert_eq!(module.write(), specialized, "a module without such loops stays as it is");
        return 0;
    }
    // A loop that counts leaves its header by a condition.
    let is_header = |block: &&Block| block.structure(&module).1.is_some() && block.ends_with(Op::BranchConditional);
    module.functions.iter().flat_map(|function| &function.blocks).filter(is_header).count()
}

#[track_caller]
fn assert_counting(main: &str, count: usize) {
    assert_eq!(counting(&module("", main)), count, "{main}");
}

#[test]
fn a_loop_with_a_constant_end_is_left_alone() {
    for main in [
        "for (int i = 0; i < 8; ++i) color += x;",
        "for (uint i = 0u; i < COUNT; i += 2u) color += x;",
        "for (int i = 7; i >= 0; --i) color += x;",
        "for (int i = -5; i != 5; ++i) color += x;",
        "int i = 0; while (i < 8) { color += x; ++i; }",
        "for (int i = 0; i < 8; ++i) { if (color.x > 2.0) break; color += x; }",
        "for (int i = 0; i < 8; ++i) { if (color.x > 2.0) continue; color += x; }",
        "for (float t = 0.0; t < 1.0; t += 0.01) color += x;",
        "for (uint n = 512u; n > 0u; n /= 2u) color += x;",
        "for (uint n = 512u; n > 0u; n >>= 1) color += x;",
        "for (int i = 0; i < 8; ++i) for (int j = 0; j < 8; ++j) color += x;",
        "for (int i = 0; i < 8 && color.x < 2.0; ++i) color += x;",
        "for (float i; i++ < 8.0;) color += x;",
    ] {
        assert_counting(main, 0);
    }
}

#[test]
fn a_loop_up_to_data_with_a_limit_is_left_alone() {
    for main in [
        "for (uint i = given.x; i < min(given.y, 200u); ++i) color += x;",
        "uint end = min(given.y, 200u); for (uint i = given.x; i < end; ++i) color += x;",
        "for (uint i = 0u; i <= given.y % 16u; ++i) color += x;",
        "for (int i = -3; i < min(int(given.y), 200); ++i) color += x;",
    ] {
        assert_counting(main, 0);
    }
}

#[test]
fn every_other_loop_counts() {
    for (main, count) in [
        ("while (color.x < 2.0) color.x *= 0.5;", 1),
        ("while (true) { color += x; if (color.x > 2.0) break; }", 1),
        ("do { color += x; } while (color.x < 2.0);", 1),
        ("for (uint i = 0u; i < given.x; ++i) color += x;", 1),
        ("for (uint i = 0u; i < 8u; i += given.x) color += x;", 1),
        ("for (uint i = 8u; i >= 0u; --i) color += x;", 1),
        ("for (int i = 0; i < 8; ++i) { if (color.x > 2.0) --i; color += x; }", 1),
        ("int i = 0; while (i < 8) { color += x; if (color.x > 2.0) continue; ++i; }", 1),
        ("for (int i = 0; i < 8 || color.x < 2.0; ++i) color += x;", 1),
        ("for (float t = 0.0; t < 1.0; t += 1e-9) color += x;", 1),
        ("for (int i = int(given.x); i < 8; ++i) color += x;", 1),
        ("int i; if (color.x > 2.0) i = int(given.x); for (; i < 8; ++i) color += x;", 1),
        ("int j; while (color.x < 2.0) for (; j < 8; ++j) color += x;", 2),
        // The number of rounds is known and too large.
        ("for (int i = 0; i < 1000000; ++i) color += x;", 1),
        ("for (int i = 0; i < 1000; ++i) for (int j = 0; j < 1000; ++j) color += x;", 2),
        ("while (color.x < 2.0) { for (int i = 0; i < 4; ++i) color += x; }", 1),
        ("while (color.x < 2.0) { while (color.y < 2.0) color += x; }", 2),
    ] {
        assert_counting(main, count);
    }
}

#[test]
fn loops_in_functions_count_with_those_around_the_call() {
    let hundred = "vec4 f() { vec4 y = x; for (int i = 0; i < 100; ++i) y = cos(y); return y; }";
    assert_eq!(counting(&module(hundred, "color = f();")), 0);
    assert_eq!(counting(&module(hundred, "while (color.x < 2.0) color = f();")), 2);
    assert_eq!(counting(&module(hundred, "for (int i = 0; i < 1000; ++i) color = f();")), 2);
    // A parameter that the function changes.
    let changes = "void f(inout int i) { i = i % 3; }";
    assert_eq!(counting(&module(changes, "for (int i = 0; i < 8; ++i) { f(i); color += x; }")), 1);
    // A loop that only a return leaves.
    let returns = "vec4 f() { vec4 y = x; while (true) { y = cos(y); if (y.x > 2.0) return y; } }";
    assert_eq!(counting(&module(returns, "color = f();")), 1);
    assert_eq!(counting(&module("", "while (color.x < 2.0) { if (color.y > 3.0) discard; color *= 0.5; }")), 1);
}

#[test]
fn a_loop_of_too_many_rounds_is_told_from_one_without_an_end() {
    for (main, is_finite) in
        [("for (int i = 0; i < 1000000; ++i) color += x;", true), ("while (color.x < 2.0) color.x *= 0.5;", false)]
    {
        let words = module("", main);
        let all = Module::parse(&words).unwrap();
        let blocks = all.functions.iter().flat_map(|function| &function.blocks);
        let label = blocks.into_iter().find(|block| block.structure(&all).1.is_some()).unwrap().label;
        let place = LoopPlace::find(Overrun { one: name(seed(&words), label), together: 0 }, &words).unwrap();
        assert_eq!(place.is_finite, is_finite, "{main}");
    }
}

#[test]
fn an_overrun_finds_its_loop() {
    let function = "vec4 f() { vec4 y = x;\n while (y.x < 2.0)\n  y *= 0.5; return y; }";
    let words = module(function, "for (int i = 0; i < 8; ++i) color += x;\ncolor = f();");
    let labels: Vec<Id> = {
        let module = Module::parse(&words).unwrap();
        let blocks = module.functions.iter().flat_map(|function| &function.blocks);
        blocks.filter(|block| block.structure(&module).1.is_some()).map(|block| block.label).collect()
    };
    let seed = seed(&words);
    let places: Vec<LoopPlace> = labels
        .iter()
        .map(|label| LoopPlace::find(Overrun { one: name(seed, *label), together: 0 }, &words).expect("a loop"))
        .collect();
    let functions: Vec<(Option<usize>, &str)> = places.iter().map(|p| (p.number, p.function.as_str())).collect();
    assert_eq!(functions, [(Some(0), "main"), (Some(0), "f(")]);
    let together = Overrun { one: 0, together: name(seed, 0) };
    assert_eq!(
        LoopPlace::find(together, &words),
        Some(LoopPlace { number: None, function: String::new(), is_finite: false })
    );
    assert_eq!(LoopPlace::find(Overrun { one: 1, together: 0 }, &words), None);
}

#[test]
fn a_task_stage_names_its_loop_before_it_starts_mesh_workgroups() {
    let text = "#version 460\n#extension GL_EXT_mesh_shader : require\nlayout(local_size_x = 1) in;\n\
        void main() { uint n = gl_WorkGroupID.x; while (n != 7u) n = 5u * n + 1u; EmitMeshTasksEXT(n, 1u, 1u); }\n";
    let source = Source::memory([("m.task", text)]);
    let words = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.task".into()).result.unwrap();
    let mut bounded = Module::parse(&specialize(&words, &[])).unwrap();
    assert!(bound(&mut bounded, &words, &Bounds { mark: None, ..BOUNDS }));
    let all: Vec<Instruction> = bounded.code().collect();
    let place = |op: Op| all.iter().position(|found| found.op == op);
    assert!(place(Op::AtomicCompareExchange) < place(Op::EmitMeshTasksEXT), "{all:?}");
    assert_eq!(all.iter().filter(|i| i.op == Op::AtomicCompareExchange).count(), 1);
    let bounded = bounded.write();
    assert_eq!(crate::shader::spirv::optimize(bounded.clone()), bounded, "the optimizer leaves it as it is");
}
