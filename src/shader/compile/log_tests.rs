//! The log parser against what the compiler really prints.

use super::*;
use crate::shader::compile::{Compiled, Compiler};
use crate::shader::source::Source;

fn compile(files: &[(&str, &str)]) -> Compiled {
    let source = Source::memory(files.iter().copied());
    Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into())
}

/// The first lines of all errors of a fragment shader, and the text above each caret.
fn errors(text: &str) -> Vec<(String, String)> {
    let errors = compile(&[("m.frag", text)]).result.expect_err("must not compile");
    errors.iter().map(|error| (error.one_line(), marked(error))).collect()
}

fn marked(error: &Diagnostic) -> String {
    let (Some(column), Some(excerpt)) = (error.column, &error.excerpt) else { return String::new() };
    excerpt.chars().skip(column as usize - 1).take(error.length as usize).collect()
}

#[track_caller]
fn expect(text: &str, expected: &[(&str, &str)]) {
    let found = errors(text);
    let found: Vec<(&str, &str)> = found.iter().map(|(line, token)| (line.as_str(), token.as_str())).collect();
    assert_eq!(found, expected);
}

#[test]
fn tokens_are_marked() {
    let head = "#version 460\nlayout(location=0) out vec4 o;\n";
    expect(
        &format!("{head}void main() {{\n\to = vec4(foo);\n}}"),
        &[("m.frag:4:11: error: 'foo' : undeclared identifier", "foo")],
    );
    expect(
        &format!("{head}/* ä\n * b */ void main() {{\r\n  /* é */ o = v;\r\n}}"),
        &[("m.frag:5:15: error: 'v' : undeclared identifier", "v")],
    );
    let conversion = "cannot convert from 'vec3' to 'vec4'";
    expect(
        &format!("{head}void main() {{ if (1 == 1) o = vec3(1.0); }}"),
        &[(&format!("m.frag:3:29: error: 'assign' : {conversion}"), "=")],
    );
    // Neither is the shorter constructor.
    expect(
        &format!("{head}void main() {{ o = vec4(foo, 1.0); }}"),
        &[("m.frag:3:24: error: 'foo' : undeclared identifier", "foo")],
    );
    // Neither is the whole struct that stands for an unknown member.
    expect(
        &format!("{head}struct S {{ vec3 normal; }};\nvoid main() {{ S s; s.nrmal = 0.1; o = vec4(s.normal, 1.0); }}"),
        &[("m.frag:4:22: error: 'nrmal' : no such field in structure 's'", "nrmal")],
    );
    // The conversion of the made-up result is not reported a second time.
    expect(
        &format!("{head}void main() {{ o = mix(vec3(1.0), 2, 3); }}"),
        &[("m.frag:3:19: error: 'mix' : no matching overloaded function found", "mix")],
    );
    expect(
        "#version 460\nfloat f() { }\nvoid main() {}",
        &[("m.frag:2:7: error: function does not return a value: f", "f")],
    );
}

#[test]
fn syntax_errors_speak_glsl_and_find_the_missing_semicolon() {
    let text = "#version 460\nvoid main() {\n  float a = 1.0 // here\n\n  a = 2.0;\n}";
    expect(text, &[("m.frag:5:3: error: syntax error, unexpected a name, expecting ',' or ';'", "a")]);
    let error = &compile(&[("m.frag", text)]).result.unwrap_err()[0];
    assert_eq!(error.help.as_deref(), Some("line 3 does not end with ';'"));
    let text = "#version 460\nvoid main() {\n  float a = 1.0\n}";
    expect(text, &[("m.frag:4:1: error: syntax error, unexpected '}', expecting ',' or ';'", "}")]);
    let text = "#version 460\nvoid main() { float a, b; float c = a b; }";
    expect(text, &[("m.frag:2:39: error: syntax error, unexpected a name, expecting ',' or ';'", "b")]);
    let text = "#version 460\nvoid main() { float a = 1.0 2.0; }";
    expect(text, &[("m.frag:2:29: error: syntax error, unexpected a number, expecting ',' or ';'", "2.0")]);
    let text = "#version 460\nvoid main() { float out = 1.0; }";
    expect(text, &[("m.frag:2:21: error: syntax error, unexpected 'out', expecting ',' or ';'", "out")]);
    expect("#version 460\nvoid main() {\n", &[("m.frag:3: error: syntax error, unexpected end of file", "")]);
}

