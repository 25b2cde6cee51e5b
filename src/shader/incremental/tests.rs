//! Compiles edited stages incrementally and as a whole. Both modules must do the same.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::*;
use crate::shader::Source;
use crate::shader::compile::StageKind;
use crate::shader::spirv::loops::Bounds;
use crate::shader::spirv::reflect::Reflection;
use crate::shader::spirv::{behavior_hash, finish, optimize, specialize, validate};
use scan::Function;

type Texts = BTreeMap<TreePath, String>;

fn shipped() -> Texts {
    let source = Source::embedded();
    source.list().into_iter().filter_map(|path| Some((path.clone(), source.read(&path).ok()?))).collect()
}

fn compiler() -> &'static Compiler {
    static COMPILER: std::sync::OnceLock<Compiler> = std::sync::OnceLock::new();
    COMPILER.get_or_init(|| Compiler::new().unwrap())
}

/// A stage and its text.
struct Built {
    spirv: Vec<u32>,
    files: Files,
}

/// Compiles a stage as a whole.
fn whole(texts: &Texts, stage: &TreePath) -> Result<Built, String> {
    let source = Source::of_texts(texts.clone());
    let snapshot = Snapshot::new(&source);
    let compiled = compiler().compile(&snapshot, stage);
    let files = FileCache::default().files(&snapshot, &compiled.dependencies).unwrap();
    compiled.result.map(|spirv| Built { spirv, files }).map_err(|errors| errors[0].one_line())
}

/// Compiles an edited stage incrementally.
fn incremental(texts: &Texts, stage: &TreePath, base: &Built) -> Option<Built> {
    let source = Source::of_texts(texts.clone());
    let snapshot = Snapshot::new(&source);
    let files = FileCache::default().files(&snapshot, base.files.keys()).unwrap();
    match rebuild(compiler(), &snapshot, stage, (&base.spirv, &base.files), &files)? {
        Rebuilt::Same => Some(Built { spirv: base.spirv.clone(), files }),
        Rebuilt::Linked(spirv) => Some(Built { spirv, files }),
    }
}

/// The properties that must be equal: all that the driver and the contract see, with the default and with other
/// constants.
fn meaning(spirv: &[u32]) -> (Reflection, Vec<u64>) {
    let reflection = Reflection::of(spirv);
    let hashes = [None, Some(0), Some(1), Some(2), Some(u32::MAX)].map(|value| {
        let values: Vec<(u32, u32)> = value
            .map(|value| reflection.constants.iter().map(|constant| (constant.id, value)).collect())
            .unwrap_or_default();
        behavior_hash(&specialize(spirv, &values))
    });
    (reflection, [behavior_hash(spirv)].into_iter().chain(hashes).collect())
}

/// Fails unless the module does what that of the whole text does, and is valid, as it is and as a driver gets it.
#[track_caller]
fn assert_same(linked: &[u32], whole: &[u32], what: &str) {
    assert_eq!(validate(linked), Ok(()), "{what}");
    let bounds = Bounds { rounds: 1 << 18, rounds_after: 256, report: None, mark: None };
    let finished = finish(specialize(linked, &[]), linked, &bounds, false);
    assert_eq!(validate(&finished.words), Ok(()), "{what}, finished");
    let ((reflection, hashes), (expected, expected_hashes)) = (meaning(linked), meaning(whole));
    assert_eq!(reflection.reached, expected.reached, "{what}: reached");
    assert_eq!(reflection.params_read, expected.params_read, "{what}: parameters");
    assert!(reflection == expected, "{what}: reflection");
    assert_eq!(hashes, expected_hashes, "{what}: behavior");
}

/// The functions of a stage: path and index in the file.
fn functions(files: &Files) -> Vec<(TreePath, usize)> {
    let of = |(path, file): (&TreePath, &Option<Arc<File>>)| {
        let count = file.as_ref().map_or(0, |file| file.parts().expect("usual text").functions.len());
        (0..count).map(|index| (path.clone(), index)).collect::<Vec<_>>()
    };
    files.iter().flat_map(of).collect()
}

const KINDS: usize = 8;

