//! The names that can be watched on a line.

use std::collections::BTreeMap;

use crate::shader::glsl::syntax::{Function, Statement, StatementKind, functions, within};
use crate::shader::glsl::{Code, Token, code, is_name};

/// The types whose values can be shown.
const TYPES: [&str; 17] = [
    "float", "int", "uint", "bool", "vec2", "vec3", "vec4", "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4",
    "bvec3", "mat2", "mat3", "mat4",
];

/// A value that a line can use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// The name, of a member with that of its variable: `s.roughness`.
    pub name: String,
    /// Its type.
    pub kind: String,
}

/// The members of structs, by the names of these.
pub type Structs = BTreeMap<String, Vec<Variable>>;

/// Most structs in one another whose members are listed.
const DEPTH: usize = 2;

/// The structs that texts declare.
pub fn members<'a>(texts: impl Iterator<Item = &'a str>) -> Structs {
    let mut out = Structs::new();
    for text in texts.filter(|text| text.contains("struct")) {
        let tokens = code(text);
        for (at, _) in tokens.iter().enumerate().filter(|(_, token)| token.text == "struct") {
            let [_, name, open, rest @ ..] = &tokens[at..] else { continue };
            let end = rest.iter().position(|token| token.text == "}").unwrap_or(rest.len());
            if open.text == "{" && is_name(name.text) {
                let mut found = Vec::new();
                declared(&rest[..end], &is_name, &mut found);
                out.insert(name.text.to_owned(), found);
            }
        }
    }
    out
}

/// The variables that are declared at the end of a line, the nearest first, with their types. Those of the line itself come before.
/// Of a variable with a type of `structs`, its members are listed.
pub fn variables(text: &str, number: u32, structs: &Structs) -> Vec<Variable> {
    let code = Code::new(text);
    let tokens = &code.tokens;
    let end = code.start(number) + code.line(number).map_or(0, |line| line.raw.len());
    let start = code.start(number);
    let inside = |function: &&Function| {
        let whole = function.head.start..function.body.bytes.end;
        whole.start < end.max(start + 1) && whole.end > start
    };
    let is_type = |word: &str| TYPES.contains(&word) || structs.contains_key(word);
    let mut found = Vec::new();
    if let Some(function) = functions(tokens).iter().find(inside) {
        collect(&function.body, end, tokens, &is_type, &mut found);
        found.reverse();
        declared(within(tokens, &(function.head.start..function.head.end)), &is_type, &mut found);
    }
    let mut seen = std::collections::BTreeSet::new();
    found.retain(|variable| seen.insert(variable.name.clone()));
    let mut out = Vec::new();
    found.into_iter().for_each(|variable| add(variable, structs, DEPTH, &mut out));
    out
}

/// Adds a variable, or its members.
fn add(variable: Variable, structs: &Structs, depth: usize, out: &mut Vec<Variable>) {
    match structs.get(&variable.kind) {
        None if TYPES.contains(&&*variable.kind) => out.push(variable),
        Some(members) if depth > 0 => {
            for Variable { name, kind } in members {
                let member = Variable { name: format!("{}.{name}", variable.name), kind: kind.clone() };
                add(member, structs, depth - 1, out);
            }
        }
        _ => {}
    }
}

/// Adds what the statements declare that begin before `end` and whose blocks hold it.
fn collect(
    statement: &Statement,
    end: usize,
    tokens: &[Token<'_>],
    is_type: &impl Fn(&str) -> bool,
    out: &mut Vec<Variable>,
) {
    for part in &statement.parts {
        if part.bytes.start > end {
            break;
        }
        match part.kind {
            StatementKind::Simple => declared(within(tokens, &part.bytes), is_type, out),
            StatementKind::Jump => {}
            _ if part.bytes.end >= end => {
                declared(within(tokens, &part.header), is_type, out);
                collect(part, end, tokens, is_type, out);
            }
            _ => {}
        }
    }
}

/// Adds the variables that a piece of code declares: `TYPE NAME`, and after it `, NAME` with an initializer or none.
fn declared(inside: &[Token<'_>], is_type: &impl Fn(&str) -> bool, out: &mut Vec<Variable>) {
    let variable = |name: &str, kind: &str| Variable { name: name.to_owned(), kind: kind.to_owned() };
    let mut of_list = None;
    let mut depth = 0_i32;
    for (at, token) in inside.iter().enumerate() {
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        let before = at.checked_sub(1).and_then(|at| inside.get(at)).map_or("", |token| token.text);
        let after = inside.get(at + 1).map_or("", |token| token.text);
        if is_type(before) && is_name(token.text) && matches!(after, "=" | ";" | "," | ")" | "") {
            out.push(variable(token.text, before));
            of_list = Some((before, depth));
        } else if before == "," && is_name(token.text) && matches!(after, "=" | ";" | ",") {
            let of_list = of_list.filter(|(_, declared)| *declared == depth);
            out.extend(of_list.map(|(kind, _)| variable(token.text, kind)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variables_of_a_line() {
        let text = "float g(float a, inout vec3 b, Surface s) {\n    float c = f(a, b.x), d;\n    if (c > 0.0) { int e = 1; }\n    \
            for (uint i = 0u; i < 4u; ++i) {\n        mat3 m = mat3(1.0);\n    }\n    vec2 late;\n}\nfloat h() { return 1.0; }\n";
        let plain = Structs::new();
        let of = |line| variables(text, line, &plain);
        let names = |line| of(line).into_iter().map(|found| found.name).collect::<Vec<_>>().join(" ");
        assert_eq!(names(1), "a b");
        assert_eq!(names(2), "d c a b");
        assert_eq!(names(5), "m i d c a b");
        assert_eq!(names(7), "late d c a b");
        assert_eq!(names(9), "");
        assert_eq!((of(5)[1].name.as_str(), of(5)[1].kind.as_str()), ("i", "uint"));
    }

    #[test]
    fn members_of_structs_are_listed() {
        let library = "struct Lobe { float alpha, weight; vec3 f[2]; };\nstruct Surface {\n    vec3 normal; // n\n    Lobe coat;\n};\n";
        let text = "vec3 g(Surface s, Other o) {\n    return s.normal;\n}\n";
        let structs = members([library, text].into_iter());
        let found = variables(text, 2, &structs);
        let names: Vec<&str> = found.iter().map(|found| found.name.as_str()).collect();
        assert_eq!(names, ["s.normal", "s.coat.alpha", "s.coat.weight"]);
        assert_eq!(found[1].kind, "float");
    }
}
