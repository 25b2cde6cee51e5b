//! The texts that only the stage of a watched expression sees.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use super::place::{Placed, inserted, occurrence, place};
use super::{Expression, variables};
use crate::interface;
use crate::message::did_you_mean;
use crate::shader::compile::include::files_of;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::syntax::{functions, within};
use crate::shader::glsl::{Code, StageMain};
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::Module;

/// The stage that shows the expression. No tree lists it: names of files with a dot at their start are hidden.
pub const STAGE: &str = ".expression.frag";
/// Path that replaces the first include of that stage.
const LIBRARY: &str = ".expression.glsl";
/// The slug of the mode.
pub const MODE: &str = "expression";
/// The number of the mode, below those of passes.
const MODE_ID: u32 = interface::PASS_MODES - 1;
/// The function that the inserted calls name.
const FUNCTION: &str = "watch_value";
/// Begins the message of a diagnostic about the expression itself.
const CANNOT_WATCH: &str = "cannot watch ";

/// Whether a diagnostic is about the watched expression, so that the shaders are good without it.
pub fn is_about_expression(diagnostic: &Diagnostic) -> bool {
    diagnostic.message.starts_with(CANNOT_WATCH)
}

/// Whether a file is one of those that stand for a watched expression.
pub fn is_virtual(path: &TreePath) -> bool {
    path.as_str() == STAGE || path.as_str() == LIBRARY
}

/// The texts of a watched expression in one version of a tree.
#[derive(Debug)]
pub struct Overlay {
    /// The stage and its library, which every reader of the tree may see.
    pub files: BTreeMap<TreePath, Arc<str>>,
    /// The file with the inserted call, which only the stage sees.
    pub edited: Option<(TreePath, Arc<str>)>,
    /// Why the expression cannot be watched.
    pub error: Option<Diagnostic>,
    /// The file of the expression, once it is found.
    pub file: Option<TreePath>,
    /// An error at the place of the expression, without its message.
    at: Diagnostic,
    /// The stage that draws the picture.
    host: TreePath,
    text: String,
    /// The names that the line offers.
    names: Vec<String>,
    /// Whether the line is outside of every function.
    is_outside: bool,
}

impl Overlay {
    /// The overlay of an expression over the stage `host`, which draws the picture. `line` is the line now, after edits.
    pub fn new(expression: &Expression, line: u32, host: &TreePath, snapshot: &Snapshot<'_>) -> Self {
        let closure = files_of(snapshot, host);
        let mut overlay = Self {
            files: BTreeMap::new(),
            edited: None,
            error: None,
            file: None,
            at: Diagnostic::error(&expression.file, String::new()),
            host: host.clone(),
            text: expression.text.clone(),
            names: Vec::new(),
            is_outside: false,
        };
        let placed = overlay.place(expression, line, &closure, snapshot);
        let placed = placed.map_err(|error| overlay.error = Some(*error)).ok();
        overlay.is_outside = placed == Some(Placed::Outside);
        let outside = placed.filter(|placed| *placed == Placed::Outside).map(|_| expression.text.as_str());
        match stage_text(expression, line, host, &closure, snapshot, outside) {
            Ok(files) => overlay.files = files,
            Err(message) => {
                let host = snapshot.display_path(host);
                overlay.error.get_or_insert_with(|| Diagnostic::error(host, message));
            }
        }
        overlay
    }

    /// Finds the place of the expression and makes the text with the call.
    fn place(
        &mut self,
        expression: &Expression,
        line: u32,
        closure: &BTreeSet<TreePath>,
        snapshot: &Snapshot<'_>,
    ) -> Result<Placed, Box<Diagnostic>> {
        let path = find(&expression.file, closure, snapshot)?;
        let file = snapshot.display_path(&path);
        self.at = Diagnostic::error(&file, String::new());
        self.file = Some(path.clone());
        let text =
            snapshot.read(&path).map_err(|error| Box::new(Diagnostic::error(&file, format!("{file} {error}"))))?;
        let code = Code::new(&text);
        let column = expression.column.and_then(|column| (column as usize).checked_sub(1));
        if let Some(found) = code.line(line) {
            let bytes = occurrence(&found.code, &expression.text, column);
            let whole = found.raw.len() - found.raw.trim_start().len()..found.raw.trim_end().len();
            self.at = self.at.clone().on_line(line, Some(found.raw)).under(bytes.unwrap_or(whole));
        }
        self.names = variables(&text, line).into_iter().map(|(name, _)| name).collect();
        let call = |expression: &str| format!("{FUNCTION}({expression});");
        let placed = place(&code, line, column, &expression.text, call);
        let placed = placed.map_err(|message| Box::new(self.diagnostic(&message)))?;
        if let Placed::Inside(insertions) = &placed {
            self.edited = Some((path, inserted(&text, insertions).into()));
        }
        Ok(placed)
    }

