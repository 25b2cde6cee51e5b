//! Names that the files of a stage declare, and the nearest of them to an unknown name.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::message::most_typos;
use crate::shader::glsl::{BUILT_IN, Code, QUALIFIERS, Token, is_name, tokens};
use crate::shader::source::TreePath;

/// Where a declared name can be used.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Scope {
    Global,
    /// In a function: the first and the last line of a file.
    Local(u32, u32),
    /// In a value of the named struct or block.
    Member(String),
}

#[derive(Clone, Debug)]
struct Declared {
    name: String,
    /// Empty for a macro.
    type_name: String,
    scope: Scope,
}

/// The declarations in the files of a stage.
pub struct Names(BTreeMap<TreePath, Vec<Declared>>);

impl Names {
    /// Finds the declarations in the texts of files, without a preprocessor: those of all branches count.
    pub fn of<'a>(files: impl Iterator<Item = (&'a TreePath, Arc<str>)>) -> Self {
        Self(files.map(|(path, text)| (path.clone(), Scanner::scan(&text))).collect())
    }

    /// Whether one of the files declares this name outside of functions and structs.
    pub fn has_global(&self, name: &str) -> bool {
        self.all().any(|(_, declared)| declared.scope == Scope::Global && declared.name == name)
    }

    /// The name nearest to an unknown one on a line of a file: of a variable, function, constant, macro or struct, or of what is
    /// built into GLSL. `None` if none is near, or if the name is declared.
    pub fn nearest(&self, unknown: &str, file: &TreePath, line: u32) -> Option<&str> {
        let local = self.all().filter(|(path, declared)| match declared.scope {
            Scope::Local(first, last) => *path == file && (first..=last).contains(&line),
            Scope::Global | Scope::Member(_) => false,
        });
        let global = self.all().filter(|(_, declared)| declared.scope == Scope::Global);
        let names = local.chain(global).map(|(_, declared)| declared.name.as_str());
        nearest(unknown, names.chain(BUILT_IN.iter().map(|known| known.name)))
    }

    /// The member nearest to an unknown one of the value `base`: of the types that a variable or member of this name has, or of all
    /// types if it is not known.
    pub fn nearest_member(&self, unknown: &str, base: &str) -> Option<&str> {
        let of_base = self.all().filter(|(_, declared)| declared.name == base);
        let types: BTreeSet<&str> = of_base.map(|(_, declared)| declared.type_name.as_str()).collect();
        let members = |is_of_type: &dyn Fn(&str) -> bool| -> Vec<&str> {
            let is_member = |declared: &&Declared| match &declared.scope {
                Scope::Member(owner) => is_of_type(owner),
                Scope::Global | Scope::Local(..) => false,
            };
            self.0.values().flatten().filter(is_member).map(|declared| declared.name.as_str()).collect()
        };
        let own = members(&|owner| types.contains(owner));
        nearest(unknown, if own.is_empty() { members(&|_| true) } else { own })
    }

    fn all(&self) -> impl Iterator<Item = (&TreePath, &Declared)> {
        self.0.iter().flat_map(|(path, declared)| declared.iter().map(move |declared| (path, declared)))
    }
}

/// The first of the nearest names, if no more letters differ than [`most_typos`].
fn nearest<'a>(unknown: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let limit = most_typos(unknown.chars().count());
    // Case decides between names that are equally near.
    let distance = |name: &str| {
        let folded = strsim::osa_distance(&unknown.to_lowercase(), &name.to_lowercase());
        (folded, strsim::osa_distance(unknown, name))
    };
    let mut best: Option<((usize, usize), &str)> = None;
    for name in names {
        if name == unknown {
            return None;
        }
        let distance = distance(name);
        if distance.0 <= limit && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, name));
        }
    }
    best.map(|(_, name)| name)
}

/// The construct between a pair of braces at file level.
#[derive(Clone, Debug)]
enum Body {
    /// The index of the first name that the function declares, counting its parameters.
    Function(usize),
    /// The name of a struct or block, and the index of its first member.
    Members(String, usize),
    Other,
}

