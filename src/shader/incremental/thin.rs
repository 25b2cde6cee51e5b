//! The text of a file with only some of its functions. All that is kept stands on its line, so that errors would, too.

use std::collections::BTreeSet;

use super::difference::Files;
use super::scan::{Function, Parts};

/// What is left of a function.
enum Form {
    /// Everything.
    Whole,
    /// The header, and a body that returns an undefined value.
    Stub,
    /// Nothing.
    Absent,
}

/// The name of a function that calls those to compile. glslang drops what `main` does not reach.
pub const CALLER: &str = "specula_caller";

/// A selection of a stage's functions.
pub struct Selection<'a> {
    /// These are kept with all their overloads.
    pub whole: &'a BTreeSet<Box<str>>,
    /// The caller's definition, on one line; empty if nothing is to be called.
    caller: String,
}

impl<'a> Selection<'a> {
    /// Selects `whole`, and lets `main` call those that are in `called`. `None` if one cannot be called from there.
    pub fn new(files: &Files, whole: &'a BTreeSet<Box<str>>, called: &BTreeSet<Box<str>>) -> Option<Self> {
        let mut lines = String::new();
        let mut number = 0;
        for file in files.values().flatten() {
            let is_called = |f: &&Function| whole.contains(&f.name) && called.contains(&f.name) && &*f.name != "main";
            for function in file.parts()?.functions.iter().filter(is_called) {
                let mut arguments = Vec::new();
                for parameter in function.parameters.as_ref()? {
                    let name = format!("a{number}");
                    lines.push_str(&format!("{}; ", parameter.declaration(&name)));
                    arguments.push(name);
                    number += 1;
                }
                lines.push_str(&format!("{}({}); ", function.name, arguments.join(", ")));
            }
        }
        let caller = if lines.is_empty() { lines } else { format!("void {CALLER}() {{ {lines}}} ") };
        Some(Self { whole, caller })
    }

    /// `text` with the selected functions. Functions that the code may call have a stub: those that `names` contains.
    pub fn thin(&self, text: &str, parts: &Parts, names: impl Fn(&str) -> bool) -> String {
        let mut out = String::with_capacity(text.len() / 2);
        let mut end = 0;
        for function in &parts.functions {
            out.push_str(&text[end..function.range.start]);
            end = function.range.end;
            let (head, body) = (&text[function.range.start..function.body], &text[function.body..end]);
            let is_main = &*function.name == "main";
            let form = match &*function.name {
                name if self.whole.contains(name) => Form::Whole,
                name if is_main || names(name) => Form::Stub,
                _ => Form::Absent,
            };
            let call = if is_main && !self.caller.is_empty() { format!("{CALLER}(); ") } else { String::new() };
            if is_main {
                out.push_str(&self.caller);
            }
            match form {
                Form::Whole => out.extend([head, "{ ", &call, &body[1..]]),
                Form::Stub => {
                    out.push_str(head);
                    match &*function.returns {
                        "void" => out.extend(["{ ", &call, "}"]),
                        returns => out.extend(["{ ", returns, " specula_stub; return specula_stub; }"]),
                    }
                    push_lines(&mut out, body);
                }
                Form::Absent => push_lines(&mut out, &text[function.range.clone()]),
            }
        }
        out.push_str(&text[end..]);
        out
    }
}

/// Adds the line breaks of a text.
fn push_lines(out: &mut String, text: &str) {
    out.extend(text.chars().filter(|c| *c == '\n'));
}
