//! Tests of the copies for hits, on modules that glslang compiles.

use super::*;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::optimize;

fn compiled(functions: &str) -> Vec<u32> {
    let text = format!(
        "#version 460\nlayout(set = 1, binding = 0) uniform sampler2D image;\nlayout(location = 0) in vec2 uv;\n
         layout(location = 0) out vec4 color;\nbool is_discarded_at_hit = false;\n{functions}"
    );
    let source = Source::memory([("m.frag", text.as_str())]);
    Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap()
}

fn count(words: &[u32], wanted: u32) -> usize {
    instructions(words).unwrap().iter().filter(|i| opcode(i) == wanted).count()
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
    let after = separate_hits(before.clone());
    for (opcode, copies) in [(87, 0), (88, 2), (209, 0), (op::FUNCTION, 3), (op::COPY_OBJECT, 1)] {
        assert_eq!(count(&after, opcode), count(&before, opcode) + copies, "opcode {opcode}");
    }
    for discard in [op::KILL, op::TERMINATE_INVOCATION] {
        assert_eq!(count(&after, discard), count(&before, discard), "the picture discards as before");
    }
    // Nothing that hits call needs neighbors any more, and the module stays valid for the optimizer.
    assert_eq!(separate_hits(after.clone()), after);
    assert!(optimize(after.clone()).len() < after.len());
}

#[test]
fn a_module_that_needs_no_neighbors_stays() {
    let functions = "vec4 hooked_surface(vec2 at) { return textureLod(image, at, 0.0); }
        void main() { color = hooked_surface(uv) + texture(image, uv); }";
    let words = compiled(functions);
    assert_eq!(separate_hits(words.clone()), words);
    let words = compiled("void main() { color = texture(image, uv); if (uv.x > 0.5) discard; }");
    assert_eq!(separate_hits(words.clone()), words);
    assert_eq!(separate_hits(vec![1, 2, 3]), [1, 2, 3]);
}
