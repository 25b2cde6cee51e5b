//! The grammar of `//@` comments. Whatever does not parse is an error with its column and what was expected.

use std::ops::Range;

use super::annotation::{DrawAs, Encode, Mode, ParameterType};
use super::annotation_cursor::{Cursor, Place};
use super::diagnostic::Diagnostic;
use super::text::{Line, is_word, lines, tokens};

/// An annotation with its declaration's text.
#[derive(Debug)]
pub enum Found {
    /// `//@mode`
    Mode(Mode, Place),
    /// `//@ui`
    Ui(Ui),
}

/// What a `//@ui` stands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Declared {
    /// A specialization constant.
    Constant,
    /// A member of `Params`.
    Member(ParameterType),
}

/// A parsed `//@ui`.
#[derive(Debug)]
pub struct Ui {
    /// Name in GLSL.
    pub name: String,
    /// As given, or made of the name.
    pub label: String,
    /// `lo..hi`
    pub range: Option<(f64, f64)>,
    /// `choice A=0 B=1`
    pub choices: Vec<(String, i64)>,
    /// `color`
    pub color: bool,
    /// `= ...`, one number for each component.
    pub default: Option<Vec<f64>>,
    /// What it stands on.
    pub declared: Declared,
    /// Where.
    pub place: Place,
}

/// Reads all annotations of a file.
pub fn parse_file(file: &str, text: &str) -> (Vec<Found>, Vec<Diagnostic>) {
    let lines = lines(text);
    let (mut found, mut errors) = (Vec::new(), Vec::new());
    for (index, line) in lines.iter().enumerate() {
        let Some(start) = line.annotation else { continue };
        let end = line.raw.trim_end().len();
        let place = Place { file: file.to_owned(), line: line.number, raw: line.raw.to_owned(), bytes: start..end };
        let own = (!line.code.trim().is_empty()).then_some(line);
        let declaration = own.or_else(|| lines[index + 1..].iter().find(|line| !line.code.trim().is_empty()));
        match parse(place, start, declaration) {
            Ok(one) => found.push(one),
            Err(error) => errors.push(*error),
        }
    }
    (found, errors)
}

fn parse(place: Place, start: usize, declaration: Option<&Line<'_>>) -> Result<Found, Box<Diagnostic>> {
    let raw = place.raw.clone();
    let mut cursor = Cursor::new(&place, &raw, start + "//@".len());
    let (bytes, kind) = cursor.word();
    match kind {
        "mode" => {
            let mode = mode(&mut cursor, declaration)?;
            Ok(Found::Mode(mode, place))
        }
        "ui" => {
            let ui = ui(&mut cursor, declaration)?;
            Ok(Found::Ui(Ui { place, ..ui }))
        }
        _ => Err(cursor.error(start..bytes.end, format!("expected `//@mode` or `//@ui`, found `//@{kind}`"))),
    }
}