#[test]
fn errors_in_includes_name_the_included_file() {
    let files = [
        ("m.frag", "#version 460\n#include \"a.glsl\"\nvoid main() {}\n"),
        ("a.glsl", "/* x\n y */ #include \"d/b.glsl\"\nint fa() { return b_; }"),
        ("d/b.glsl", "\r\n\tfloat f = undefined_; // ä\r\n"),
    ];
    let errors = compile(&files).result.unwrap_err();
    let lines: Vec<String> = errors.iter().map(Diagnostic::one_line).collect();
    assert_eq!(
        lines,
        [
            "d/b.glsl:2:12: error: 'undefined_' : undeclared identifier",
            "a.glsl:3:19: error: 'b_' : undeclared identifier"
        ]
    );
}

#[test]
fn include_errors_mark_the_name() {
    let text = "#version 460\n#include <lib/x.glsl>\nvoid main() {}";
    expect(text, &[("m.frag:2:11: error: \"lib/x.glsl\" not found; looked for lib/x.glsl", "lib/x.glsl")]);
    let files = [("m.frag", "#version 460\n#include \"a.glsl\"\nvoid main() {}"), ("a.glsl", "#include \"a.glsl\"\n")];
    let errors = compile(&files).result.unwrap_err();
    assert_eq!(errors[0].one_line(), "a.glsl:1:11: error: include cycle: a.glsl -> a.glsl");
    let deep: Vec<(String, String)> = (0..40)
        .map(|i| (format!("{i}.glsl"), format!("#include \"{}.glsl\"\n", i + 1)))
        .chain([("m.frag".to_owned(), "#version 460\n#include \"0.glsl\"\nvoid main() {}".to_owned())])
        .collect();
    let deep: Vec<(&str, &str)> = deep.iter().map(|(path, text)| (path.as_str(), text.as_str())).collect();
    let errors = compile(&deep).result.unwrap_err();
    assert!(errors[0].message.starts_with("includes nest deeper than 32: m.frag -> 0.glsl"), "{}", errors[0]);
}

#[test]
fn errors_of_the_whole_stage() {
    expect(
        "#version 460\nint a;",
        &[("m.frag:1: error: Missing entry point: Each stage requires one entry point", "")],
    );
    expect(
        "void main() {}",
        &[("m.frag:1: error: #version: Desktop shaders for Vulkan SPIR-V require version 140 or higher", "")],
    );
    expect("#version 999\nvoid main() {}", &[("m.frag:1: error: version not supported", "")]);
    let text = "#version 460\nfloat f(float x); void main() { f(1.0); }";
    let error = &compile(&[("m.frag", text)]).result.unwrap_err()[0];
    assert_eq!(error.one_line(), "m.frag:2:7: error: No function definition (body) found");
    assert_eq!(error.notes, ["f(f1;"]);
}

#[test]
fn letters_outside_ascii() {
    expect(
        "#version 460\nvoid main() { /* ö */ float ä = 1.0; }",
        &[("m.frag:2:29: error: 'ä' : GLSL allows only ASCII characters outside comments", "ä")],
    );
}

#[test]
fn warnings_do_not_fail() {
    let compiled = compile(&[("m.frag", "#version 460\n#extension GL_FOO_bar : enable\nvoid main() {}")]);
    assert!(compiled.result.is_ok());
    let lines: Vec<String> = compiled.warnings.iter().map(Diagnostic::one_line).collect();
    assert_eq!(lines, ["m.frag:2:1: warning: '#extension' : extension not supported: GL_FOO_bar"]);
}

#[test]
fn an_unknown_name_is_answered_with_the_nearest() {
    let head = "#version 460\n#include \"a.glsl\"\nlayout(location=0) out vec4 o;\nvoid main() {\n    Hit hit;\n";
    let library = "struct Hit { vec3 normal_ws; };\nfloat gain_of(float x) { return x; }\n";
    for (line, expected) in [
        ("o = vec4(hti.normal_ws, 1.0);", Some("did you mean `hit`?")),
        ("o = vec4(gain_fo(1.0));", Some("did you mean `gain_of`?")),
        ("o = vec4(smothstep(0.0, 1.0, 0.5));", Some("did you mean `smoothstep`?")),
        ("o = vec4(hit.nrmal_ws, 1.0);", Some("did you mean `normal_ws`?")),
        ("o = vec4(entirely_different);", None),
        // The name is right, but not its arguments.
        ("o = vec4(mix(vec3(1.0), 2, 3), 1.0);", None),
    ] {
        let text = format!("{head}    {line}\n}}\n");
        let errors = compile(&[("m.frag", &text), ("a.glsl", library)]).result.expect_err("must not compile");
        assert_eq!(errors[0].help.as_deref(), expected, "{line}: {}", errors[0]);
    }
}