/// Reads declarations from the tokens of a file: pairs of a type and a name, and the names that follow in a list.
struct Scanner<'a> {
    code: Code<'a>,
    out: Vec<Declared>,
    /// Open braces.
    depth: u32,
    /// Open parentheses and brackets.
    nested: u32,
    body: Option<Body>,
    /// The index of the first token of the statement, and of the first name that it declares.
    statement: (usize, usize),
    /// The type of a list of declarations, and its `depth` and `nested`.
    list: Option<(&'a str, u32, u32)>,
}

impl<'a> Scanner<'a> {
    fn scan(text: &'a str) -> Vec<Declared> {
        let (code, out) = (Code::new(text), macros(text).collect());
        let mut scanner = Self { code, out, depth: 0, nested: 0, body: None, statement: (0, 0), list: None };
        for at in 0..scanner.code.tokens.len() {
            scanner.read(at);
        }
        scanner.out
    }

    fn token(&self, at: usize) -> &'a str {
        self.code.tokens.get(at).map_or("", |token| token.text)
    }

    fn line(&self, at: usize) -> u32 {
        self.code.number_at(self.code.tokens[at].bytes.start)
    }

    fn read(&mut self, at: usize) {
        match self.token(at) {
            "{" => {
                if self.depth == 0 {
                    self.body = Some(self.opened(at));
                }
                self.depth += 1;
            }
            "}" => {
                self.depth = self.depth.saturating_sub(1);
                if self.depth == 0 {
                    self.close(at);
                }
            }
            "(" | "[" => self.nested += 1,
            ")" | "]" => self.nested = self.nested.saturating_sub(1),
            ";" => {
                if self.depth == 0 {
                    // The parameters of a declaration without a body.
                    self.out.retain(|declared| declared.scope != Scope::Local(0, 0));
                    self.statement = (at + 1, self.out.len());
                }
                self.list = None;
            }
            "," => {
                if let Some((kind, ..)) = self.list.filter(|list| (list.1, list.2) == (self.depth, self.nested))
                    && is_name(self.token(at + 1))
                    && matches!(self.token(at + 2), "," | ";" | "=" | "[")
                {
                    self.declare(kind, at + 1);
                }
            }
            name if is_name(name) && at > 0 => self.pair(at),
            _ => {}
        }
    }

    /// A type and a name.
    fn pair(&mut self, at: usize) {
        let (kind, next) = (self.token(at - 1), self.token(at + 1));
        if kind == "struct" {
            self.declare("", at);
        }
        if !is_name(kind) || is_no_type(kind) || !matches!(next, "(" | ")" | "," | ";" | "=" | "[" | ":") {
            return;
        }
        self.declare(kind, at);
        if next != "(" {
            self.list = Some((kind, self.depth, self.nested));
        }
    }

    fn declare(&mut self, kind: &str, at: usize) {
        let (line, name) = (self.line(at), self.token(at));
        let scope = match &self.body {
            Some(Body::Function(_)) => Scope::Local(line, u32::MAX),
            Some(Body::Members(owner, _)) => Scope::Member(owner.clone()),
            Some(Body::Other) => return,
            // A parameter, until it is known whether a body follows.
            None if self.nested > 0 => Scope::Local(0, 0),
            None => Scope::Global,
        };
        self.out.push(Declared { name: name.to_owned(), type_name: kind.to_owned(), scope });
    }

    /// The construct that a brace at file level opens.
    fn opened(&mut self, at: usize) -> Body {
        let (first, declared) = self.statement;
        if at > 0 && self.token(at - 1) == ")" {
            let line = self.line(first);
            for parameter in &mut self.out[declared..] {
                if parameter.scope == Scope::Local(0, 0) {
                    parameter.scope = Scope::Local(line, u32::MAX);
                }
            }
            return Body::Function(declared);
        }
        match at.checked_sub(1).map(|before| self.token(before)) {
            Some(owner) if is_name(owner) => Body::Members(owner.to_owned(), self.out.len()),
            _ => Body::Other,
        }
    }

    /// Ends a body at file level.
    fn close(&mut self, at: usize) {
        let line = self.line(at);
        match self.body.take() {
            Some(Body::Function(first)) => {
                for declared in &mut self.out[first..] {
                    if let Scope::Local(_, last) = &mut declared.scope {
                        *last = line;
                    }
                }
            }
            // The members of a block without a name of its own are global.
            Some(Body::Members(owner, first)) => {
                let is_struct = self.code.tokens[self.statement.0..at].iter().any(|token| token.text == "struct");
                if is_name(self.token(at + 1)) {
                    self.declare(&owner, at + 1);
                } else if !is_struct {
                    self.out[first..].iter_mut().for_each(|member| member.scope = Scope::Global);
                }
            }
            Some(Body::Other) | None => {}
        }
        self.list = None;
        self.statement = (at + 1, self.out.len());
    }
}

