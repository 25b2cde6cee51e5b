//! The stages that compute a watched expression: copies of the fragment stage of its pass, and of the vertex stage where that is
//! watched, each with another `main`.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::Expression;
use super::host::{Found, VertexStage};
use crate::interface::{FLAG_NO_DATA, FLAG_NOT_FINITE, PASS_MODES};
use crate::shader::annotation::pass::{Cull, Instances, MODEL, PassDesc, PassSize};
use crate::shader::glsl::syntax::{functions, within};
use crate::shader::glsl::{Code, Token, color_of, includes, main_of, outputs};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::Module;

/// The stage that shows the expression. No tree lists it: names of files with a dot at their start are hidden.
pub const STAGE: &str = ".expression.frag";
/// The vertex stage beside it.
pub const VERTEX: &str = ".expression.vert";
/// Paths that replace the first include of these stages.
pub(super) const LIBRARY: &str = ".expression.glsl";
pub(super) const VERTEX_LIBRARY: &str = ".expression_vertex.glsl";
/// The slug of the mode, and the name of the pass.
pub const MODE: &str = "expression";
/// The number of the mode, below those of passes.
pub const MODE_ID: u32 = PASS_MODES - 1;
/// The function that the inserted calls name.
pub(super) const FUNCTION: &str = "watch_value";
/// The library that names the extensions of a stage, which must stand before any code.
const INTERFACE: &str = "interface.glsl";
/// The location of the value between the stages: the last that every device has.
const VARYING: u32 = 15;

/// The texts of the stages and their libraries. `edited`: the file of the expression with the call, if it stands in a function.
pub(super) fn stage_texts(
    expression: &Expression,
    line: u32,
    found: &Found,
    edited: Option<&(TreePath, Arc<str>)>,
    snapshot: &Snapshot<'_>,
) -> Result<BTreeMap<TreePath, Arc<str>>, String> {
    let Found { host, files, vertex, .. } = found;
    let path = TreePath::from(host.stage.as_str());
    let read = |path: &TreePath| match edited.filter(|(edited, _)| edited == path) {
        Some((_, text)) => Ok(text.clone()),
        None => snapshot.read(path).map_err(|error| format!("{path} {error}")),
    };
    let text = read(&path)?;
    let others: Vec<Arc<str>> = files.iter().filter_map(|path| snapshot.read(path).ok()).collect();
    let color = std::iter::once(&text).chain(&others).find_map(|text| color_of(text));
    let color = color.ok_or_else(|| format!("{path} has no `out vec4` color"))?;

    let code = Code::new(&text);
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    edits.extend(other_outputs(&code.tokens, &color).map(|bytes| (bytes.clone(), " ".repeat(bytes.len()))));
    if others.iter().any(|text| text.contains("chosen_lights()")) {
        let functions = functions(&code.tokens);
        let inside = functions.iter().flat_map(|function| within(&code.tokens, &function.body.bytes));
        let all = inside.filter(|token| token.text == "all_lights");
        edits.extend(all.map(|token| (token.bytes.clone(), "chosen_lights".to_owned())));
    }
    let call = match edited {
        None => format!(" {FUNCTION}({});", expression.text),
        Some(_) => String::new(),
    };
    let watched = vertex.as_ref().filter(|vertex| vertex.is_watched);
    let (varying, shown) = match watched {
        Some(_) => (
            format!("layout(location = {VARYING}) in vec4 watch_varying;\n"),
            // A value that only some of the vertices have is none between them.
            " watch_reached = watch_varying.w > 0.999; watch_shown = watch_varying.xyz;",
        ),
        None => (String::new(), &*call),
    };
    let own = library(expression.evaluation);
    let Copied { mut stage, library } = copy((&path, &text), files, edits, (LIBRARY, &own), snapshot);
    stage += &ending(expression, line, host, &color, (&varying, shown), watched.is_some());
    let mut texts = BTreeMap::from([(TreePath::from(STAGE), stage.into())]);
    texts.extend(library.map(|text| (TreePath::from(LIBRARY), text.into())));
    if let Some(VertexStage { path, files, is_watched }) = vertex {
        let text = read(path)?;
        let copied = copy((path, &text), files, Vec::new(), (VERTEX_LIBRARY, &own), snapshot);
        let ending = match is_watched {
            true => format!(
                "\n\nlayout(location = {VARYING}) out vec4 watch_varying;\nvoid main() {{ watched_main();{call} \
                 watch_varying = vec4(watch_shown, watch_reached ? 1.0 : 0.0); }}\n"
            ),
            false => "\n\nvoid main() { watched_main(); }\n".to_owned(),
        };
        texts.insert(TreePath::from(VERTEX), (copied.stage + &ending).into());
        texts.extend(copied.library.map(|text| (TreePath::from(VERTEX_LIBRARY), text.into())));
    }
    Ok(texts)
}

