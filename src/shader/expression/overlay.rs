//! The texts that only the stages of a watched expression see.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Expression;
use super::host::{Found, find};
use super::place::{Placed, inserted, occurrence, place};
use super::scope::{members, variables};
use super::stage::{FUNCTION, LIBRARY, STAGE, VERTEX, VERTEX_LIBRARY, stage_texts};
use crate::message::did_you_mean;
use crate::shader::annotation::pass::PassDesc;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::Code;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// Whether a file is one of those that stand for a watched expression.
pub fn is_virtual(path: &TreePath) -> bool {
    is_watched(path) || [LIBRARY, VERTEX_LIBRARY].contains(&path.as_str())
}

/// Whether a stage is one of a watched expression.
pub fn is_watched(stage: &TreePath) -> bool {
    [STAGE, VERTEX].contains(&stage.as_str())
}

/// The texts of a watched expression in one version of a tree.
#[derive(Debug)]
pub struct Overlay {
    /// The stages and their libraries, which every reader of the tree may see.
    pub files: BTreeMap<TreePath, Arc<str>>,
    /// The file with the inserted call, which only the stages see.
    pub edited: Option<(TreePath, Arc<str>)>,
    /// Why the expression cannot be watched.
    pub error: Option<Diagnostic>,
    /// The file of the expression, once it is found.
    pub file: Option<TreePath>,
    /// An error at the place of the expression, without its message.
    at: Diagnostic,
    /// The stages that the texts are made of, as displayed.
    hosts: BTreeMap<&'static str, String>,
    text: String,
    /// The names that the line offers.
    names: Vec<String>,
    /// Whether the line is outside of every function.
    is_outside: bool,
}

impl Overlay {
    /// The overlay of an expression. `hosts`: the passes that can show one, the first of which includes its file. `line` is the line now,
    /// after edits.
    pub fn new(expression: &Expression, line: u32, hosts: &[PassDesc], snapshot: &Snapshot<'_>) -> Self {
        let mut overlay = Self {
            at: Diagnostic::error(&expression.file, String::new()),
            text: expression.text.clone(),
            files: BTreeMap::new(),
            edited: None,
            error: None,
            file: None,
            hosts: BTreeMap::new(),
            names: Vec::new(),
            is_outside: false,
        };
        match overlay.make(expression, line, hosts, snapshot) {
            Ok(files) => overlay.files = files,
            Err(error) => overlay.error = Some(*error),
        }
        overlay
    }

    /// Makes the texts of the stages and their libraries.
    fn make(
        &mut self,
        expression: &Expression,
        line: u32,
        hosts: &[PassDesc],
        snapshot: &Snapshot<'_>,
    ) -> Result<BTreeMap<TreePath, Arc<str>>, Box<Diagnostic>> {
        let found = find(&expression.file, hosts, snapshot)?;
        let host = snapshot.display_path(&TreePath::from(found.host.stage.as_str()));
        let vertex = found.vertex.as_ref().map(|vertex| (VERTEX, snapshot.display_path(&vertex.path)));
        self.hosts = [(STAGE, host.clone())].into_iter().chain(vertex).collect();
        self.is_outside = self.place(expression, line, &found, snapshot)? == Placed::Outside;
        let files = stage_texts(expression, line, &found, self.edited.as_ref(), snapshot);
        files.map_err(|message| Box::new(Diagnostic::error(host, message)))
    }

    /// Finds the place of the expression and makes the text with the call.
    fn place(
        &mut self,
        expression: &Expression,
        line: u32,
        found: &Found,
        snapshot: &Snapshot<'_>,
    ) -> Result<Placed, Box<Diagnostic>> {
        let path = &found.path;
        let file = snapshot.display_path(path);
        self.at = Diagnostic::error(&file, String::new());
        self.file = Some(path.clone());
        let text =
            snapshot.read(path).map_err(|error| Box::new(Diagnostic::error(&file, format!("{file} {error}"))))?;
        let code = Code::new(&text);
        let column = expression.column.and_then(|column| (column as usize).checked_sub(1));
        if let Some(found) = code.line(line) {
            let bytes = occurrence(&found.code, &expression.text, column);
            let whole = found.raw.len() - found.raw.trim_start().len()..found.raw.trim_end().len();
            self.at = self.at.clone().on_line(line, Some(found.raw)).under(bytes.unwrap_or(whole));
        }
        let files = found.vertex.iter().flat_map(|vertex| &vertex.files).chain(&found.files);
        let texts: Vec<Arc<str>> = files.filter_map(|path| snapshot.read(path).ok()).collect();
        let structs = members(texts.iter().map(|text| &**text));
        self.names = variables(&text, line, &structs).into_iter().map(|variable| variable.name).collect();
        let call = |expression: &str| format!("{FUNCTION}({expression});");
        let placed = place(&code, line, column, &expression.text, call);
        let placed = placed.map_err(|message| Box::new(self.diagnostic(&message)))?;
        if let Placed::Inside(insertions) = &placed {
            self.edited = Some((path.clone(), inserted(&text, insertions).into()));
        }
        Ok(placed)
    }