/// The names that lines `#define NAME` declare.
fn macros(text: &str) -> impl Iterator<Item = Declared> {
    let mut before = ["", ""];
    let names = tokens(text).filter(move |token| {
        let is_macro = token.in_directive && before == ["#", "define"];
        before = [before[1], token.text];
        is_macro
    });
    let declared =
        |token: Token<'_>| Declared { name: token.text.to_owned(), type_name: String::new(), scope: Scope::Global };
    names.map(declared)
}

/// Whether a word can precede a name and is no type.
pub(super) fn is_no_type(word: &str) -> bool {
    const OTHERS: [&str; 7] = ["return", "else", "case", "do", "struct", "precision", "layout"];
    QUALIFIERS.contains(&word) || OTHERS.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "#define HALF_PI 1.57\n\
        struct Hit { vec3 normal_ws, point; float roughness; };\n\
        layout(set = 0) uniform Frame { float time; vec2 size; } frame;\n\
        layout(set = 1) uniform Params { float sparkle; };\n\
        const float GAIN = 2.0, OFFSET = 1.0;\n\
        float saturate_all(vec3 v);\n\
        float luminance_of(vec3 radiance) {\n\
            float weight = 1.0, scale;\n\
            for (int index = 0, count = 2; index < count; index++) { vec2 corner = vec2(0.0); }\n\
            return weight;\n\
        }\n\
        void main() { Hit hit; float exposure = GAIN; }\n";

    fn names() -> Names {
        Names::of([(&TreePath::from("m.frag"), TEXT.into())].into_iter())
    }

    #[test]
    fn the_nearest_declared_name_is_suggested() {
        let (names, file) = (names(), TreePath::from("m.frag"));
        for (unknown, line, expected) in [
            ("sparkel", 12, Some("sparkle")),
            ("GIAN", 12, Some("GAIN")),
            ("OFSET", 12, Some("OFFSET")),
            ("HALFPI", 12, Some("HALF_PI")),
            ("luminance", 12, Some("luminance_of")),
            ("satrate_all", 12, Some("saturate_all")),
            ("frme", 12, Some("frame")),
            ("Hitt", 12, Some("Hit")),
            ("normlize", 12, Some("normalize")),
            ("Mix", 12, Some("mix")),
            ("exposur", 12, Some("exposure")),
            ("exposur", 9, None),
            ("radience", 9, Some("radiance")),
            ("radience", 12, None),
            ("scael", 9, Some("scale")),
            ("cuont", 9, Some("count")),
            ("cornr", 10, Some("corner")),
            ("scael", 12, None),
            ("roughnes", 12, None),
            ("mix", 12, None),
            ("q", 12, None),
            ("completely_else", 12, None),
        ] {
            assert_eq!(names.nearest(unknown, &file, line), expected, "{unknown}, line {line}");
        }
        assert_eq!(names.nearest("exposur", &"other.glsl".into(), 12), None);
    }

    #[test]
    fn members_are_those_of_the_type() {
        let names = names();
        for (unknown, base, expected) in [
            ("nrmal_ws", "hit", Some("normal_ws")),
            ("pont", "hit", Some("point")),
            ("tmie", "frame", Some("time")),
            ("roughnes", "frame", None),
            ("roughnes", "", Some("roughness")),
            ("time", "frame", None),
        ] {
            assert_eq!(names.nearest_member(unknown, base), expected, "{base}.{unknown}");
        }
    }
}
