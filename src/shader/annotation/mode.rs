//! `//@mode`: a debug mode, and how its annotation is parsed.

use std::ops::Range;

use clap::ValueEnum as _;
use serde::Serialize;

use super::cursor::Cursor;
use super::place::AnnotationPlace;
use super::value;
use crate::interface;
use crate::message::{did_you_mean, either};
use crate::settings::Colormap;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::Line;
use crate::shader::spirv::reflect::Scalar;

/// The keys that the window reserves.
const WINDOW_KEYS: &str = "h r l q 0-9 [ ]";

/// How the tone map stores a mode's values as 8-bit pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Encode {
    /// Linear color, sRGB-encoded.
    #[default]
    Color,
    /// Numbers, stored as they are.
    Data,
    /// Vectors, stored as `v * 0.5 + 0.5`.
    Vector,
}

impl Mode {
    /// Whether a model with these `FEATURE_*` bits has data for the mode. True without a model.
    pub fn has_data(&self, features: Option<u32>) -> bool {
        self.needs == 0 || features.is_none_or(|features| features & self.needs != 0)
    }

    /// Whether the value comes from random paths or from rays through the model, which take seconds a frame on a software device.
    pub fn follows_paths(&self) -> bool {
        self.accumulate || self.traces || self.stage == PATHS_STAGE
    }
}

impl Encode {
    /// The `interface::ENCODE_*` number.
    pub fn id(self) -> u32 {
        match self {
            Self::Color => interface::ENCODE_COLOR,
            Self::Data => interface::ENCODE_DATA,
            Self::Vector => interface::ENCODE_VECTOR,
        }
    }
}

/// The meaning of a number for which a picture shows a color. The mode gives the number itself where a single pixel is read:
/// `Frame::gives_numbers`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// An index, from 0.
    Index,
    /// Names of 0, 1, ...
    Names(Vec<String>),
}

/// How a mode draws the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DrawAs {
    /// Its surfaces.
    #[default]
    Surfaces,
    /// The edges of its triangles.
    Lines,
    /// The sum of all fragments, hidden or not: overdraw.
    Layers,
}

/// The stage of modes that name none.
const DEBUG_STAGE: &str = "debug.frag";
/// The stage of modes that follow random paths. Such modes get what paths trace.
pub const PATHS_STAGE: &str = "paths.frag";

/// A debug mode.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Mode {
    /// Value of the specialization constant `MODE`.
    pub id: u32,
    /// Name on the command line and in file names.
    pub slug: String,
    /// Display name.
    pub name: String,
    /// Heading in lists; empty if the annotation has none.
    pub group: String,
    /// How its values are stored.
    pub encode: Encode,
    /// Number of components of a value, 1 to 3. The shader repeats a scalar in all channels.
    #[serde(skip)]
    pub components: u8,
    /// Unit of the value before exposure; empty for none.
    #[serde(skip)]
    pub unit: String,
    /// The values that the picture shows as 0 and 1; `None` for those of the encoding.
    #[serde(skip)]
    pub range: Option<(f32, f32)>,
    /// The colors that stand for its numbers.
    #[serde(skip)]
    pub colormap: Colormap,
    /// The meaning of its numbers, if the picture shows a color for each.
    #[serde(skip)]
    pub numbers: Option<Numbers>,
    /// The sRGB colors of named numbers, in the order of their names; `None` where the color follows the picture.
    #[serde(skip)]
    pub number_colors: Vec<Option<[u8; 3]>>,
    /// Whether exposure and tone mapping apply.
    pub tonemap: bool,
    /// Whether its values are those of the display, after the tone map.
    #[serde(skip)]
    pub is_displayed: bool,
    /// Whether the view averages frames, each of which is a noisy estimate.
    pub accumulate: bool,
    /// Path of the fragment stage that computes the value. A pass draws the model with it.
    pub stage: String,
    /// Whether the mode traces rays through the model, which needs its bounding volume hierarchy.
    pub traces: bool,
    /// Whether transmissive surfaces show the final picture behind them instead of this mode.
    pub through: bool,
    /// How the model is drawn.
    pub draw: DrawAs,
    /// The pass whose image the mode shows; such modes need no annotation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pass: Option<String>,
    /// Key in the window.
    pub key: Option<char>,
    /// `FEATURE_*` bits: without any of them in the model, the mode has nothing to show. 0: it always has.
    #[serde(skip)]
    pub needs: u32,
    /// A description of the mode.
    pub doc: String,
    /// More words by which a search finds it.
    #[serde(skip)]
    pub words: String,
    /// File as printed.
    #[serde(skip)]
    pub file: String,
    /// 1-based line of the annotation.
    #[serde(skip)]
    pub line: u32,
}