/// The body of an edited function. `kind` is below [`KINDS`].
fn edited(kind: usize, stage: StageKind, before: &[Function], function: &Function) -> String {
    let statement = match kind {
        0 => "float edit = 0.1234567; ".to_owned(),
        1 => "mat3x2 edit[3]; edit[1][2] = vec2(7.25); ".to_owned(),
        2 => "struct Edit { vec4 a; uint b[2]; }; Edit edit; edit.b[1] = 77u; ".to_owned(),
        3 if stage == StageKind::Fragment => "float edit = fwidthFine(gl_FragCoord.z); ".to_owned(),
        3 if stage == StageKind::Vertex => "int edit = gl_InstanceIndex + 3; ".to_owned(),
        3 => "uint edit = gl_GlobalInvocationID.z * 3u; ".to_owned(),
        // The first use of a member of the frame's block.
        4 => "float edit = asinh(frame.time_s); ".to_owned(),
        // A loop with a condition on a specialization constant
        5 => "int edit = 0; while (edit < 5) { edit += FEATURES == 17u ? 1 : 2; } ".to_owned(),
        // A call of the function before
        6 => match before.last().map(|f| (f, f.parameters.as_ref().expect("usual parameters"))) {
            Some((f, parameters)) => {
                let declared: String = parameters
                    .iter()
                    .enumerate()
                    .map(|(i, p)| format!("{}; ", p.declaration(&format!("edit{i}"))))
                    .collect();
                let names: Vec<String> = (0..parameters.len()).map(|i| format!("edit{i}")).collect();
                format!("{declared}{}({}); ", f.name, names.join(", "))
            }
            None => "bool edit = true; ".to_owned(),
        },
        // No call at all
        _ => {
            let returns = &function.returns;
            return if &**returns == "void" { "{ }".to_owned() } else { format!("{{ {returns} edit; return edit; }}") };
        }
    };
    format!("{{ {statement}{}", &function.body[1..])
}

/// Edits each of the `chosen` functions, with the next kind of edit each time.
fn edit_all(texts: &Texts, stage: &TreePath, files: &Files, chosen: &[(TreePath, usize)], first: usize) -> Texts {
    let mut out = texts.clone();
    let kind = StageKind::of(stage).unwrap();
    let mut bodies: BTreeMap<&TreePath, BTreeMap<usize, String>> = BTreeMap::new();
    for (number, (path, index)) in chosen.iter().enumerate() {
        let functions = &files[path].as_ref().unwrap().parts().unwrap().functions;
        let body = edited((first + number) % KINDS, kind, &functions[..*index], &functions[*index]);
        bodies.entry(path).or_default().insert(*index, body);
    }
    for (path, bodies) in bodies {
        let parts = files[path].as_ref().unwrap().parts().unwrap();
        let (mut text, mut end) = (String::new(), 0);
        for (index, function) in parts.functions.iter().enumerate() {
            let body = bodies.get(&index).unwrap_or(&function.body);
            text.extend([&parts.rest[end..function.place], " ", &function.head, " ", body, "\n"]);
            end = function.place;
        }
        out.insert(path.clone(), text + &parts.rest[end..]);
    }
    out
}

/// Stages that are always compiled as a whole: two references to vertices, of which it writes one, make glslang declare their struct twice.
const WHOLE: [&str; 1] = ["deform.comp"];

/// Every function of every shipped stage is edited in one of eight runs, and each run has other kinds of edits.
#[test]
fn edits_of_all_functions() {
    let texts = shipped();
    let is_linked = |path: &&TreePath| StageKind::of(path).is_some() && !WHOLE.contains(&&*path.to_string());
    let stages: Vec<TreePath> = texts.keys().filter(is_linked).cloned().collect();
    let bases: Vec<(TreePath, Built)> =
        stages.into_par_iter().map(|stage| (stage.clone(), whole(&texts, &stage).unwrap())).collect();
    let runs: Vec<(&TreePath, &Built, usize)> =
        bases.iter().flat_map(|(stage, base)| (0..8).map(move |run| (stage, base, run))).collect();
    let edits: usize = runs
        .into_par_iter()
        .map(|(stage, base, run)| {
            let chosen: Vec<_> = functions(&base.files).into_iter().skip(run).step_by(8).collect();
            let edited = edit_all(&texts, stage, &base.files, &chosen, run);
            let what = format!("{stage}, run {run}");
            let expected = whole(&edited, stage).unwrap_or_else(|error| panic!("{what}: {error}"));
            let linked = incremental(&edited, stage, base).unwrap_or_else(|| panic!("{what}: not linked"));
            assert_same(&linked.spirv, &expected.spirv, &what);
            chosen.len()
        })
        .sum();
    assert!(edits > 1000, "{edits} edits");
}

/// Edits one function at a time, with the next kind of edit each time.
#[test]
fn edits_of_single_functions() {
    let (texts, stage) = (shipped(), TreePath::from("pbr.frag"));
    let base = whole(&texts, &stage).unwrap();
    let all = functions(&base.files);
    let chosen: Vec<usize> = (0..all.len()).step_by(11).collect();
    chosen.into_par_iter().for_each(|number| {
        let what = format!("{:?}, kind {}", all[number], number % KINDS);
        let edited = edit_all(&texts, &stage, &base.files, &all[number..=number], number);
        let expected = whole(&edited, &stage).unwrap();
        let linked = incremental(&edited, &stage, &base).unwrap_or_else(|| panic!("{what}: not linked"));
        assert_same(&linked.spirv, &expected.spirv, &what);
    });
}

