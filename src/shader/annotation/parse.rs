//! Parses `//@` comments. An error has a column and says what was expected.

use super::cursor::{Cursor, Place};
use super::pass::{self, PassNote, TextureNote};
use super::value::{choices, claim, claimed, default, range};
use super::{DrawAs, Encode, Mode, ModeStage, ParameterType};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::text::{Line, is_word, lines, tokens};
use crate::shader::spirv::reflect::Scalar;

/// The keys that the window reserves.
const WINDOW_KEYS: &str = "h r l q 0-9 [ ]";

/// A parsed annotation.
#[derive(Debug)]
pub enum Found {
    /// `//@mode`
    Mode(Mode, Place),
    /// `//@ui`
    Ui(Ui),
    /// `//@pass`
    Pass(PassNote),
    /// `//@texture`
    Texture(TextureNote),
}

/// The declaration that a `//@ui` belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Declared {
    /// A specialization constant of this type.
    Constant(Scalar),
    /// A member of `Params`.
    Member(ParameterType),
}

/// A parsed `//@ui`.
#[derive(Debug)]
pub struct Ui {
    /// Name in GLSL.
    pub name: String,
    /// The given label, or one derived from the name.
    pub label: String,
    /// `lo..hi`
    pub range: Option<(f64, f64)>,
    /// `choice A=0 B=1`
    pub choices: Vec<(String, i64)>,
    /// `conserves="A"`
    pub conserves: Option<Vec<String>>,
    /// `reciprocal="A B"`
    pub reciprocal: Option<Vec<String>>,
    /// `color`
    pub color: bool,
    /// `= ...`, one number per component.
    pub default: Option<Vec<f64>>,
    /// The annotated declaration.
    pub declared: Declared,
    /// Location of the annotation.
    pub place: Place,
}

/// Reads all annotations of a file.
pub fn parse_file(file: &str, text: &str) -> (Vec<Found>, Vec<Diagnostic>) {
    if !text.contains("//@") {
        return (Vec::new(), Vec::new());
    }
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
        "pass" => pass::pass(&mut cursor).map(Found::Pass),
        "texture" => pass::texture(&mut cursor).map(Found::Texture),
        _ => {
            let message = format!("expected `//@mode`, `//@ui`, `//@pass` or `//@texture`, found `//@{kind}`");
            Err(cursor.error(start..bytes.end, message))
        }
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
        components: 3,
        file: cursor.place().file.clone(),
        line: cursor.place().line,
        ..Mode::default()
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
            "accumulate" => mode.accumulate = true,
            "traces" => mode.traces = true,
            "through" => mode.through = true,
            "group" => mode.group = cursor.value(key)?.1,
            "doc" => mode.doc = cursor.value(key)?.1,
            "unit" => mode.unit = cursor.value(key)?.1,
            "components" => {
                let (bytes, value) = cursor.value(key)?;
                let count = value.parse().ok().filter(|count| (1..=3).contains(count));
                let message = || format!("expected components=1, components=2 or components=3, found `{value}`");
                mode.components = count.ok_or_else(|| cursor.error(bytes, message()))?;
            }
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
            "stage" => {
                let (bytes, value) = cursor.value(key)?;
                mode.stage = match value.as_str() {
                    "pbr" => ModeStage::Picture,
                    "debug" => ModeStage::Debug,
                    "paths" => ModeStage::Paths,
                    other => {
                        let message = format!("expected stage=pbr, stage=debug or stage=paths, found `{other}`");
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
                check_key(one).map_err(|message| cursor.error(bytes, message))?;
                mode.key = Some(one);
            }
            other => {
                let known = "group=, encode=, components=, unit=, stage=, tonemap, accumulate, traces, through, draw=, key= or \
                    doc=";
                let message = format!("expected {known}, found `{other}`");
                return Err(cursor.error(bytes, message));
            }
        }
    }
    if mode.traces && mode.stage != ModeStage::Paths {
        return Err(cursor.expected("stage=paths beside `traces`: only paths.frag can trace rays"));
    }
    Ok(mode)
}