    fn diagnostic(&self, why: &str) -> Diagnostic {
        Diagnostic { message: format!("{CANNOT_WATCH}`{}` here: {why}", self.text), ..self.at.clone() }
    }

    /// Converts compiler errors of the stage to errors of the expression.
    pub fn explained(&self, errors: &[Diagnostic]) -> Vec<Diagnostic> {
        let Some(first) = errors.first() else { return Vec::new() };
        let is_type = first.message.contains(FUNCTION) && first.message.contains("no matching overloaded function");
        let why = if is_type {
            "its value is no number, vector, matrix or bool; watch a member or an element".to_owned()
        } else {
            first.message.clone()
        };
        let mut error = self.diagnostic(&why);
        let unknown = first.message.strip_prefix('\'').and_then(|rest| rest.split_once("' : undeclared identifier"));
        if let Some((unknown, _)) = unknown {
            let hint = did_you_mean(unknown, self.names.iter().map(String::as_str));
            let names = match self.names.as_slice() {
                _ if self.is_outside => {
                    "this line is outside any function, so only global declarations are in scope".to_owned()
                }
                [] => "no number or vector is in scope on this line; watch a member of a struct as `s.roughness`"
                    .to_owned(),
                names => format!("in scope on this line: {}", names.join(", ")),
            };
            let hint = hint.trim().trim_end_matches('?').replacen("Did", "did", 1);
            let (first, rest) = names.split_at(1);
            let help = if hint.is_empty() { names } else { format!("{hint}? {}{rest}", first.to_uppercase()) };
            error = error.with_help(help);
        } else if (&first.file, first.line) != (&error.file, error.line) {
            error = error.with_note(first.one_line());
        }
        vec![error]
    }

    /// A diagnostic of the stage, with the file that its author knows.
    pub fn renamed(&self, mut diagnostic: Diagnostic, snapshot: &Snapshot<'_>) -> Diagnostic {
        if diagnostic.file == snapshot.display_path(&TreePath::from(STAGE)) {
            diagnostic.file = snapshot.display_path(&self.host);
        }
        diagnostic
    }
}

/// The file of the picture that the user means.
fn find(given: &str, closure: &BTreeSet<TreePath>, snapshot: &Snapshot<'_>) -> Result<TreePath, Box<Diagnostic>> {
    let plain = given.trim_start_matches("./");
    let exact = closure.iter().find(|path| path.as_str() == plain || snapshot.display_path(path) == given);
    if let Some(path) = exact {
        return Ok(path.clone());
    }
    let absolute = std::path::absolute(given).ok();
    let by_place = absolute.iter().flat_map(|file| snapshot.source().changed(file)).find(|path| closure.contains(path));
    let ends = |path: &&TreePath| path.as_str().strip_suffix(plain).is_some_and(|rest| rest.ends_with('/'));
    let ending: Vec<&TreePath> = closure.iter().filter(ends).collect();
    match (by_place, ending.as_slice()) {
        (Some(path), _) => return Ok(path),
        (None, [only]) => return Ok((*only).clone()),
        (None, [first, second, ..]) => {
            let message = format!("`{given}` can be {first} or {second}; give more of the path");
            return Err(Box::new(Diagnostic::error(given, message)));
        }
        (None, []) => {}
    }
    let is_there = TreePath::parse(plain).is_some_and(|path| snapshot.read(&path).is_ok());
    let message = if is_there {
        format!(
            "{given} is no part of the picture's stage: expressions can be watched in the files that it includes, not in \
             vertex stages, passes, bakes or debug modes"
        )
    } else {
        let hint = did_you_mean(plain, closure.iter().map(TreePath::as_str));
        format!("the picture's stage includes no file `{given}`.{hint}")
    };
    Err(Box::new(Diagnostic::error(given, message)))
}

