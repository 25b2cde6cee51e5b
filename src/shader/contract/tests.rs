//! The contract check on compiled modules.

use super::*;
use crate::interface::blocks;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;

/// Compiles `text` after an include of `interface` and returns the diagnostics.
fn complaints(interface: &str, text: &str) -> Vec<Diagnostic> {
    let text = format!(
        "#version 460\n#include \"interface.glsl\"\n{text}\n\
         layout(location = 0) out vec4 o;\nvoid main() {{ o = vec4(0); }}\n"
    );
    complaints_of("m.frag", &[("m.frag", text.as_str()), ("interface.glsl", interface)])
}

/// Compiles a stage and returns its diagnostics.
fn complaints_of(stage: &str, files: &[(&str, &str)]) -> Vec<Diagnostic> {
    let source = Source::memory(files.iter().copied());
    let snapshot = Snapshot::new(&source);
    let stage = TreePath::from(stage);
    let compiled = Compiler::new().unwrap().compile(&snapshot, &stage);
    let reflection = Reflection::of(&compiled.result.unwrap());
    check(&reflection, Texts { snapshot: &snapshot, stage: &stage, dependencies: &compiled.dependencies })
}

#[track_caller]
fn expect(text: &str, expected: &str) {
    let found: Vec<String> = complaints(&interface::glsl(), text).iter().map(Diagnostic::one_line).collect();
    assert_eq!(found, [expected]);
}

#[test]
fn rust_and_glsl_agree_on_every_member() {
    // A struct has offsets only in a block. Structs that `interface.glsl` uses in no block get a block here.
    let is_free = |block: &&interface::Block| block.around[0].starts_with("struct ");
    let buffer = |(binding, block): (usize, &interface::Block)| {
        let name = block.name;
        format!("layout(set = 7, binding = {binding}, scalar) buffer Of{name} {{ {name} of_{binding}[]; }};\n")
    };
    let buffers: String = blocks().filter(is_free).enumerate().map(buffer).collect();
    let text = format!("#version 460\n{}\n{buffers}void main() {{}}\n", interface::glsl());
    let source = Source::memory([("m.frag", text.as_str())]);
    let compiled = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into());
    let reflection = Reflection::of(&compiled.result.unwrap());
    for known in blocks() {
        let block = &reflection.structs[known.name];
        let found: Vec<_> = block.members.iter().map(|member| (member.name.as_str(), member.offset)).collect();
        let expected: Vec<_> = known.members.iter().map(|member| (member.name, member.offset)).collect();
        assert_eq!(found, expected, "{}", known.name);
        assert!(block.size <= known.size && known.size - block.size < 8, "{}: {} bytes", known.name, block.size);
    }
    assert!(complaints(&interface::glsl(), "").is_empty());
}

#[test]
fn bindings() {
    expect(
        "layout(set = 0, binding = 31) uniform Mine { float x; };",
        "m.frag:3:39: error: shader says set 0, binding 31 is uniform block `Mine`, Specula has nothing there",
    );
    expect(
        "layout(set = SET_MATERIAL, binding = BINDING_NORMAL_TEXTURE) uniform samplerCube normals;",
        "m.frag:3:82: error: shader says set 1, binding 3 is samplerCube `normals`, Specula says BINDING_NORMAL_TEXTURE is \
         sampler2D",
    );
    expect(
        "layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params { vec4 x[300]; };",
        "m.frag:3:67: error: shader says `Params` has 4800 bytes, Specula says BINDING_PARAMS has at most 4096",
    );
}

#[test]
fn constants() {
    expect(
        "layout(constant_id = 15) const bool MINE = false;",
        "m.frag:3:37: error: shader says constant_id 15 is `MINE`, Specula keeps the ids below 32 for itself",
    );
    let edited = interface::glsl().replace("const uint ALPHA_MODE = 0u", "const int ALPHA_MODE = 0");
    let found = complaints(&edited, "");
    assert_eq!(found.len(), 1);
    assert!(found[0].message.starts_with("shader says constant_id 1 is `ALPHA_MODE`, Specula says it is `const uint"));
    assert!(complaints(&interface::glsl(), "layout(constant_id = USER_CONSTANTS) const bool OK = true;").is_empty());
}