/// Checks that a mode may have this key. The window ignores case and reserves some keys.
fn check_key(key: char) -> Result<(), String> {
    let taken = match key {
        'a'..='z' if !WINDOW_KEYS.contains(key) => return Ok(()),
        'A'..='Z' => return Err(format!("expected a lowercase letter after key=, found `{key}`")),
        'h' => "hides the panels",
        'r' => "frames the model",
        'l' => "stops the lights",
        'q' => "quits, with Ctrl",
        '0'..='9' => "chooses a mode by its place in the list",
        '[' | ']' => "steps through the modes",
        _ => return Err(format!("expected a letter a-z after key=, found `{key}`")),
    };
    Err(format!(
        "expected a key that the window does not use itself (it uses {WINDOW_KEYS}), found `{key}`, which {taken}"
    ))
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
    let mut ui = Ui {
        name,
        label,
        range: None,
        choices: Vec::new(),
        conserves: None,
        reciprocal: None,
        color: false,
        default: None,
        declared,
        place,
    };
    let scalar = match declared {
        Declared::Constant(scalar) => scalar,
        Declared::Member(kind) => kind.scalar(),
    };
    let mut default_bytes = None;
    while !cursor.at_end() {
        if cursor.peek('=') {
            let Declared::Member(kind) = declared else {
                let message = "a constant's default stands in its declaration, not after //@ui";
                return Err(cursor.place().error(None, message));
            };
            cursor.take('=');
            let (bytes, values) = default(cursor, kind)?;
            (ui.default, default_bytes) = (Some(values), Some(bytes));
            continue;
        }
        if let Some(claim) = claim(cursor) {
            let names = Some(claimed(cursor, &ui.choices)?);
            *(if claim == "conserves" { &mut ui.conserves } else { &mut ui.reciprocal }) = names;
            continue;
        }
        let (bytes, word) = cursor.word();
        match word {
            "color" => ui.color = true,
            "choice" if matches!(scalar, Scalar::Bool | Scalar::Float) => {
                return Err(cursor.error(bytes, "a choice must be int or uint"));
            }
            "choice" => ui.choices = choices(cursor, scalar)?,
            word if word.contains("..") && scalar == Scalar::Bool => {
                return Err(cursor.error(bytes, "a bool has no range"));
            }
            word if word.contains("..") => ui.range = Some(range(cursor, bytes, word, scalar)?),
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
        Declared::Constant(_) if ui.color => "a constant cannot be a color",
        _ => {
            let given = ui.default.as_deref().and_then(|values| values.first());
            return match given.and_then(|value| outside_of_choices(&ui.choices, *value)) {
                Some(message) => Err(cursor.error(default_bytes.unwrap_or_default(), message)),
                None => Ok(ui),
            };
        }
    };
    Err(cursor.place().error(None, message))
}

/// A message if there are choices and `default` is not one of them.
pub fn outside_of_choices(choices: &[(String, i64)], default: f64) -> Option<String> {
    if choices.is_empty() || choices.iter().any(|(_, value)| *value as f64 == default) {
        return None;
    }
    let list: Vec<String> = choices.iter().map(|(name, value)| format!("{name}={value}")).collect();
    Some(format!("expected a default among the choices {}, found {default}", list.join(" ")))
}

/// Parses `layout(constant_id = ...) const TYPE NAME` or the member `TYPE NAME;`.
fn ui_declaration(cursor: &Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<(Declared, String), Box<Diagnostic>> {
    let error = |message: String| Err(cursor.place().error(None, message));
    let words: Vec<&str> = declaration.map(|line| tokens(&line.code)).unwrap_or_default().iter().map(|t| t.1).collect();
    if words.contains(&"constant_id") {
        let at = words.iter().position(|word| *word == "const");
        let scalar = match at.and_then(|at| words.get(at + 1).copied()) {
            Some("bool") => Some(Scalar::Bool),
            Some("int") => Some(Scalar::Int),
            Some("uint") => Some(Scalar::Uint),
            Some("float") => Some(Scalar::Float),
            _ => None,
        };
        return match (scalar, at.and_then(|at| words.get(at + 2))) {
            (Some(scalar), Some(name)) if name.starts_with(is_word) => {
                Ok((Declared::Constant(scalar), (*name).to_owned()))
            }
            _ => error(
                "expected `layout(constant_id = ...) const TYPE NAME = DEFAULT;` on one line with TYPE one of \
                 bool, int, uint and float"
                    .to_owned(),
            ),
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

/// Turns a name into a label: `rim_strength` into `Rim strength`, `WRAP_DIFFUSE` into `Wrap diffuse`.
fn label_of(name: &str) -> String {
    let words = name.replace('_', " ").to_lowercase();
    let mut chars = words.trim().chars();
    chars.next().map_or_else(|| name.to_owned(), |first| first.to_uppercase().chain(chars).collect())
}