fn mode(cursor: &mut Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<Mode, Box<Diagnostic>> {
    let (bytes, slug) = cursor.word();
    let valid = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if slug.is_empty() || !slug.chars().all(valid) {
        let message = format!("expected the mode's slug in a-z, 0-9 and `-`, found `{slug}`");
        return Err(cursor.error(bytes, message));
    }
    let Some(name) = cursor.string()? else {
        return Err(cursor.expected("the mode's name in quotes"));
    };
    let mut mode = Mode {
        id: mode_id(cursor, declaration)?,
        slug: slug.to_owned(),
        name,
        group: String::new(),
        encode: Encode::Color,
        tonemap: false,
        draw: DrawAs::Surfaces,
        key: None,
        doc: String::new(),
        file: cursor.place().file.clone(),
        line: cursor.place().line,
    };
    let mut given: Vec<&str> = Vec::new();
    while !cursor.at_end() {
        let (bytes, key) = cursor.key();
        if given.contains(&key) {
            return Err(cursor.error(bytes, format!("`{key}` is given twice")));
        }
        given.push(key);
        match key {
            "tonemap" => mode.tonemap = true,
            "group" => mode.group = cursor.value(key)?.1,
            "doc" => mode.doc = cursor.value(key)?.1,
            "encode" => {
                let (bytes, value) = cursor.value(key)?;
                mode.encode = match value.as_str() {
                    "color" => Encode::Color,
                    "data" => Encode::Data,
                    "vector" => Encode::Vector,
                    other => {
                        let message = format!("expected encode=color, encode=data or encode=vector, found `{other}`");
                        return Err(cursor.error(bytes, message));
                    }
                };
            }
            "draw" => {
                let (bytes, value) = cursor.value(key)?;
                mode.draw = match value.as_str() {
                    "surfaces" => DrawAs::Surfaces,
                    "lines" => DrawAs::Lines,
                    "layers" => DrawAs::Layers,
                    other => {
                        let message = format!("expected draw=surfaces, draw=lines or draw=layers, found `{other}`");
                        return Err(cursor.error(bytes, message));
                    }
                };
            }
            "key" => {
                let (bytes, value) = cursor.value(key)?;
                let mut chars = value.chars();
                let (Some(one), None) = (chars.next(), chars.next()) else {
                    return Err(cursor.error(bytes, format!("expected one character after key=, found `{value}`")));
                };
                mode.key = Some(one);
            }
            other => {
                let message = format!("expected group=, encode=, tonemap, draw=, key= or doc=, found `{other}`");
                return Err(cursor.error(bytes, message));
            }
        }
    }
    Ok(mode)
}

/// The number of `const uint MODE_X = 120u;`.
fn mode_id(cursor: &Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<u32, Box<Diagnostic>> {
    let words: Vec<&str> = declaration.map(|line| tokens(&line.code)).unwrap_or_default().iter().map(|t| t.1).collect();
    if let ["const", "uint", _, "=", literal, ";", ..] = words.as_slice() {
        let digits = literal.trim_end_matches(['u', 'U']);
        let number = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
            Some(digits) => u32::from_str_radix(digits, 16),
            None => digits.parse(),
        };
        if let Ok(number) = number {
            return Ok(number);
        }
    }
    let found = declaration.map_or("the end of the file", |line| line.raw.trim());
    let message = format!("expected `const uint NAME = NUMBER;` with the mode, found `{found}`");
    Err(cursor.place().error(None, message))
}

fn ui(cursor: &mut Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<Ui, Box<Diagnostic>> {
    let (declared, name) = ui_declaration(cursor, declaration)?;
    let label = cursor.string()?;
    let label = label.unwrap_or_else(|| label_of(&name));
    let place = cursor.place().clone();
    let mut ui = Ui { name, label, range: None, choices: Vec::new(), color: false, default: None, declared, place };
    while !cursor.at_end() {
        if cursor.take('=') {
            ui.default = Some(default(cursor, declared)?);
            continue;
        }
        let (bytes, word) = cursor.word();
        match word {
            "color" => ui.color = true,
            "choice" => ui.choices = choices(cursor)?,
            word if word.contains("..") => ui.range = Some(range(cursor, bytes, word)?),
            word => {
                let message = format!("expected \"Label\", lo..hi, choice A=0 B=1, color or = default, found `{word}`");
                return Err(cursor.error(bytes, message));
            }
        }
    }
    let message = match declared {
        Declared::Member(kind) if ui.color && !matches!(kind, ParameterType::Vec3 | ParameterType::Vec4) => {
            "a color must be vec3 or vec4"
        }
        Declared::Constant if ui.color => "a constant cannot be a color",
        Declared::Constant if ui.default.is_some() => "a constant's default stands in its declaration, not after //@ui",
        Declared::Member(kind)
            if !ui.choices.is_empty() && !matches!(kind, ParameterType::Int | ParameterType::Uint) =>
        {
            "a choice must be int or uint"
        }
        _ => return Ok(ui),
    };
    Err(cursor.place().error(None, message))
}

/// `layout(constant_id = ...) const TYPE NAME` or the member `TYPE NAME;`.
fn ui_declaration(cursor: &Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<(Declared, String), Box<Diagnostic>> {
    let error = |message: String| Err(cursor.place().error(None, message));
    let words: Vec<&str> = declaration.map(|line| tokens(&line.code)).unwrap_or_default().iter().map(|t| t.1).collect();
    if words.contains(&"constant_id") {
        let at = words.iter().position(|word| *word == "const");
        return match at.and_then(|at| words.get(at + 2)) {
            Some(name) if name.starts_with(is_word) => Ok((Declared::Constant, (*name).to_owned())),
            _ => error("expected `layout(constant_id = ...) const TYPE NAME = DEFAULT;` on one line".to_owned()),
        };
    }
    let end = words.iter().position(|word| *word == ";");
    let (Some(kind), Some(name)) =
        (end.and_then(|end| words.get(end.checked_sub(2)?)), end.and_then(|end| words.get(end.checked_sub(1)?)))
    else {
        return error("expected //@ui behind `TYPE NAME;` in Params, or behind a constant_id".to_owned());
    };
    let kind = match *kind {
        "float" => ParameterType::Float,
        "int" => ParameterType::Int,
        "uint" => ParameterType::Uint,
        "bool" => ParameterType::Bool,
        "vec2" => ParameterType::Vec2,
        "vec3" => ParameterType::Vec3,
        "vec4" => ParameterType::Vec4,
        other => {
            return error(format!(
                "expected float, int, uint, bool, vec2, vec3 or vec4 before the name, found `{other}`"
            ));
        }
    };
    Ok((Declared::Member(kind), (*name).to_owned()))
}

/// The numbers after `=`.
fn default(cursor: &mut Cursor<'_>, declared: Declared) -> Result<Vec<f64>, Box<Diagnostic>> {
    let start = cursor.position();
    let mut out = Vec::new();
    while !cursor.at_end() {
        let (bytes, word) = cursor.word();
        out.push(match word {
            "true" => 1.0,
            "false" => 0.0,
            word => number(word).ok_or_else(|| cursor.error(bytes, format!("expected a number, found `{word}`")))?,
        });
    }
    let Declared::Member(kind) = declared else { return Ok(out) };
    let bytes = start..cursor.position();
    if out.len() != kind.components() {
        let message = format!("expected {} number(s) after `=`, found {}", kind.components(), out.len());
        return Err(cursor.error(bytes, message));
    }
    let whole = out.iter().all(|value| value.fract() == 0.0);
    match kind {
        ParameterType::Int | ParameterType::Uint | ParameterType::Bool if !whole => {
            Err(cursor.error(bytes, "expected a whole number after `=`"))
        }
        ParameterType::Uint if out[0] < 0.0 => Err(cursor.error(bytes, "expected a number of at least 0 after `=`")),
        _ => Ok(out),
    }
}

/// `A=0 B=1` up to something that is no choice.
fn choices(cursor: &mut Cursor<'_>) -> Result<Vec<(String, i64)>, Box<Diagnostic>> {
    let mut out: Vec<(String, i64)> = Vec::new();
    while !cursor.at_end() && !cursor.peek('=') {
        let (bytes, word) = cursor.word();
        let choice = word.split_once('=').and_then(|(name, value)| Some((name, value.parse().ok()?)));
        let Some((name, value)) = choice.filter(|(name, _)| !name.is_empty()) else {
            return Err(cursor.error(bytes, format!("expected NAME=NUMBER after `choice`, found `{word}`")));
        };
        if out.iter().any(|(known, number)| known == name || *number == value) {
            return Err(cursor.error(bytes, format!("choice `{word}` repeats a name or a number")));
        }
        out.push((name.to_owned(), value));
    }
    if out.is_empty() { Err(cursor.expected("NAME=NUMBER after `choice`")) } else { Ok(out) }
}

fn range(cursor: &Cursor<'_>, bytes: Range<usize>, word: &str) -> Result<(f64, f64), Box<Diagnostic>> {
    let ends = word.split_once("..").and_then(|(lo, hi)| Some((number(lo)?, number(hi)?)));
    match ends {
        Some((lo, hi)) if lo < hi => Ok((lo, hi)),
        _ => Err(cursor.error(bytes, format!("expected a range lo..hi with lo < hi, found `{word}`"))),
    }
}

fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.is_finite())
}

/// `Rim strength` of `rim_strength`, `Wrap diffuse` of `WRAP_DIFFUSE`.
fn label_of(name: &str) -> String {
    let words = name.replace('_', " ").to_lowercase();
    let mut chars = words.trim().chars();
    chars.next().map_or_else(|| name.to_owned(), |first| first.to_uppercase().chain(chars).collect())
}