#[test]
fn a_condition_that_the_compiler_loses_is_told() {
    let text = "#version 460\nlayout(constant_id = 2) const uint FEATURES = 0u;\n\
        const bool BOTH = (FEATURES & 1u) != 0u && (FEATURES & 2u) != 0u;\n\
        layout(location = 0) out vec4 o;\nvoid main() { o = vec4(0); if (gl_FragCoord.x > 1.0 && !BOTH) o = vec4(1); }\n";
    let found = |text: &str| -> Vec<String> {
        complaints_of("m.frag", &[("m.frag", text)]).iter().map(Diagnostic::one_line).collect()
    };
    let expected =
        "m.frag:3:12: error: `BOTH` gets no value: the compiler cannot join comparisons of constants by && or ||";
    assert_eq!(found(text), [expected]);
    // Two functions use the constant, but glslang computes it in the first only.
    let head = "#version 460\nlayout(constant_id = 2) const uint FEATURES = 0u;\n";
    let functions = "layout(location = 0) out vec4 o;\nfloat a() { if (BOTH) return 1.0; return 2.0; }\n\
        float b() { if (BOTH) return 3.0; return 4.0; }\nvoid main() { o = vec4(a() + b()); }\n";
    let joined = "const bool BOTH = (FEATURES & 1u) != 0u && (FEATURES & 2u) != 0u;\n";
    let lost = found(&format!("{head}{joined}{functions}"));
    assert!(lost.len() == 1 && lost[0].contains("gets no value"), "{lost:?}");
    let named =
        "const bool A = (FEATURES & 1u) != 0u;\nconst bool B = (FEATURES & 2u) != 0u;\nconst bool BOTH = A && B;\n";
    assert_eq!(found(&format!("{head}{named}{functions}")), Vec::<String>::new());
    let negated = found(&format!(
        "{head}{}{functions}",
        joined.replace("= (FEATURES & 1u)", "= !((FEATURES & 1u)").replace(";", ");")
    ));
    assert!(negated.len() == 1 && negated[0].contains("gets no value"), "{negated:?}");
}

#[test]
fn edited_structs_are_refused_by_member() {
    let cases = [
        ("    float exposure;", "    //", "shader says `Frame.ambient` is at byte 204, Specula says 208"),
        ("    uint kind;", "    uint sort;", "shader says `Light.sort` is at byte 28, Specula has `kind` at 28 there"),
        ("    vec2 uv1;", "    //", "shader says `Vertex.color` is at byte 48, Specula says 56"),
        (
            "    float normal_scale;",
            "    vec2 normal_scale;",
            "shader says `Material.occlusion_strength` is at byte 44",
        ),
        ("    mat3 normal_ws_from_object;", "    //", "shader says `Draw.attributes` is at byte 56, Specula says 92"),
    ];
    for (from, to, expected) in cases {
        let edited = interface::glsl().replace(from, to);
        assert_ne!(edited, interface::glsl());
        let found = complaints(&edited, "");
        let lines: Vec<String> = found.iter().map(Diagnostic::one_line).collect();
        assert!(lines.iter().any(|line| line.starts_with("interface.glsl:") && line.contains(expected)), "{lines:#?}");
    }
    let longer = interface::glsl().replace("    uint node_id;", "    uint node_id; mat4 more;");
    assert!(complaints(&longer, "").iter().any(|found| found.message.contains("Specula says at most 128")));
}

#[track_caller]
fn expect_stage(stage: &str, text: &str, expected: &[&str]) {
    let text = format!("#version 460\n{text}\n");
    let found: Vec<String> = complaints_of(stage, &[(stage, &text)]).iter().map(Diagnostic::one_line).collect();
    assert_eq!(found, expected);
}

#[test]
fn vertices_come_by_address_alone() {
    let error = "m.vert:2:31: error: shader reads `vec3 position` at location 0, Specula has no vertex buffers: \
                 vertices are read by address";
    let body = "void main() { gl_Position = vec4(position, 1); }";
    expect_stage("m.vert", &format!("layout(location = 0) in  vec3 position;\n{body}"), &[error]);
    expect_stage("m.vert", "void main() { gl_Position = vec4(gl_VertexIndex); }", &[]);
}

#[test]
fn a_fragment_stage_writes_one_color() {
    let out = "Specula has `layout(location = 0) out vec4` alone";
    let write = |declared: &str, body: &str, expected: &[&str]| {
        expect_stage("m.frag", &format!("{declared}\nvoid main() {{ {body} }}"), expected);
    };
    write("layout(location = 0) out vec4 o;", "o = vec4(0);", &[]);
    write("layout(location = 0) out vec4 o;", "", &[]);
    write(
        "layout(location = 0) out vec3 o;",
        "o = vec3(0);",
        &[&format!("m.frag:2:31: error: shader writes `vec3 o` at location 0, {out}")],
    );
    write(
        "layout(location = 0) out vec4 o; layout(location = 1) out uint id;",
        "o = vec4(0); id = 1;",
        &[&format!("m.frag:2:64: error: shader writes `uint id` at location 1, {out}")],
    );
    write(
        "layout(location = 0) out uvec4 o;",
        "o = uvec4(0);",
        &[&format!("m.frag:2:32: error: shader writes `uvec4 o` at location 0, {out}")],
    );
    write("", "", &["m.frag:3:6: error: shader writes no color, Specula draws to `layout(location = 0) out vec4`"]);
}

