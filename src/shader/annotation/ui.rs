//! Parses `//@ui` with the declaration that it belongs to.

use super::ParameterType;
use super::cursor::Cursor;
use super::order::in_order;
use super::place::AnnotationPlace;
use super::value::{choices, claim, claimed, default, range, text_key};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{Line, is_word};
use crate::shader::spirv::reflect::Scalar;

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
    /// Description of each choice: the quoted text after the choice, or empty.
    pub choice_docs: Vec<String>,
    /// `conserves="A"`
    pub conserves: Option<Vec<String>>,
    /// `reciprocal="A B"`
    pub reciprocal: Option<Vec<String>>,
    /// `color`
    pub color: bool,
    /// `when=NAME`, before the default.
    pub when: Option<String>,
    /// `group="Material"`; empty for none.
    pub group: String,
    /// `doc="..."`: a sentence for people; may be empty.
    pub doc: String,
    /// `unit="m"`; empty for none.
    pub unit: String,
    /// `= ...`, one number per component.
    pub default: Option<Vec<f64>>,
    /// The annotated declaration.
    pub declared: Declared,
    /// Location of the annotation.
    pub place: AnnotationPlace,
}

/// Parses the rest of a `//@ui` that belongs to `declaration`. If its parts are in another order, the error shows them in order.
pub(super) fn ui(cursor: &mut Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<Ui, Box<Diagnostic>> {
    let text = cursor.rest();
    parts(cursor, declaration).map_err(|error| match in_order(text) {
        Some(sorted) => {
            Box::new(error.with_help(format!("the label comes first and the default last: `//@ui {sorted}`")))
        }
        None => error,
    })
}

fn parts(cursor: &mut Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<Ui, Box<Diagnostic>> {
    let (declared, name) = ui_declaration(cursor, declaration)?;
    let label = cursor.string()?;
    let label = label.unwrap_or_else(|| label_of(&name));
    let place = cursor.place().clone();
    let mut ui = Ui {
        name,
        label,
        range: None,
        choices: Vec::new(),
        choice_docs: Vec::new(),
        conserves: None,
        reciprocal: None,
        color: false,
        when: None,
        group: String::new(),
        doc: String::new(),
        unit: String::new(),
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
                return Err(cursor.error(cursor.position()..cursor.position() + 1, message));
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
        if matches!(declared, Declared::Member(_)) && cursor.peek_text("when=") {
            let (_, key) = cursor.key();
            ui.when = Some(cursor.value(key)?.1);
            continue;
        }
        if let Some(key) = text_key(cursor) {
            cursor.key();
            let value = cursor.value(key)?.1;
            *(match key {
                "group" => &mut ui.group,
                "unit" => &mut ui.unit,
                _ => &mut ui.doc,
            }) = value;
            continue;
        }
        let (bytes, word) = cursor.word();
        match word {
            "color" => ui.color = true,
            "choice" if matches!(scalar, Scalar::Bool | Scalar::Float) => {
                return Err(cursor.error(bytes, "a choice must be int or uint"));
            }
            "choice" => (ui.choices, ui.choice_docs) = choices(cursor, scalar)?,
            word if word.contains("..") && scalar == Scalar::Bool => {
                return Err(cursor.error(bytes, "a bool has no range"));
            }
            word if word.contains("..") => ui.range = Some(range(cursor, bytes, word, scalar)?),
            word => {
                let message = match word.starts_with('"') {
                    true => format!("expected the label before all else, found `{word}` here"),
                    false => format!(
                        "expected lo..hi, choice A=0 B=1, color, group=, doc=, unit= or = default, found `{word}`"
                    ),
                };
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
    Err(Box::new(cursor.place().error_at("color", message)))
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
    // The declaration may be on the next line.
    let error = |word: &str, message: String| Err(Box::new(cursor.place().error_at(word, message)));
    let tokens = declaration.map(Line::tokens).unwrap_or_default();
    let words: Vec<&str> = tokens.iter().map(|token| token.text).collect();
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
                "",
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
        return error("", "expected //@ui behind `TYPE NAME;` in Params, or behind a constant_id".to_owned());
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
            let message =
                format!("expected float, int, uint, bool, vec2, vec3 or vec4 before the name, found `{other}`");
            return error(other, message);
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