/// A stage without its `main`.
struct Copied {
    stage: String,
    /// The text of the library in the place of its first include, if it has one.
    library: Option<String>,
}

/// Copies a stage with these edits: `main` becomes `watched_main`, and a library takes the place of the first include, or of the first line
/// of code.
fn copy(
    (path, text): (&TreePath, &str),
    files: &BTreeSet<TreePath>,
    mut edits: Vec<(Range<usize>, String)>,
    (library_path, own): (&str, &str),
    snapshot: &Snapshot<'_>,
) -> Copied {
    let code = Code::new(text);
    let main = main_of(&code.tokens);
    let has_interface =
        files.contains(&TreePath::from(INTERFACE)) || includes(text).any(|include| include.name == INTERFACE);
    let mut names = includes(text).map(|include| (include.bytes, resolved(path, include.name, snapshot)));
    let library = match names.next() {
        Some((bytes, first)) => {
            let interface = if has_interface { format!("#include \"{INTERFACE}\"\n") } else { String::new() };
            let first = format!("#include \"{first}\"\n");
            // The included file has the main.
            let first = if main.is_some() { first } else { format!("#define main watched_main\n{first}#undef main\n") };
            edits.push((bytes, library_path.to_owned()));
            Some(interface + own + &first)
        }
        None => {
            let start = code.tokens.first().map_or(0, |token| token.bytes.start);
            edits.push((start..start, own.replace('\n', " ")));
            None
        }
    };
    edits.extend(names);
    edits.extend(main.map(|bytes| (bytes, "watched_main".to_owned())));
    // The annotations of the stage itself are read from its own file.
    let annotations = code.lines().iter().filter_map(|line| Some(line.start + line.annotation?));
    edits.extend(annotations.map(|at| (at + 2..at + 3, " ".to_owned())));
    edits.sort_by_key(|(bytes, _)| std::cmp::Reverse(bytes.start));
    let mut stage = text.to_owned();
    for (bytes, new) in edits {
        stage.replace_range(bytes, &new);
    }
    Copied { stage, library }
}

/// The annotations and the `main` of the fragment stage: declarations before it, and statements after those of the host.
fn ending(
    expression: &Expression,
    line: u32,
    host: &PassDesc,
    color: &str,
    (declared, call): (&str, &str),
    is_interpolated: bool,
) -> String {
    let plain = |text: &str| text.replace(['"', '\\'], "");
    let (file, watched) = (plain(&expression.file), plain(&expression.text));
    let which = match expression.evaluation {
        0 => String::new(),
        number => format!(", evaluation {number}"),
    };
    let name = format!("{watched} at {}:{line}{which}", file.rsplit('/').next().unwrap_or(&file));
    let between = if is_interpolated { ", interpolated between the vertices" } else { "" };
    let doc = format!(
        "Value of {watched} in line {line} of {file}{which}{between}; a checkerboard where the line is not reached"
    );
    let cull = match host.cull {
        None => "",
        Some(Cull::None) => " cull=none",
        Some(Cull::Front) => " cull=front",
        Some(Cull::Back) => " cull=back",
    };
    if host.draws_model() && host.to_picture() {
        return format!(
            "\n\n//@pass {MODE} \"Watched expression\" draw=model to=picture instead={MODEL}{cull} doc=\"The value of an \
             expression of the shaders\"\n#include \"common/pixel.glsl\"\n#include \"debug/absent.glsl\"\n\
             //@mode {MODE} \"{name}\" group=\"Expression\" encode=data stage=.expression doc=\"{doc}\"\n\
             const uint MODE_EXPRESSION = {MODE_ID}u;\n{declared}\
             void main() {{ watched_main();{call} {color} = hdr_pixel(if_present(watch_reached, watch_shown), 1.0, no_data); \
             if (watch_is_bad()) {color}.rgb = watch_bad(); }}\n"
        );
    }
    let size = match host.size {
        PassSize::Divided(1) => "1".to_owned(),
        PassSize::Divided(by) => format!("1/{by}"),
        PassSize::Pixels(width, height) => format!("{width}x{height}"),
    };
    let draw = match host.model {
        None => String::new(),
        Some(Instances::Lights) => format!(" draw=model instances=lights{cull}"),
        Some(Instances::Count(count)) => format!(" draw=model instances={count}{cull}"),
    };
    let rows = if host.rows_up { " rows=up" } else { "" };
    // The flags are those of common/pixel.glsl. A toy includes nothing whose names it may use.
    format!(
        "\n\n//@pass {MODE} \"{name}\" watches={} size={size} format=rgba32f{rows}{draw} doc=\"{doc}\"\n{declared}\
         vec4 watch_pixel() {{\n    ivec2 square = ivec2(gl_FragCoord.xy) / 16;\n    \
         vec3 absent = vec3(((square.x + square.y) & 1) == 0 ? 0.180017 : 0.260017);\n    \
         if (!watch_reached) return vec4(absent, {}.0);\n    \
         return watch_is_bad() ? vec4(watch_bad(), {}.0) : vec4(watch_shown, 1.0);\n}}\n\
         void main() {{ watched_main();{call} {color} = watch_pixel(); }}\n",
        host.name,
        FLAG_NO_DATA + 1,
        FLAG_NOT_FINITE + 1,
    )
}