/// The texts of the stage and its library.
fn stage_text(
    expression: &Expression,
    line: u32,
    host: &TreePath,
    closure: &BTreeSet<TreePath>,
    snapshot: &Snapshot<'_>,
    outside: Option<&str>,
) -> Result<BTreeMap<TreePath, Arc<str>>, String> {
    let text = snapshot.read(host).map_err(|error| format!("{host} {error}"))?;
    let StageMain { main, color, include } = StageMain::of(&text)?;
    let code = Code::new(&text);
    let mut edits: Vec<(Range<usize>, &str)> = vec![(main, "watched_main"), (include.bytes, LIBRARY)];
    let has_chosen = closure.iter().filter_map(|path| snapshot.read(path).ok());
    if has_chosen.into_iter().any(|text| text.contains("chosen_lights()")) {
        let functions = functions(&code.tokens);
        let inside = functions.iter().flat_map(|function| within(&code.tokens, &function.body.bytes));
        let all = inside.filter(|token| token.text == "all_lights");
        edits.extend(all.map(|token| (token.bytes.clone(), "chosen_lights")));
    }
    // The annotations of the stage itself are read from its own file.
    let annotations = code.lines().iter().filter_map(|line| Some(line.start + line.annotation?));
    edits.extend(annotations.map(|at| (at + 2..at + 3, " ")));
    edits.sort_by_key(|(bytes, _)| std::cmp::Reverse(bytes.start));
    let mut stage = text.to_string();
    for (bytes, new) in edits {
        stage.replace_range(bytes, new);
    }
    let call = outside.map(|expression| format!(" {FUNCTION}({expression});")).unwrap_or_default();
    let plain = |text: &str| text.replace(['"', '\\'], "");
    let (file, watched) = (plain(&expression.file), plain(&expression.text));
    let name = format!("{watched} at {}:{line}", file.rsplit('/').next().unwrap_or(&file));
    let doc = format!("Value of {watched} in line {line} of {file}; a checkerboard where the line is not reached");
    stage += &format!(
        "\n\n//@pass {MODE} \"Watched expression\" draw=model to=picture instead=model doc=\"The value of an expression of the \
         shaders\"\n#include \"common/pixel.glsl\"\n#include \"debug/absent.glsl\"\n\
         //@mode {MODE} \"{name}\" group=\"Expression\" encode=data stage=.expression doc=\"{doc}\"\n\
         const uint MODE_EXPRESSION = {MODE_ID}u;\n\
         void main() {{ watched_main();{call} {color} = hdr_pixel(if_present(watch_reached, watch_shown), 1.0, no_data); }}\n"
    );
    let include = format!("#include \"{}\"\n", include.name);
    let functions = library(expression.evaluation);
    // Extensions must stand before any code, and interface.glsl names them.
    let library = if include.contains("interface.glsl") { include + &functions } else { functions + &include };
    let files = [(STAGE, stage), (LIBRARY, library)];
    Ok(files.into_iter().map(|(path, text)| (TreePath::from(path), text.into())).collect())
}

/// The functions that keep a value, for each type that can be shown.
fn library(evaluation: u32) -> String {
    let mut out = format!(
        "bool watch_reached = false;\nuint watch_evaluations = 0u;\nvec3 watch_shown = vec3(0.0);\n\
         void watch_keep(vec3 value) {{\n    ++watch_evaluations;\n    \
         if ({evaluation}u != 0u && watch_evaluations != {evaluation}u) return;\n    \
         watch_reached = true;\n    watch_shown = value;\n}}\n"
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::glsl::find_word;
    use crate::shader::source::Source;

    const HOST: &str = "//@pass model \"Model\" draw=model to=picture\n#version 460\n#include \"interface.glsl\"\n\
        #include \"a.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = f(all_lights()); }\n";

    fn overlay(expression: &str) -> Overlay {
        let files = [("pbr.frag", HOST), ("a.glsl", "float f(float x) {\n    return 2.0 * x;\n}\n"), ("b.glsl", "")];
        let source = Source::memory(files);
        let expression = Expression::parse(expression, 0).unwrap();
        Overlay::new(&expression, expression.line, &"pbr.frag".into(), &Snapshot::new(&source))
    }

    #[test]
    fn every_line_stays_where_it_was() {
        let overlay = overlay("a.glsl:2:x");
        assert_eq!(overlay.error, None);
        let (path, text) = overlay.edited.unwrap();
        assert_eq!((path.as_str(), &*text), ("a.glsl", "float f(float x) {\n    watch_value(x); return 2.0 * x;\n}\n"));
        let stage = overlay.files[&TreePath::from(STAGE)].to_string();
        let start =
            HOST.replace("//@pass", "// pass").replace("interface.glsl", LIBRARY).replace("main", "watched_main");
        assert!(stage.starts_with(&start), "{stage}");
        assert!(stage.contains("void main() { watched_main(); color = hdr_pixel("));
        let library = &overlay.files[&TreePath::from(LIBRARY)];
        assert!(library.starts_with("#include \"interface.glsl\"\n"));
        assert!(find_word(library, "watch_value").is_some());
    }

    #[test]
    fn errors_say_where_expressions_can_be_watched() {
        let message = |expression: &str| overlay(expression).error.map(|error| error.one_line()).unwrap_or_default();
        assert!(message("b.glsl:1:x").contains("no part of the picture's stage"));
        assert!(message("aa.glsl:1:x").contains("Did you mean"), "{}", message("aa.glsl:1:x"));
        assert!(message("a.glsl:9:x").contains("no line 9"));
        assert!(message("pbr.frag:2:x").contains("directive"));
        assert_eq!(message("pbr.frag:6:color"), "");
        let unknown = |expression: &str| {
            let said = Diagnostic::error("a.glsl", "'y' : undeclared identifier");
            overlay(expression).explained(&[said])[0].help.clone().unwrap_or_default()
        };
        assert!(unknown("a.glsl:2:y").contains("in scope on this line: x"));
        assert!(unknown("pbr.frag:6:y").contains("no number or vector is in scope"));
        assert!(unknown("pbr.frag:5:y").contains("outside any function"));
    }
}
