//! The types that a traced value can have, as far as they are known without a compiler.

use std::collections::BTreeSet;

use crate::shader::glsl::{Token, is_name};

/// The types of floats, vectors and matrices.
pub(super) const FLOATS: [&str; 13] = [
    "float", "vec2", "vec3", "vec4", "mat2", "mat3", "mat4", "mat2x3", "mat2x4", "mat3x2", "mat3x4", "mat4x2", "mat4x3",
];
/// The types that are always finite. Calls with their values do nothing.
pub(super) const OTHERS: [&str; 12] =
    ["int", "uint", "bool", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4", "bvec2", "bvec3", "bvec4"];

/// A struct of a file.
#[derive(Debug, PartialEq)]
pub(super) struct Struct {
    pub name: String,
    /// Type and name of each member that is no array.
    pub members: Vec<(String, String)>,
    /// Names of its arrays.
    pub arrays: Vec<String>,
    /// The byte after its `;`.
    pub end: usize,
}

/// The structs that a file defines outside of functions.
pub(super) fn structs(tokens: &[Token<'_>]) -> Vec<Struct> {
    let mut out = Vec::new();
    for at in 0..tokens.len() {
        let (Some(name), Some(open)) = (tokens.get(at + 1), tokens.get(at + 2)) else { break };
        if tokens[at].text != "struct" || open.text != "{" || !is_name(name.text) {
            continue;
        }
        let Some(length) = tokens[at..].iter().position(|token| token.text == "}") else { break };
        // A struct that also declares a variable is left out.
        let Some(end) = tokens.get(at + length + 1).filter(|token| token.text == ";") else { continue };
        let mut of = Struct { name: name.text.to_owned(), members: Vec::new(), arrays: Vec::new(), end: end.bytes.end };
        for member in tokens[at + 3..at + length].split(|token| token.text == ";") {
            let Some(kind) = member.windows(2).find(|pair| is_name(pair[0].text) && is_name(pair[1].text)) else {
                continue;
            };
            let names = member.iter().skip_while(|token| token.bytes.start <= kind[0].bytes.start).collect::<Vec<_>>();
            for declared in names.split(|token| token.text == ",") {
                match declared {
                    [name] => of.members.push((kind[0].text.to_owned(), name.text.to_owned())),
                    [name, ..] => of.arrays.push(name.text.to_owned()),
                    [] => {}
                }
            }
        }
        out.push(of);
    }
    out
}

/// The names of a stage whose whole values cannot be traced.
#[derive(Debug, Default)]
pub(super) struct Types {
    /// Structs with a function that traces their values.
    pub structs: BTreeSet<String>,
    /// All structs.
    pub all: BTreeSet<String>,
    /// Members that are structs or arrays.
    pub members: BTreeSet<String>,
    /// Variables outside of functions that are structs or arrays.
    pub globals: BTreeSet<String>,
}

impl Types {
    /// Learns the structs of a file. `is_traced`: functions can be inserted after them.
    pub(super) fn learn(&mut self, found: &[Struct], is_traced: bool) {
        for of in found {
            self.all.insert(of.name.clone());
            if is_traced {
                self.structs.insert(of.name.clone());
            }
            self.members.extend(of.arrays.iter().cloned());
        }
        let is_known = |kind: &str| FLOATS.contains(&kind) || OTHERS.contains(&kind);
        let members = found.iter().flat_map(|of| &of.members).filter(|(kind, _)| !is_known(kind));
        self.members.extend(members.map(|(_, name)| name.clone()));
    }

    /// The variables of structs and the arrays that some tokens declare.
    pub(super) fn opaque<'a>(&self, tokens: &'a [Token<'a>]) -> impl Iterator<Item = String> {
        let is_type = |text: &str| self.all.contains(text) || FLOATS.contains(&text) || OTHERS.contains(&text);
        tokens.windows(3).filter_map(move |three| {
            let [kind, name, after] = three else { return None };
            let is_opaque = self.all.contains(kind.text) || (after.text == "[" && is_type(kind.text));
            (is_opaque && is_name(name.text)).then(|| name.text.to_owned())
        })
    }

    /// The function that traces a struct, for the line after it: `CALL(site, value)` for each member.
    pub(super) fn tracer(&self, of: &Struct, call: &str) -> String {
        let known = |kind: &str| FLOATS.contains(&kind) || self.structs.contains(kind);
        let members = of.members.iter().filter(|(kind, _)| known(kind));
        let calls: String = members.map(|(_, name)| format!("{call}(site, value.{name}); ")).collect();
        let name = &of.name;
        format!(" {name} {call}(uint site, {name} value) {{ {calls}return value; }}")
    }
}
