//! Updates of trees in memory.

use super::*;
use crate::shader::source::Tree;

const HEAD: &str = "#version 460\nlayout(location = 0) out vec4 o;\n";

fn library(files: &[(&str, &str)], stages: &[&str]) -> Library {
    let source = Source::memory(files.iter().copied());
    Library::new(source, Arc::new(Compiler::new().unwrap()), stages)
}

/// Writes a file (or removes it, with `None`) and updates with that path only.
fn edit(library: &mut Library, path: &str, text: Option<&str>) -> Update {
    let mut source = (*library.source).clone();
    let Tree::Memory(files) = &mut source.tree else { panic!("memory") };
    match text {
        Some(text) => files.insert(path.into(), text.to_owned()),
        None => files.remove(&path.into()),
    };
    library.source = Arc::new(source);
    library.update(&Change::Paths(BTreeSet::from([path.into()])))
}

fn compiled(update: &Update) -> Vec<&str> {
    let (Update::Ready(_, report) | Update::Failed(_, report)) = update else { return Vec::new() };
    report.stages.iter().map(|(name, _)| name.as_str()).collect()
}

fn failed(update: &Update) -> Vec<String> {
    let Update::Failed(diagnostics, _) = update else { panic!("expected a failure, found {update:?}") };
    diagnostics.iter().map(Diagnostic::one_line).collect()
}

fn body(expression: &str) -> String {
    format!("{HEAD}#include \"lib/color.glsl\"\nvoid main() {{ o = vec4({expression}); }}\n")
}

fn two_stages() -> Library {
    let a = body("color()");
    let b = format!("{HEAD}void main() {{ o = vec4(1.0); }}\n");
    let mut library = library(
        &[("a.frag", &a), ("b.frag", &b), ("lib/color.glsl", "float color() { return 0.5; }\n")],
        &["a.frag", "b.frag"],
    );
    let update = library.update(&Change::All);
    assert!(matches!(&update, Update::Ready(set, _) if set.generation == 1), "{update:?}");
    assert_eq!(compiled(&update), ["a.frag", "b.frag"]);
    library
}

#[test]
fn edits_that_wait_for_a_repair_are_named() {
    let mut library = two_stages();
    let notes = |update: &Update| -> Vec<String> {
        let Update::Failed(diagnostics, _) = update else { panic!("expected a failure, found {update:?}") };
        diagnostics.iter().flat_map(|diagnostic| diagnostic.notes.clone()).collect()
    };
    // An edit of comments has nothing to wait for.
    edit(&mut library, "lib/color.glsl", Some("// Gray.\nfloat color() { return 0.5; }\n"));
    let broken = edit(&mut library, "b.frag", Some(&format!("{HEAD}void main() {{ o = vec4(1.0) }}\n")));
    assert_eq!(notes(&broken), [""; 0], "nothing else was edited");
    let held = edit(&mut library, "lib/color.glsl", Some("float color() { return 0.6; }\n"));
    assert_eq!(notes(&held), ["other edits wait until this is repaired: lib/color.glsl"]);
    let repaired = edit(&mut library, "b.frag", Some(&format!("{HEAD}void main() {{ o = vec4(1.0); }}\n")));
    assert!(matches!(repaired, Update::Ready(..)), "{repaired:?}");
}

#[test]
fn an_include_rebuilds_only_its_stages() {
    let mut library = two_stages();
    let old = Arc::clone(library.set().unwrap());
    let update = edit(&mut library, "lib/color.glsl", Some("float color() { return 0.6; }\n"));
    assert_eq!(compiled(&update), ["a.frag"]);
    let Update::Ready(set, report) = update else { panic!() };
    assert_eq!(report.changed, ["lib/color.glsl"]);
    assert_eq!(set.generation, 2);
    assert!(Arc::ptr_eq(&set.stages["b.frag"], &old.stages["b.frag"]));
    assert!(!Arc::ptr_eq(&set.stages["a.frag"], &old.stages["a.frag"]));
}

#[test]
fn a_broken_edit_keeps_the_set_and_taking_it_back_costs_no_compile() {
    let mut library = two_stages();
    let good = Arc::clone(library.set().unwrap());
    let update = edit(&mut library, "lib/color.glsl", Some("float color() { return x; }\n"));
    assert_eq!(failed(&update), ["lib/color.glsl:1:24: error: 'x' : undeclared identifier"]);
    assert!(Arc::ptr_eq(library.set().unwrap(), &good));
    let update = edit(&mut library, "lib/color.glsl", Some("float color() { return 0.5; }\n"));
    assert!(matches!(update, Update::Unchanged { cleared: true }), "{update:?}");
    assert!(Arc::ptr_eq(library.set().unwrap(), &good));
    let update = library.update(&Change::All);
    assert!(matches!(update, Update::Unchanged { cleared: false }), "{update:?}");
}