/// Parses the rest of a `//@mode`, whose id stands in `declaration`. Returns where the id stands, too.
pub(super) fn mode(
    cursor: &mut Cursor<'_>,
    declaration: Option<&Line<'_>>,
) -> Result<(Mode, AnnotationPlace), Box<Diagnostic>> {
    let (bytes, slug) = cursor.word();
    let valid = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if slug.is_empty() || !slug.chars().all(valid) {
        let message = format!("expected the mode's slug in a-z, 0-9 and `-`, found `{slug}`");
        return Err(cursor.error(bytes, message));
    }
    let Some(name) = cursor.string()? else {
        return Err(cursor.expected("the mode's name in quotes"));
    };
    let (id, number) = mode_id(cursor, declaration)?;
    let mut mode = Mode {
        id,
        slug: slug.to_owned(),
        name,
        components: 3,
        stage: DEBUG_STAGE.to_owned(),
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
        set(&mut mode, key, bytes, cursor)?;
    }
    if mode.traces && mode.stage != PATHS_STAGE {
        return Err(cursor.expected("stage=paths beside `traces`: only paths.frag can trace rays"));
    }
    Ok((mode, number))
}

/// Sets the property `key` of a mode, with the value that follows if it has one.
fn set(mode: &mut Mode, key: &str, bytes: Range<usize>, cursor: &mut Cursor<'_>) -> Result<(), Box<Diagnostic>> {
    match key {
        "tonemap" => mode.tonemap = true,
        "accumulate" => mode.accumulate = true,
        "traces" => mode.traces = true,
        "through" => mode.through = true,
        "group" => mode.group = cursor.value(key)?.1,
        "doc" => mode.doc = cursor.value(key)?.1,
        "words" => mode.words = cursor.value(key)?.1,
        "unit" => mode.unit = cursor.value(key)?.1,
        "components" => mode.components = cursor.one_of(key, &[("1", 1), ("2", 2), ("3", 3)])?,
        "encode" => {
            let all = [("color", Encode::Color), ("data", Encode::Data), ("vector", Encode::Vector)];
            mode.encode = cursor.one_of(key, &all)?;
        }
        "stage" => mode.stage = format!("{}.frag", cursor.value(key)?.1),
        "draw" => {
            let all = [("surfaces", DrawAs::Surfaces), ("lines", DrawAs::Lines), ("layers", DrawAs::Layers)];
            mode.draw = cursor.one_of(key, &all)?;
        }
        "key" => mode.key = Some(window_key(cursor)?),
        "needs" => mode.needs = features(cursor)?,
        "range" => {
            let (bytes, text) = cursor.value(key)?;
            let (low, high) = value::range(cursor, bytes, &text, Scalar::Float)?;
            mode.range = Some((low as f32, high as f32));
        }
        "colormap" => mode.colormap = colormap(cursor)?,
        "numbers" => mode.numbers = Some(numbers(cursor)?),
        "colors" => mode.number_colors = number_colors(cursor, mode.numbers.as_ref())?,
        other => {
            let known = "group=, encode=, components=, unit=, stage=, tonemap, accumulate, traces, through, draw=, needs=, \
                range=, colormap=, numbers=, colors=, key=, words= or doc=";
            return Err(cursor.error(bytes, format!("expected {known}, found `{other}`")));
        }
    }
    Ok(())
}

/// Reads the value of `colormap=`: a name that `view.colormap` takes.
fn colormap(cursor: &mut Cursor<'_>) -> Result<Colormap, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("colormap")?;
    Colormap::from_str(&value, false).map_err(|_| {
        let known =
            Colormap::value_variants().iter().filter_map(|map| Some(map.to_possible_value()?.get_name().to_owned()));
        let known: Vec<String> = known.collect();
        let hint = did_you_mean(&value, known.iter().map(String::as_str));
        cursor.error(
            bytes,
            format!("expected a colormap after colormap=, found `{value}`.{hint} It can be {}", either(&known)),
        )
    })
}

