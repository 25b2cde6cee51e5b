//! The types of the expressions in front of a dot, as far as they can be told without a compiler.

use super::view::View;
use crate::shader::TreePath;
use crate::shader::glsl::{Token, TokenKind, built_in, code, is_name};
use crate::shader::symbols::{Symbol, SymbolKind};

/// A type.
#[derive(Clone, Debug, PartialEq)]
pub struct TypeOf {
    /// Its name.
    pub name: String,
    /// Number of pairs of brackets behind it.
    pub dimensions: usize,
}

impl TypeOf {
    fn plain(name: &str) -> Self {
        Self { name: name.to_owned(), dimensions: 0 }
    }

    fn of(symbol: &Symbol) -> Self {
        Self { name: symbol.type_name.clone(), dimensions: symbol.dimensions }
    }

    /// Number of components of a vector or scalar.
    pub fn components(&self) -> Option<usize> {
        if self.dimensions > 0 {
            return None;
        }
        let last = || self.name.chars().last().and_then(|c| c.to_digit(10)).map(|count| count as usize);
        match self.name.as_str() {
            "float" | "int" | "uint" | "bool" => Some(1),
            name if name.contains("vec") && name.len() <= 5 => last(),
            _ => None,
        }
    }

    /// The type of an element.
    fn element(&self) -> Option<Self> {
        if self.dimensions > 0 {
            return Some(Self { name: self.name.clone(), dimensions: self.dimensions - 1 });
        }
        let name = match self.name.as_str() {
            "vec2" | "vec3" | "vec4" => "float",
            "ivec2" | "ivec3" | "ivec4" => "int",
            "uvec2" | "uvec3" | "uvec4" => "uint",
            "bvec2" | "bvec3" | "bvec4" => "bool",
            "mat2" | "mat3x2" | "mat4x2" => "vec2",
            "mat3" | "mat2x3" | "mat4x3" => "vec3",
            "mat4" | "mat2x4" | "mat3x4" => "vec4",
            _ => return None,
        };
        Some(Self::plain(name))
    }

    /// The type of some components.
    fn swizzled(&self, components: &str) -> Option<Self> {
        self.components()?;
        let is_swizzle = |c: char| "xyzwrgbastpq".contains(c);
        if components.is_empty() || components.len() > 4 || !components.chars().all(is_swizzle) {
            return None;
        }
        let (scalar, vector) = match self.name.as_bytes().first() {
            Some(b'i') => ("int", "ivec"),
            Some(b'u') => ("uint", "uvec"),
            Some(b'b') => ("bool", "bvec"),
            _ => ("float", "vec"),
        };
        Some(if components.len() == 1 {
            Self::plain(scalar)
        } else {
            Self::plain(&format!("{vector}{}", components.len()))
        })
    }
}

/// The type of what stands in front of the dot before a byte, or before the word that begins there.
pub fn before_dot(view: &View, path: &TreePath, byte: usize) -> Option<TypeOf> {
    let text = view.files.get(path)?.text();
    let tokens = code(text);
    let behind = tokens.partition_point(|token| token.bytes.end <= byte);
    let dot = tokens[..behind].last().filter(|token| token.text == ".")?;
    let at = tokens.iter().position(|token| token.bytes == dot.bytes)?;
    of_expression(view, path, &tokens[..at], 0)
}

