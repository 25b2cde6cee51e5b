use super::*;

/// The text of a file after the calls were inserted, with `T` for the name of the function.
fn traced(body: &str) -> String {
    let file = format!("struct S {{ float a; vec2 b, c[2]; }};\nS make() {{ return S(1.0, vec2(0.0)); }}\n{body}\n");
    let host = "#version 460\n#include \"a.glsl\"\nlayout(location = 0) in vec3 n;\nout vec4 color;\nvoid main() { color = vec4(n, 1.0); }\n";
    let source = Source::memory([("pbr.frag", host), ("a.glsl", file.as_str())]);
    let found = Instrumented::new(&Snapshot::new(&source), &"pbr.frag".into(), &BTreeSet::new()).unwrap();
    let text = found.texts[&TreePath::from("a.glsl")].replace(FUNCTION, "T");
    text.lines().skip(2).collect::<Vec<_>>().join("\n")
}

#[test]
fn values_pass_through_the_function() {
    for (body, expected) in [
        ("float f(float x) { return x; }", "float f(float x) { return T(2u, x); }"),
        ("int f() { return 1; }", "int f() { return 1; }"),
        ("void f() { float a = 1.0 / 0.0, b; }", "void f() { float a = T(2u, 1.0 / 0.0), b; }"),
        ("void f() { const float a = 1.0; }", "void f() { const float a = 1.0; T(2u, a); }"),
        ("void f(vec3 x) { x.yz *= g(x, 1); }", "void f(vec3 x) { T(2u, x.yz *= g(x, 1)); }"),
        ("void f(vec3 x) { if (x.y == 1.0) x[2] += 1.0; }", "void f(vec3 x) { if (x.y == 1.0) T(2u, x[2] += 1.0); }"),
        (
            // Elements of arrays are not traced: they may be structs.
            "void f() { S s = make(); s.a = 1.0; s.c = d; s.c[0] = b; }",
            "void f() { S s = make(); T(2u, s.a = 1.0); s.c = d; s.c[0] = b; }",
        ),
        (
            "void f(inout S s) { s = S(2.0, b); s = make(); g(s); }",
            "void f(inout S s) { T(2u, s = S(2.0, b)); s = make(); g(s); }",
        ),
        (
            "void f() { float a[2] = float[](1.0, 2.0); a = b; a[1] = c; }",
            "void f() { float a[2] = float[](1.0, 2.0); a = b; a[1] = c; }",
        ),
        (
            "void f() { for (float t = 0.0; t < 1.0; t += 0.1) x *= y; }",
            "void f() { for (float t = 0.0; t < 1.0; t += 0.1) T(2u, x *= y); }",
        ),
    ] {
        assert_eq!(traced(body), expected);
    }
}

#[test]
fn sites_have_the_place_and_the_code() {
    let file = "float f(float x) {\n    float y = x // half\n        * 0.5;\n    return y;\n}\n";
    let host =
        "#version 460\n#include \"a.glsl\"\nin vec3 n;\nout vec4 color;\nvoid main() { color = vec4(n, 1.0); }\n";
    let source = Source::memory([("pbr.frag", host), ("a.glsl", file)]);
    let found = Instrumented::new(&Snapshot::new(&source), &"pbr.frag".into(), &BTreeSet::new()).unwrap();
    let sites: Vec<String> =
        found.sites.iter().map(|site| format!("{}:{}:{}: {}", site.file, site.line, site.column, site.code)).collect();
    assert_eq!(
        sites,
        [
            "a.glsl:2:15: float y = x * 0.5;",
            "a.glsl:4:12: return y;",
            "pbr.frag:5:15: color = vec4(n, 1.0);",
            "pbr.frag:3:1: in vec3 n;",
        ]
    );
    let stage = &found.texts[&TreePath::from("pbr.frag")];
    assert!(stage.starts_with("#version 460\n#include \".not_finite.glsl\"\n"), "{stage}");
    assert!(
        stage.contains("void traced_main() { trace_finite(4u, n); trace_finite(3u, color = vec4(n, 1.0));"),
        "{stage}"
    );
    let without = BTreeSet::from([("a.glsl".to_owned(), 3)]);
    let found = Instrumented::new(&Snapshot::new(&source), &"pbr.frag".into(), &without).unwrap();
    assert_eq!(found.sites[0].line, 4);
}