/// Reads the value of `numbers=`: `index`, or names with `|` between them.
fn numbers(cursor: &mut Cursor<'_>) -> Result<Numbers, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("numbers")?;
    if value == "index" {
        return Ok(Numbers::Index);
    }
    let names: Vec<String> = value.split('|').map(|name| name.trim().to_owned()).collect();
    if names.len() < 2 || names.iter().any(String::is_empty) {
        let message = format!("expected numbers=index or names as numbers=\"front|back\", found `{value}`");
        return Err(cursor.error(bytes, message));
    }
    Ok(Numbers::Names(names))
}

/// Reads the value of `colors=`: `#rrggbb` for each name of `numbers`, or `-` for one without a color of its own.
fn number_colors(cursor: &mut Cursor<'_>, numbers: Option<&Numbers>) -> Result<Vec<Option<[u8; 3]>>, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("colors")?;
    let color = |text: &str| match text.trim() {
        "-" => Some(None),
        text => {
            let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
            let hex = u32::from_str_radix(digits, 16).ok()?;
            let [_, r, g, b] = hex.to_be_bytes();
            Some(Some([r, g, b]))
        }
    };
    let colors: Option<Vec<Option<[u8; 3]>>> = value.split('|').map(color).collect();
    match (colors, numbers) {
        (Some(colors), Some(Numbers::Names(names))) if colors.len() == names.len() => Ok(colors),
        _ => {
            let message = format!(
                "expected a color for each name of the numbers= before it, as numbers=\"front|back\" \
                 colors=\"#3fbc59|-\", found `{value}`"
            );
            Err(cursor.error(bytes, message))
        }
    }
}

/// Reads the value of `needs=`: names of `FEATURE_*` constants in small letters, with `-` for `_`.
fn features(cursor: &mut Cursor<'_>) -> Result<u32, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("needs")?;
    let mut bits = 0;
    for name in value.split(',') {
        let constant = format!("FEATURE_{}", name.trim().to_uppercase().replace('-', "_"));
        let Some((_, bit)) = interface::constants().find(|(known, _)| *known == constant) else {
            let known = interface::constants().filter_map(|(known, _)| known.strip_prefix("FEATURE_"));
            let known: Vec<String> = known.map(|name| name.to_lowercase().replace('_', "-")).collect();
            let hint = did_you_mean(name, known.iter().map(String::as_str));
            let message = format!(
                "expected features of materials after needs=, found `{name}`.{hint} They are {}",
                known.join(", ")
            );
            return Err(cursor.error(bytes, message));
        };
        bits |= bit;
    }
    Ok(bits)
}

/// Reads the value of `key=`.
fn window_key(cursor: &mut Cursor<'_>) -> Result<char, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("key")?;
    let mut chars = value.chars();
    let (Some(key), None) = (chars.next(), chars.next()) else {
        return Err(cursor.error(bytes, format!("expected one character after key=, found `{value}`")));
    };
    check_key(key).map_err(|message| cursor.error(bytes, message))?;
    Ok(key)
}

/// Checks that a mode may have this key. The window ignores case and reserves [`WINDOW_KEYS`].
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

/// The number of `const uint MODE_X = 120u;`, and where it stands.
fn mode_id(cursor: &Cursor<'_>, declaration: Option<&Line<'_>>) -> Result<(u32, AnnotationPlace), Box<Diagnostic>> {
    let found = declaration.map(|line| (line, line.tokens()));
    let words: Vec<&str> = found.iter().flat_map(|(_, tokens)| tokens).map(|token| token.text).collect();
    if let (["const", "uint", _, "=", literal, ";", ..], Some((line, tokens))) = (words.as_slice(), &found) {
        let digits = literal.trim_end_matches(['u', 'U']);
        let number = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
            Some(digits) => u32::from_str_radix(digits, 16),
            None => digits.parse(),
        };
        if let Ok(number) = number {
            let (file, raw) = (cursor.place().file.clone(), line.raw.to_owned());
            return Ok((number, AnnotationPlace { file, line: line.number, raw, bytes: tokens[4].bytes.clone() }));
        }
    }
    let found = declaration.map_or("the end of the file", |line| line.raw.trim());
    let message = format!("expected `const uint NAME = NUMBER;` with the mode, found `{found}`");
    Err(Box::new(cursor.place().error(message)))
}