#[test]
fn the_reload_key_compiles_everything_and_keeps_what_is_equal() {
    let mut library = two_stages();
    let good = Arc::clone(library.set().unwrap());
    failed(&edit(&mut library, "b.frag", Some("broken")));
    let update = library.update(&Change::All);
    assert_eq!(compiled(&update), ["a.frag", "b.frag"]);
    let update = edit(&mut library, "b.frag", Some(&format!("{HEAD}void main() {{ o = vec4(0.3); }}\n")));
    let Update::Ready(set, _) = update else { panic!("{update:?}") };
    assert!(Arc::ptr_eq(&set.stages["a.frag"], &good.stages["a.frag"]));
}

#[test]
fn the_reload_key_keeps_stages_that_were_linked() {
    let mut library = two_stages();
    let update = edit(&mut library, "lib/color.glsl", Some("float color() { float c = 0.6; return c; }\n"));
    let Update::Ready(edited, _) = update else { panic!("{update:?}") };
    assert!(matches!(library.update(&Change::All), Update::Unchanged { cleared: false }));
    assert!(Arc::ptr_eq(library.set().unwrap(), &edited));
}

#[test]
fn all_or_nothing_and_what_compiled_is_remembered() {
    let mut library = two_stages();
    failed(&edit(&mut library, "b.frag", Some("#version 460\nvoid main() { nope }\n")));
    // A good edit next to a broken one is compiled, but does not give a new set.
    let update = edit(&mut library, "lib/color.glsl", Some("float color() { return 0.7; }\n"));
    assert_eq!(compiled(&update), ["a.frag"]);
    failed(&update);
    let update = edit(&mut library, "b.frag", Some(&format!("{HEAD}void main() {{ o = vec4(0.1); }}\n")));
    assert_eq!(compiled(&update), ["b.frag"]);
    assert!(matches!(&update, Update::Ready(set, _) if set.generation == 2), "{update:?}");
}

#[test]
fn unrelated_files_and_comments_build_nothing() {
    let mut library = two_stages();
    assert!(matches!(edit(&mut library, "4913", Some("x")), Update::Unchanged { cleared: false }));
    let update = edit(&mut library, "lib/color.glsl", Some("// why\nfloat color() { return 0.5; }\n"));
    assert!(matches!(update, Update::Unchanged { cleared: false }), "{update:?}");
    failed(&edit(&mut library, "b.frag", Some("broken")));
    assert!(matches!(edit(&mut library, "4914", Some("x")), Update::Unchanged { cleared: false }));
}

#[test]
fn an_edit_of_comments_compiles_no_stage_and_is_remembered() {
    let mut library = two_stages();
    let first = Arc::clone(&library.set().unwrap().stages["a.frag"]);
    let text = |comment: &str| {
        format!("// {comment}\nfloat color() {{ return 0.5; }}\n//@mode a \"{comment}\"\nconst uint MODE_A = 3u;\n")
    };
    edit(&mut library, "lib/color.glsl", Some(&text("one")));
    let before = Arc::clone(&library.set().unwrap().stages["a.frag"]);
    let update = edit(&mut library, "lib/color.glsl", Some(&text("two")));
    assert_eq!(compiled(&update), [""; 0]);
    let Update::Ready(set, _) = update else { panic!("{update:?}") };
    assert_eq!(set.modes[0].name, "two");
    assert!(Arc::ptr_eq(&set.stages["a.frag"], &before));
    assert_eq!(first.specialized_hash(&[]), before.specialized_hash(&[]));
    // The next edit of a function is compared with the newest text.
    let update = edit(&mut library, "lib/color.glsl", Some(&text("three").replace("0.5", "0.6")));
    assert_eq!(compiled(&update), ["a.frag"]);
}

/// The diagnostics of an edit are those of the same text in a library that has not seen any other.
#[test]
fn messages_are_those_of_the_whole_stage() {
    let files = |color: &str| {
        let a = format!(
            "{HEAD}#extension GL_EXT_control_flow_attributes : warn\n#include \"lib/color.glsl\"\n\
            void main() {{ o = vec4(color() + other()); }}\n"
        );
        [("a.frag", a), ("lib/color.glsl", format!("float other() {{\n    return 0.25;\n}}\n/* x */ {color}\n"))]
    };
    let texts = |color: &str| files(color).map(|(path, text)| (TreePath::from(path), text));
    let good = "float color() {\n    float c = 0.5;\n    return c;\n}";
    let new = |color: &str| {
        Library::new(Source::of_texts(texts(color).into()), Arc::new(Compiler::new().unwrap()), &["a.frag"])
    };
    let messages = |update: Update| match update {
        Update::Ready(set, _) => set.warnings.iter().map(Diagnostic::render).collect::<Vec<_>>(),
        Update::Failed(diagnostics, _) => diagnostics.iter().map(Diagnostic::render).collect(),
        Update::Unchanged { .. } => Vec::new(),
    };
    for (from, to, count) in [
        ("return c;", "return c + 1.0;", 0),
        ("return c;", "\n    /* e */ return unknown;", 1),
        ("return c;", "float d = c\n    return d;", 1),
        ("return c;", "[[unroll]] for (int i = 0; i < 3; ++i) c += 1.0;\n    return c;", 1),
        ("    return c;\n", "", 1),
    ] {
        let mut library = new(good);
        assert_eq!(messages(library.update(&Change::All)), [""; 0]);
        let color = good.replacen(from, to, 1);
        let found = messages(edit(&mut library, "lib/color.glsl", Some(&texts(&color)[1].1)));
        assert_eq!(found, messages(new(&color).update(&Change::All)), "{color}");
        assert_eq!(found.len(), count, "{found:#?}");
    }
}