/// A chain of edits. The last ones revert all earlier ones.
#[test]
fn fifty_edits_one_after_the_other() {
    let (shipped, stage) = (shipped(), TreePath::from("pbr.frag"));
    let first = whole(&shipped, &stage).unwrap();
    let all = functions(&first.files);
    let (mut base, mut texts) = (whole(&shipped, &stage).unwrap(), shipped.clone());
    // Chooses functions in an order unrelated to their order in the files.
    for step in 0..50 {
        let chosen = (step * 97 + 13) % all.len();
        let (path, _) = &all[chosen];
        // Each edit starts from the shipped text of its file, so it reverts earlier edits in that file.
        let edited = edit_all(&shipped, &stage, &first.files, &all[chosen..=chosen], step);
        texts.insert(path.clone(), edited[path].clone());
        let linked =
            incremental(&texts, &stage, &base).unwrap_or_else(|| panic!("step {step}: not linked: {:?}", all[chosen]));
        if step % 5 == 4 {
            assert_same(&linked.spirv, &whole(&texts, &stage).unwrap().spirv, &format!("step {step}"));
        }
        base = linked;
    }
    let last = incremental(&shipped, &stage, &base).unwrap();
    assert_same(&last.spirv, &first.spirv, "all taken back");
    let growth = last.spirv.len() as f64 / first.spirv.len() as f64;
    assert!((0.98..1.02).contains(&growth), "{} words, {} at first", last.spirv.len(), first.spirv.len());
}

/// The edits that `specula bench reload --edits` times.
#[test]
fn edits_of_users() {
    let list: toml::Table = include_str!("../../../tests/edits.toml").parse().unwrap();
    let edits = list["edit"].as_array().unwrap();
    assert_eq!(edits.len(), 40);
    let texts = shipped();
    let stages: Vec<TreePath> = texts.keys().filter(|path| StageKind::of(path).is_some()).cloned().collect();
    let bases: BTreeMap<TreePath, Built> =
        stages.into_par_iter().map(|stage| (stage.clone(), whole(&texts, &stage).unwrap())).collect();
    let linked = edits.par_iter().filter(|edit| {
        let [file, from, to] = ["file", "from", "to"].map(|name| edit[name].as_str().unwrap());
        let file = TreePath::from(file);
        let text = &texts[&file];
        assert_eq!(text.matches(from).count(), 1, "{file}: {from}");
        let mut edited = texts.clone();
        edited.insert(file.clone(), text.replacen(from, &to.replace("{n}", "1"), 1));
        // The stages that a window compiles first, and any other stage.
        let first = ["pbr.frag", "debug.frag"].map(TreePath::from);
        let stages = first.iter().chain(bases.keys());
        let (stage, base) =
            stages.map(|stage| (stage, &bases[stage])).find(|(_, base)| base.files.contains_key(&file)).unwrap();
        let expected = whole(&edited, stage).unwrap_or_else(|error| panic!("{file}: {to}: {error}"));
        let linked = incremental(&edited, stage, base);
        linked.iter().for_each(|linked| assert_same(&linked.spirv, &expected.spirv, &format!("{file}: {to}")));
        linked.is_some()
    });
    let linked = linked.count();
    assert!(linked >= 28, "{linked} of 40 edits are linked");
}

const SMALL: &str = "#version 460
    layout(location = 0) in vec4 x;
    layout(location = 0) out vec4 color;
    layout(constant_id = 7) const uint KIND = 0u;
    #define TWICE(a) twice(a)
    float twice(float a) { return 2.0 * a; }
    float unused(float a) { return sin(a); }
    float square(float a) { return a * a; }
    vec2 square(vec2 a) { return vec2(square(a.x), square(a.y)); }
    void add(inout vec4 a, const in float b[2], out bool c) { a += b[0] + b[1]; c = true; }
    vec4 sum(vec4 a) { bool c; add(a, float[2](1.0, 2.0), c); return a; }
    void main() { color = sum(x) * square(x.x) + (KIND == 1u ? x.y : 0.0); color.xy += square(x.zw); }
    ";

fn small(from: &str, to: &str) -> Texts {
    assert!(SMALL.contains(from), "{from}");
    Texts::from([("m.frag".into(), SMALL.replacen(from, to, 1))])
}