/// The type of the longest chain of members, calls and brackets at the end of tokens.
fn of_expression(view: &View, path: &TreePath, tokens: &[Token<'_>], depth: usize) -> Option<TypeOf> {
    let (last, before) = tokens.split_last()?;
    if depth > 64 {
        return None;
    }
    match last.text {
        "]" => of_expression(view, path, &tokens[..opening(tokens)?], depth + 1)?.element(),
        ")" => {
            let open = opening(tokens)?;
            match tokens[..open].last() {
                Some(name) if name.kind == TokenKind::Word && is_name(name.text) && name.text != "return" => {
                    of_call(view, path, &tokens[..open], (open + 1, tokens), depth)
                }
                // In parentheses.
                _ => of_expression(view, path, &tokens[open + 1..tokens.len() - 1], depth + 1)
                    .or_else(|| Some(TypeOf::plain("vec4"))),
            }
        }
        name if last.kind == TokenKind::Word && is_name(name) => match before.split_last() {
            Some((dot, owner)) if dot.text == "." && is_on_line(view, path, dot, last) => {
                of_member(view, path, owner, name, depth)
            }
            _ => of_name(view, path, last),
        },
        _ => None,
    }
}

/// Whether a name stands on the line of the dot before it. A dot at the end of a line is being typed.
fn is_on_line(view: &View, path: &TreePath, dot: &Token<'_>, name: &Token<'_>) -> bool {
    let between = view.files.get(path).and_then(|file| file.text().get(dot.bytes.end..name.bytes.start));
    between.is_none_or(|between| !between.contains(['\n', '\r']))
}

fn of_member(view: &View, path: &TreePath, owner: &[Token<'_>], name: &str, depth: usize) -> Option<TypeOf> {
    let owner = of_expression(view, path, owner, depth + 1)?;
    let files = view.visible(path);
    let members = view.members(&files, &owner.name);
    let member = members.iter().find(|found| found.symbol.name == name);
    member.map(|found| TypeOf::of(found.symbol)).or_else(|| owner.swizzled(name))
}

fn of_name(view: &View, path: &TreePath, token: &Token<'_>) -> Option<TypeOf> {
    let meant = view.plain(path, token.text, &token.bytes);
    let value = meant.iter().find(|found| found.symbol.is_value());
    value.map(|found| TypeOf::of(found.symbol)).or_else(|| {
        let known = built_in(token.text).filter(|known| !known.is_function() && !known.forms.is_empty())?;
        Some(TypeOf::plain(known.type_name()))
    })
}

/// The type that a call gives: what the function returns, or the type of a constructor. `called` ends with the name.
fn of_call(
    view: &View,
    path: &TreePath,
    called: &[Token<'_>],
    (first, tokens): (usize, &[Token<'_>]),
    depth: usize,
) -> Option<TypeOf> {
    let name = called.last()?.text;
    let files = view.visible(path);
    let globals = view.globals(&files, name);
    if let Some(function) = globals.iter().find(|found| found.symbol.kind == SymbolKind::Function) {
        return Some(TypeOf::plain(&function.symbol.type_name));
    }
    if globals.iter().any(|found| found.symbol.kind == SymbolKind::Struct) {
        return Some(TypeOf::plain(name));
    }
    let known = built_in(name)?;
    match known.type_name() {
        "gvec4" => Some(TypeOf::plain("vec4")),
        // Of arrays, and of images with three dimensions; others have two.
        "ivec" => Some(TypeOf::plain("ivec3")),
        // As its first argument.
        of if of.starts_with("gen") || matches!(of, "vec" | "bvec" | "mat") => {
            let inside = &tokens[first..tokens.len() - 1];
            let mut nested = 0_i32;
            let comma = inside.iter().position(|token| {
                nested += i32::from(matches!(token.text, "(" | "[")) - i32::from(matches!(token.text, ")" | "]"));
                nested == 0 && token.text == ","
            });
            let argument = of_expression(view, path, &inside[..comma.unwrap_or(inside.len())], depth + 1);
            argument.or_else(|| Some(TypeOf::plain("vec4")))
        }
        of => Some(TypeOf::plain(of)),
    }
}

/// The index of the bracket that the last token closes.
fn opening(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate().rev() {
        match token.text {
            ")" | "]" => depth += 1,
            "(" | "[" => {
                depth -= 1;
                if depth == 0 {
                    return Some(at);
                }
            }
            ";" | "{" | "}" => return None,
            _ => {}
        }
    }
    None
}