#[test]
fn features_that_are_not_enabled_are_named() {
    let cases = [
        ("double d = o.x; o = vec4(float(d * d));", "Float64", "m.frag:5:"),
        ("o = vec4(float(int64_t(o.x) * 3));", "Int64", "m.frag:5:30:"),
        ("float16_t h = float16_t(o.x); o = vec4(float(h * h));", "Float16", "m.frag:5:15:"),
        ("o = vec4(interpolateAtOffset(x, vec2(0.1)));", "InterpolationFunction", "m.frag:5:24:"),
        ("o = vec4(subgroupAdd(1.0));", "GroupNonUniformArithmetic", "m.frag:5:24:"),
        ("o = vec4(float(gl_PrimitiveID), dFdxFine(o.y), 0, 0);", "", ""),
        ("o = vec4(float(gl_SampleID));", "", ""),
        ("if (o.x > 0.5) discard;", "", ""),
    ];
    let extensions = "#extension GL_EXT_shader_explicit_arithmetic_types : require\n\
                      #extension GL_KHR_shader_subgroup_arithmetic : require\n";
    for (body, feature, place) in cases {
        let head = "layout(location = 0) out vec4 o; layout(location = 0) in float x;";
        let text = format!("#version 460\n{extensions}{head}\nvoid main() {{ {body} }}\n");
        let found: Vec<String> =
            complaints_of("m.frag", &[("m.frag", &text)]).iter().map(Diagnostic::one_line).collect();
        match found.as_slice() {
            [] => assert_eq!(feature, "", "{body}"),
            [only] => {
                assert!(only.contains(place) && only.contains(&format!("the device feature {feature} (")), "{only}")
            }
            more => panic!("{more:#?}"),
        }
    }
}

#[test]
fn variables_that_no_driver_can_keep_are_named() {
    for (body, found) in [
        ("float a[65536]; a[int(x)] = x; o = vec4(a[3]);", ""),
        ("float a[65537]; a[int(x)] = x; o = vec4(a[3]);", "`a` has 257 KiB in each invocation, at most 256 KiB fit"),
        ("float b[100000][1000]; b[1][int(x)] = x; o = vec4(b[1][2]);", "`b` has 390625 KiB"),
        ("Many c; c.m[2].v[int(x)] = x; o = vec4(c.m[1].v[2]);", "`c` has 4000 KiB"),
        ("d[int(x)] = x; o = vec4(d[2]);", "`d` has 391 KiB"),
    ] {
        let head = "layout(location = 0) out vec4 o; layout(location = 0) in float x;\nfloat d[100000];\n\
                    struct One { float v[1024]; }; struct Many { One m[1000]; };";
        let head = if found.contains("`d`") { head.to_owned() } else { head.replace("float d[100000];", "") };
        let text = format!("#version 460\n{head}\nvoid main() {{ {body} }}\n");
        let told: Vec<String> =
            complaints_of("m.frag", &[("m.frag", &text)]).iter().map(Diagnostic::one_line).collect();
        assert_eq!(told.is_empty(), found.is_empty(), "{body}: {told:?}");
        assert!(told.iter().all(|line| line.contains(found) && line.starts_with("m.frag:")), "{body}: {told:?}");
    }
}

#[test]
fn stages_of_a_pair() {
    let vertex = "#version 460\nlayout(location = 0) out vec3 a; layout(location = 1) out vec2 b;\n\
                  void main() { a = vec3(0); b = vec2(0); gl_Position = vec4(0); }";
    let fragment = "#version 460\nlayout(location = 0) in vec3 a;\nlayout(location = 1) in vec3 b;\nlayout(location = 2) in float c;\n\
                    layout(location = 0) out vec4 o;\nvoid main() { o = vec4(a + b, c); }";
    let source = Source::memory([("m.vert", vertex), ("m.frag", fragment)]);
    let snapshot = Snapshot::new(&source);
    let compiler = Compiler::new().unwrap();
    let paths = [TreePath::from("m.vert"), TreePath::from("m.frag")];
    let compiled = paths.each_ref().map(|path| compiler.compile(&snapshot, path));
    let reflections = compiled.each_ref().map(|compiled| Reflection::of(compiled.result.as_ref().unwrap()));
    let texts =
        |index: usize| Texts { snapshot: &snapshot, stage: &paths[index], dependencies: &compiled[index].dependencies };
    let found = check_pair((&reflections[0], texts(0)), (&reflections[1], texts(1)));
    let lines: Vec<String> = found.iter().map(Diagnostic::one_line).collect();
    assert_eq!(
        lines,
        [
            "m.frag:3:30: error: m.frag reads `vec3 b` at location 1, m.vert writes `vec2 b` there",
            "m.frag:4:31: error: m.frag reads `float c` at location 2, m.vert writes nothing there",
        ]
    );
}

#[test]
fn trees_of_other_versions_are_named() {
    let check = |text: &str| {
        let source = Source::memory([("interface.glsl", text)]);
        interface_matches(&Snapshot::new(&source))
    };
    let current = interface::glsl();
    assert_eq!(check(&current), None);
    assert_eq!(check(&current.replace('\n', "\r\n")), None);
    let version = format!("INTERFACE_VERSION = {}u", interface::VERSION);
    let other = check(&current.replace(&version, "INTERFACE_VERSION = 99u")).unwrap();
    assert!(other.one_line().contains("error: this tree was written for interface version 99"), "{other}");
    let comment = check(&current.replace("// LIGHT_*.", "// mine")).unwrap();
    assert_eq!(comment.severity, crate::shader::Severity::Warning);
    assert!(check("// nothing").unwrap().message.contains("no INTERFACE_VERSION"));
}
