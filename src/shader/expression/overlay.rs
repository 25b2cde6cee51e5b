//! The texts that only the stage of a watched expression sees.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Expression;
use super::host::{Found, find};
use super::place::{Placed, inserted, occurrence, place};
use super::scope::{members, variables};
use super::stage::{FUNCTION, LIBRARY, STAGE, stage_text};
use crate::message::did_you_mean;
use crate::shader::annotation::pass::PassDesc;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::Code;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

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
    /// The stage that the texts are made of, as displayed.
    host: String,
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
            host: String::new(),
            names: Vec::new(),
            is_outside: false,
        };
        match overlay.make(expression, line, hosts, snapshot) {
            Ok(files) => overlay.files = files,
            Err(error) => overlay.error = Some(*error),
        }
        overlay
    }

    /// Makes the texts of the stage and its library.
    fn make(
        &mut self,
        expression: &Expression,
        line: u32,
        hosts: &[PassDesc],
        snapshot: &Snapshot<'_>,
    ) -> Result<BTreeMap<TreePath, Arc<str>>, Box<Diagnostic>> {
        let found = find(&expression.file, hosts, snapshot)?;
        self.host = snapshot.display_path(&TreePath::from(found.host.stage.as_str()));
        self.is_outside = self.place(expression, line, &found, snapshot)? == Placed::Outside;
        let own = self.edited.as_ref().filter(|(path, _)| path.as_str() == found.host.stage);
        let own = own.map(|(_, text)| text.clone());
        let files = stage_text(expression, line, &found, own, self.is_outside, snapshot);
        files.map_err(|message| Box::new(Diagnostic::error(&self.host, message)))
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
        let texts: Vec<Arc<str>> = found.files.iter().filter_map(|path| snapshot.read(path).ok()).collect();
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

    /// A diagnostic of the stage, with the file that its author knows.
    pub fn renamed(&self, mut diagnostic: Diagnostic, snapshot: &Snapshot<'_>) -> Diagnostic {
        if diagnostic.file == snapshot.display_path(&TreePath::from(STAGE)) {
            diagnostic.file.clone_from(&self.host);
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

    fn overlay(expression: &str) -> Overlay {
        let files = [("pbr.frag", HOST), ("a.glsl", "float f(float x) {\n    return 2.0 * x;\n}\n"), ("b.glsl", "")];
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