/// The path from the root of the tree of a file that a stage includes.
fn resolved(stage: &TreePath, name: &str, snapshot: &Snapshot<'_>) -> String {
    let beside = stage.sibling(name).filter(|path| snapshot.read(path).is_ok());
    beside.map_or_else(|| name.to_owned(), |path| path.to_string())
}

/// The bytes of `layout(...) out` of the other outputs, which become variables.
fn other_outputs<'a>(tokens: &'a [Token<'_>], color: &'a str) -> impl Iterator<Item = Range<usize>> + 'a {
    outputs(tokens).filter(move |at| tokens[at + 2].text != color).map(|at| {
        let start = tokens[..at].iter().rposition(|token| matches!(token.text, "layout" | ";" | "}"));
        let start = start.filter(|start| tokens[*start].text == "layout").unwrap_or(at);
        tokens[start].bytes.start..tokens[at].bytes.end
    })
}

/// The functions that keep a value, for each type that can be shown.
fn library(evaluation: u32) -> String {
    let mut out = format!(
        "bool watch_reached = false;\nuint watch_evaluations = 0u;\nvec3 watch_shown = vec3(0.0);\n\
         void watch_keep(vec3 value) {{\n    ++watch_evaluations;\n    \
         if ({evaluation}u != 0u && watch_evaluations != {evaluation}u) return;\n    \
         watch_reached = true;\n    watch_shown = value;\n}}\n\
         bool watch_is_nan() {{ return watch_reached && any(isnan(watch_shown)); }}\n\
         bool watch_is_bad() {{ return watch_is_nan() || (watch_reached && any(isinf(watch_shown))); }}\n\
         vec3 watch_bad() {{ return watch_is_nan() ? vec3(1.0, 0.0, 1.0) : vec3(1.0, 1.0, 0.0); }}\n"
    );
    for (kind, value) in [
        ("float", "vec3(value)"),
        ("int", "vec3(float(value))"),
        ("uint", "vec3(float(value))"),
        ("bool", "vec3(value ? 1.0 : 0.0)"),
        ("vec2", "vec3(value, 0.0)"),
        ("ivec2", "vec3(value, 0.0)"),
        ("uvec2", "vec3(value, 0.0)"),
        ("bvec2", "vec3(value, 0.0)"),
        ("vec3", "value"),
        ("ivec3", "vec3(value)"),
        ("uvec3", "vec3(value)"),
        ("bvec3", "vec3(value)"),
        ("vec4", "value.xyz"),
        ("ivec4", "vec3(value.xyz)"),
        ("uvec4", "vec3(value.xyz)"),
        ("bvec4", "vec3(value.xyz)"),
        ("mat2", "vec3(value[0], 0.0)"),
        ("mat3", "value[0]"),
        ("mat4", "value[0].xyz"),
    ] {
        out += &format!("void {FUNCTION}({kind} value) {{ watch_keep({value}); }}\n");
    }
    out
}

/// The number of components of the value that a module watches, 3 at most.
pub fn components_of(spirv: &[u32]) -> Option<u8> {
    let module = Module::parse(spirv)?;
    module.called_functions().find_map(|name| Some(components(name.strip_prefix(FUNCTION)?.strip_prefix('(')?)))
}

/// The components of a parameter as glslang writes its type: `f1;`, `vf3;`, `mf33;`.
fn components(kind: &str) -> u8 {
    let digits: Vec<u32> = kind.chars().filter_map(|c| c.to_digit(10)).collect();
    u8::try_from(digits.last().copied().unwrap_or(3).clamp(1, 3)).unwrap_or(3)
}