#[test]
fn a_missing_include_is_found_when_it_appears() {
    let a = body("color()");
    let mut library = library(&[("sub/a.frag", &a)], &["sub/a.frag"]);
    let update = library.update(&Change::All);
    assert!(
        failed(&update)[0].contains("\"lib/color.glsl\" not found; looked for sub/lib/color.glsl and lib/color.glsl")
    );
    assert!(library.dependencies().contains(&"sub/lib/color.glsl".into()));
    let update = edit(&mut library, "lib/color.glsl", Some("float color() { return 0.5; }\n"));
    assert!(matches!(update, Update::Ready(..)), "{update:?}");
    // A new file at a path that is searched earlier takes precedence.
    let update = edit(&mut library, "sub/lib/color.glsl", Some("float color() { return 0.9; }\n"));
    assert!(matches!(update, Update::Ready(..)), "{update:?}");
    let update = edit(&mut library, "sub/a.frag", None);
    assert_eq!(failed(&update), ["sub/a.frag: error: sub/a.frag does not exist"]);
}

#[test]
fn annotations_are_part_of_the_transaction() {
    let mut library = two_stages();
    let text = |mode: &str| format!("float color() {{ return 0.5; }}\n{mode}\nconst uint MODE_A = 3u;\n");
    let update = edit(&mut library, "lib/color.glsl", Some(&text("//@mode a \"A\"")));
    let Update::Ready(set, _) = update else { panic!("{update:?}") };
    assert_eq!((set.modes.len(), set.modes[0].id), (1, 3));
    let update = edit(&mut library, "lib/color.glsl", Some(&text("//@mode a A")));
    assert_eq!(failed(&update), ["lib/color.glsl:2:11: error: expected the mode's name in quotes, found `A`"]);
    assert!(matches!(edit(&mut library, "4913", Some("x")), Update::Unchanged { cleared: false }));
    let update = edit(&mut library, "lib/color.glsl", Some(&text("//@mode a \"B\"")));
    let Update::Ready(set, _) = update else { panic!("{update:?}") };
    assert_eq!(set.modes[0].name, "B");
}

#[test]
fn pairs_and_the_contract_are_checked() {
    let vertex =
        "#version 460\nlayout(location = 0) out vec3 n;\nvoid main() { n = vec3(0); gl_Position = vec4(0); }\n";
    let fragment = format!("{HEAD}layout(location = 0) in vec2 n;\nvoid main() {{ o = n.xyxy; }}\n//@pass p\n");
    let mut library = library(&[("p.vert", vertex), ("p.frag", &fragment)], &["p.vert", "p.frag"]);
    let update = library.update(&Change::All);
    let expected = "p.frag:3:30: error: p.frag reads `vec2 n` at location 0, p.vert writes `vec3 n` there";
    assert_eq!(failed(&update), [expected]);
    let fragment = fragment.replace("vec2 n", "vec3 n").replace("n.xyxy", "n.xyzx");
    assert!(matches!(edit(&mut library, "p.frag", Some(&fragment)), Update::Ready(..)));
    let extra =
        format!("{HEAD}layout(set = 5, binding = 0) uniform sampler2D t;\nvoid main() {{ o = vec4(0); }}\n//@pass p\n");
    let update = edit(&mut library, "p.frag", Some(&extra));
    assert!(failed(&update)[0].contains("Specula has nothing there"));
}

#[test]
fn trees_of_another_version_are_refused() {
    let mut library = two_stages();
    let update = edit(&mut library, "interface.glsl", Some("const uint INTERFACE_VERSION = 77u;\n"));
    assert!(failed(&update)[0].contains("interface.glsl:1: error: this tree was written for interface version 77"));
    let update = edit(&mut library, "interface.glsl", None);
    assert!(matches!(update, Update::Unchanged { cleared: true }), "{update:?}");
}

#[test]
fn the_same_error_in_two_stages_is_one() {
    let a = body("color()");
    let mut library =
        library(&[("a.frag", &a), ("b.frag", &a), ("lib/color.glsl", "flot x;\n")], &["a.frag", "b.frag"]);
    let errors = failed(&library.update(&Change::All));
    assert!(errors[0].starts_with("lib/color.glsl:1:"), "{errors:#?}");
    assert_eq!(errors.iter().filter(|line| line.starts_with("lib/")).count(), 1, "{errors:#?}");
}

#[test]
fn the_embedded_tree_is_sound() {
    let source = Source::embedded();
    let stages: Vec<String> = source
        .list()
        .iter()
        .filter(|path| crate::shader::StageKind::of(path).is_some())
        .map(TreePath::to_string)
        .collect();
    let stages: Vec<&str> = stages.iter().map(String::as_str).collect();
    let mut library = Library::new(source, Arc::new(Compiler::new().unwrap()), &stages);
    let found: Vec<String> = super::super::check::check(&mut library).iter().map(Diagnostic::render).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