/// Edits of the small stage: a text, and its replacement.
#[test]
fn declarations_are_added_and_removed() {
    let stage = TreePath::from("m.frag");
    let base = whole(&small("", ""), &stage).unwrap();
    for (from, to) in [
        ("float b[2], out bool c) { a", "float b[2], out bool c) { a.x = b[1]; a"),
        ("a.x), square(a.y)", "a.y), square(a.x)"),
        ("return a; }", "return a * unused(a.x); }"),
        ("return a; }", "return a; } float more(float a) { return a + square(a); }"),
        ("vec4 sum(vec4 a) {", "float more(float a) { return a + square(a); } vec4 sum(vec4 a) { a *= more(a.y);"),
        ("float unused(float a) { return sin(a); }", ""),
        ("return sin(a);", "return cos(a);"),
        ("color = sum(x) * square(x.x)", "color = x"),
        ("void main() {", "void main() { if (gl_FragCoord.x < 0.0) discard;"),
        ("void main() {", "void main() { if (gl_SampleID > 2) discard;"),
        ("return a * a;", "return KIND == 2u ? a : dFdxFine(a);"),
    ] {
        let (what, texts) = (format!("{from} -> {to}"), small(from, to));
        let linked = incremental(&texts, &stage, &base).unwrap_or_else(|| panic!("{what}: not linked"));
        let expected = whole(&texts, &stage).unwrap();
        assert_same(&linked.spirv, &expected.spirv, &what);
        let back = incremental(&small("", ""), &stage, &linked).unwrap_or_else(|| panic!("{what}: not linked back"));
        assert_same(&back.spirv, &base.spirv, &format!("{what}, and back"));
    }
}

#[test]
fn other_edits_are_compiled_as_a_whole() {
    let stage = TreePath::from("m.frag");
    let base = whole(&small("", ""), &stage).unwrap();
    for (from, to) in [
        // Errors, one of which only the whole text shows
        ("return a * a;", "return a * b;"),
        ("return a * a;", "return unused(a;"),
        ("return a * a;", "return sum(vec4(a)).x;"),
        ("return 2.0 * a;", "return square(a); } float square(int a) { return 1.0;"),
        // Declarations, signatures, the order
        ("= 0u;", "= 1u;"),
        ("float twice(float a) { return 2.0 * a; }", ""),
        ("const in float b[2]", "in float b[2]"),
        (
            "float unused(float a) { return sin(a); }\n    float square(float a) { return a * a; }",
            "float square(float a) { return a * a; }\n    float unused(float a) { return sin(a); }",
        ),
        // A better overload for a call elsewhere
        ("vec4 sum(", "float square(int a) { return 1.0; } vec4 sum("),
        // The first call of a function, hidden in a macro
        ("return a; }", "return a * TWICE(a.x); }"),
        // Words and directives that affect other functions
        ("return a * a;", "precise float b = a * a; return b;"),
        ("return a * a;", "return a * a * __LINE__;"),
        ("return a * a;", "\n#if 1\n return a;\n#endif\n"),
    ] {
        assert!(incremental(&small(from, to), &stage, &base).is_none(), "{from} -> {to}");
    }
    // A function that calls itself through another
    let prototype = small("float twice(", "vec4 sum(vec4 a);\n float twice(");
    let text = prototype[&stage].replacen("return a; }", "return a * square(a.x); }", 1);
    let base = whole(&Texts::from([(stage.clone(), text.clone())]), &stage).unwrap();
    let recursion = text.replacen("return a * a;", "return sum(vec4(a)).x + a;", 1);
    let texts = Texts::from([(stage.clone(), recursion)]);
    assert!(incremental(&texts, &stage, &base).is_none());
}

#[test]
fn comments_compile_nothing() {
    let stage = TreePath::from("m.frag");
    let base = whole(&small("", ""), &stage).unwrap();
    for (from, to) in [("return a * a;", "/* a\n */ return\n\n a * a; // b\n"), ("void main", "// main\n void main")] {
        let texts = small(from, to);
        let source = Source::of_texts(texts);
        let snapshot = Snapshot::new(&source);
        let files = FileCache::default().files(&snapshot, base.files.keys()).unwrap();
        let rebuilt = rebuild(compiler(), &snapshot, &stage, (&base.spirv, &base.files), &files);
        assert!(matches!(rebuilt, Some(Rebuilt::Same)), "{from} -> {to}: {rebuilt:?}");
    }
}

#[test]
fn an_edit_and_its_reversal_give_the_driver_as_many_words_as_before() {
    let stage = TreePath::from("pbr.frag");
    let texts = shipped();
    let before = whole(&texts, &stage).unwrap();
    let mut edited = texts.clone();
    let file = edited.get_mut(&TreePath::from("brdf/ndf.glsl")).unwrap();
    let text = file.replacen("alpha * alpha", "alpha", 1);
    assert_ne!(text, *file);
    *file = text;
    let given = |spirv: &[u32]| optimize(specialize(spirv, &[])).len();
    let linked = incremental(&edited, &stage, &before).unwrap();
    assert_eq!(given(&linked.spirv), given(&whole(&edited, &stage).unwrap().spirv), "edited");
    let back = incremental(&texts, &stage, &linked).unwrap();
    assert_eq!(given(&back.spirv), given(&before.spirv), "reversed");
}
