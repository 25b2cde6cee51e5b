//! The code of a file with only some of its functions.

use std::collections::BTreeSet;

use super::difference::Files;
use super::scan::{Function, Parts};

/// The name of a generated function that calls the functions to compile. glslang drops functions that `main` does not
/// reach.
pub const CALLER: &str = "specula_caller";

/// A selection of a stage's functions.
pub struct Selection<'a> {
    /// The functions that keep their bodies, with all overloads.
    pub whole: &'a BTreeSet<Box<str>>,
    /// The definition of [`CALLER`], on one line. Empty if it would call nothing.
    caller: String,
}

impl<'a> Selection<'a> {
    /// Selects `whole`, and lets `main` call its functions that are in `called`. `None` if such a call cannot be
    /// written.
    pub fn new(files: &Files, whole: &'a BTreeSet<Box<str>>, called: &BTreeSet<&str>) -> Option<Self> {
        let mut lines = String::new();
        let mut number = 0;
        for file in files.values().flatten() {
            let is_called = |f: &&Function| whole.contains(&f.name) && called.contains(&*f.name) && &*f.name != "main";
            for function in file.parts()?.functions.iter().filter(is_called) {
                let mut arguments = Vec::new();
                for parameter in function.parameters.as_ref()? {
                    let name = format!("specula_argument_{number}");
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

    /// The code of a file with the selected functions. Of the other functions, `main` and those whose name `names`
    /// accepts become stubs, since the code may call them.
    pub fn thin(&self, parts: &Parts, names: impl Fn(&str) -> bool) -> String {
        let mut out = String::with_capacity(parts.rest.len() * 2);
        let mut end = 0;
        for function in &parts.functions {
            out.extend([&parts.rest[end..function.place], " "]);
            end = function.place;
            let is_main = &*function.name == "main";
            let call = if is_main && !self.caller.is_empty() { format!("{CALLER}(); ") } else { String::new() };
            if is_main {
                out.push_str(&self.caller);
            }
            let is_whole = self.whole.contains(&function.name);
            if is_whole {
                out.extend([&function.head, "{ ", &call, &function.body[1..]]);
            } else if is_main || names(&function.name) {
                out.push_str(&function.head);
                match &*function.returns {
                    "void" => out.extend(["{ ", &call, "}"]),
                    returns => out.extend(["{ ", returns, " specula_stub; return specula_stub; }"]),
                }
            }
        }
        out.push_str(&parts.rest[end..]);
        out
    }
}