    fn diagnostic(&self, why: &str) -> Diagnostic {
        Diagnostic { message: format!("cannot watch `{}` here: {why}", self.text), ..self.at.clone() }
    }

    /// Converts compiler errors of the stage to errors of the expression.
    pub fn explained(&self, errors: &[Diagnostic]) -> Vec<Diagnostic> {
        let Some(first) = errors.first() else { return Vec::new() };
        let is_type = first.message.contains(FUNCTION) && first.message.contains("no matching overloaded function");
        let of_it = format!("{}.", self.text);
        let members: Vec<&str> =
            self.names.iter().filter(|name| name.starts_with(&of_it)).map(String::as_str).collect();
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
                [] => "no number or vector is in scope on this line".to_owned(),
                names => format!("in scope on this line: {}", listed(names)),
            };
            let hint = hint.trim().trim_end_matches('?').replacen("Did", "did", 1);
            let (first, rest) = names.split_at(1);
            let help = if hint.is_empty() { names } else { format!("{hint}? {}{rest}", first.to_uppercase()) };
            error = error.with_help(help);
        } else if is_type && !members.is_empty() {
            error = error.with_help(format!("its members: {}", members.join(", ")));
        } else if (&first.file, first.line) != (&error.file, error.line) {
            error = error.with_note(first.one_line());
        }
        vec![error]
    }

    /// A diagnostic of a stage, with the file that its author knows.
    pub fn renamed(&self, mut diagnostic: Diagnostic, snapshot: &Snapshot<'_>) -> Diagnostic {
        let hosts =
            self.hosts.iter().find(|(path, _)| diagnostic.file == snapshot.display_path(&TreePath::from(**path)));
        if let Some((_, host)) = hosts {
            diagnostic.file.clone_from(host);
        }
        diagnostic
    }
}

/// The names, with those of members as one: `a2, members of s`.
fn listed(names: &[String]) -> String {
    let mut out: Vec<String> = Vec::new();
    for name in names {
        let name = name.split_once('.').map_or_else(|| name.clone(), |(of, _)| format!("members of {of}"));
        if !out.contains(&name) {
            out.push(name);
        }
    }
    out.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::expression::hosts;
    use crate::shader::glsl::find_word;
    use crate::shader::source::Source;

    const HOST: &str = "//@pass model \"Model\" draw=model to=picture\n#version 460\n#include \"interface.glsl\"\n\
        #include \"a.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = f(all_lights()); }\n";

    const VERTICES: &str = "#version 460\n#include \"interface.glsl\"\n#include \"moved.glsl\"\n\
        layout(location = 0) out vec3 normal;\nvoid main() { normal = moved(draw.vertices.at[0].normal); }\n";

    fn overlay(expression: &str) -> Overlay {
        let files = [
            ("pbr.frag", HOST),
            ("a.glsl", "float f(float x) {\n    return 2.0 * x;\n}\n"),
            ("b.glsl", ""),
            ("pbr.vert", VERTICES),
            ("moved.glsl", "vec3 moved(vec3 n) {\n    return -n;\n}\n"),
        ];
        let source = Source::memory(files);
        let expression = Expression::parse(expression, 0).unwrap();
        let snapshot = Snapshot::new(&source);
        let hosts = hosts([TreePath::from("pbr.frag")].iter(), &snapshot);
        Overlay::new(&expression, expression.line, &hosts, &snapshot)
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
    fn vertices_give_their_values_to_the_pixels_between_them() {
        let of = |expression: &str| {
            let overlay = overlay(expression);
            assert_eq!(overlay.error, None);
            let text = |path: &str| overlay.files.get(&TreePath::from(path)).map(|text| text.to_string());
            (text(VERTEX), text(STAGE).unwrap(), overlay.edited)
        };
        let (vertex, stage, edited) = of("moved.glsl:2:n");
        assert_eq!(&*edited.unwrap().1, "vec3 moved(vec3 n) {\n    watch_value(n); return -n;\n}\n");
        let vertex = vertex.unwrap();
        assert!(
            vertex.starts_with(&VERTICES.replace("interface.glsl", VERTEX_LIBRARY).replace("main", "watched_main"))
        );
        assert!(vertex.contains("layout(location = 15) out vec4 watch_varying;"), "{vertex}");
        assert!(stage.contains("layout(location = 15) in vec4 watch_varying;"), "{stage}");
        let (vertex, _, edited) = of("pbr.vert:5:normal");
        assert!(edited.is_some() && vertex.unwrap().contains("watch_value(normal); }"));
        let (vertex, stage, _) = of("a.glsl:2:x");
        assert!(vertex.is_none() && !stage.contains("watch_varying"), "the copy has the model's vertex stage");
    }

    #[test]
    fn errors_say_where_expressions_can_be_watched() {
        let message = |expression: &str| overlay(expression).error.map(|error| error.one_line()).unwrap_or_default();
        assert!(message("b.glsl:1:x").contains("part of nothing whose values a pixel shows"));
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
