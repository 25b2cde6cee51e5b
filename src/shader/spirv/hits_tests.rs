//! Tests of the copies for hits, on modules that glslang compiles.

use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::optimize;

fn separated(words: &[u32]) -> Vec<u32> {
    let mut module = Module::parse(words).unwrap();
    separate_hits(&mut module);
    module.write()
}

fn compiled(functions: &str) -> Vec<u32> {
    let text = format!(
        "#version 460\nlayout(set = 1, binding = 0) uniform sampler2D image;\nlayout(location = 0) in vec2 uv;\n
         layout(location = 0) out vec4 color;\nbool is_discarded_at_hit = false;\n{functions}"
    );
    let source = Source::memory([("m.frag", text.as_str())]);
    Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap()
}

fn count(words: &[u32], wanted: Op) -> usize {
    let module = Module::parse(words).unwrap();
    let heads = module.functions.iter().flat_map(Function::instructions);
    heads.filter(|i| i.op == wanted).count()
}

const HOOK: &str = "
    vec4 pattern(vec2 at) { return texture(image, at, 1.0) + textureOffset(image, at, ivec2(1)) + vec4(fwidth(at.x)); }
    bool holed(vec2 at) { if (at.x > 0.5) discard; return at.y > 0.5; }
    void hook(inout vec4 s, vec2 at) { if (holed(at)) s += pattern(at); if (at.y < 0.1) discard; }
    vec4 hooked_surface(vec2 at) { vec4 s = vec4(0.0); hook(s, at); return s; }";

#[test]
fn hits_get_copies_and_the_rest_stays() {
    let main = "void main() { vec4 s = vec4(0.0); hook(s, uv); color = s;
                for (int i = 0; i < 4; ++i) { color += hooked_surface(uv + float(i)); if (is_discarded_at_hit) break; } }";
    let before = compiled(&format!("{HOOK}\n{main}"));
    let after = separated(&before);
    for (op, copies) in [
        (Op::ImageSampleImplicitLod, 0),
        (Op::ImageSampleExplicitLod, 2),
        (Op::Fwidth, 0),
        (Op::Function, 3),
        (Op::CopyObject, 1),
    ] {
        assert_eq!(count(&after, op), count(&before, op) + copies, "{op:?}");
    }
    for discard in [Op::Kill, Op::TerminateInvocation] {
        assert_eq!(count(&after, discard), count(&before, discard), "the picture discards as before");
    }
    // Nothing that hits call needs neighbors any more, and the module stays valid for the optimizer.
    assert_eq!(separated(&after), after);
    assert!(optimize(after.clone()).len() < after.len());
}

#[test]
fn a_module_that_needs_no_neighbors_stays() {
    let functions = "vec4 hooked_surface(vec2 at) { return textureLod(image, at, 0.0); }
        void main() { color = hooked_surface(uv) + texture(image, uv); }";
    let words = compiled(functions);
    assert_eq!(separated(&words), words);
    let words = compiled("void main() { color = texture(image, uv); if (uv.x > 0.5) discard; }");
    assert_eq!(separated(&words), words);
}
