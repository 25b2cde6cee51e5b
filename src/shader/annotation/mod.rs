//! Reads the `//@` comments with which shader authors declare debug modes, constants and parameters.
//!
//! ```glsl
//! //@mode d "Normal distribution D" group="BRDF terms" encode=data doc="GGX"
//! const uint MODE_BRDF_D = 120u;
//! layout(constant_id = USER_CONSTANTS + 0) const bool WRAP = false;   //@ui "Wrapped diffuse"
//! layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {
//!     float rim;         //@ui "Rim" 0..1 = 0.2
//!     vec3  rim_color;   //@ui color = 1 0.8 0.6
//! };
//! //@pass glow "Glow" size=1/4 mips
//! //@texture noise "noise.png" linear repeat
//! ```
//!
//! `//@pass` and `//@texture` stand anywhere in their file ([`pass`]). Another annotation follows its declaration on the same line, or is on the line before it.

mod cursor;
mod parse;
pub mod pass;
mod value;

use std::collections::BTreeMap;

use serde::Serialize;

use crate::interface;

use self::cursor::Place;
use crate::shader::compile::StageKind;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::spirv::reflect::{Reflection, Scalar};
use parse::{Declared, Found, Ui, outside_of_choices, parse_file};
use pass::{PassNote, TextureNote};

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

/// The fragment stage that computes a mode's value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub enum ModeStage {
    /// The picture.
    #[serde(rename = "pbr.frag")]
    Picture,
    /// Channels, terms and checks.
    #[default]
    #[serde(rename = "debug.frag")]
    Debug,
    /// Random paths.
    #[serde(rename = "paths.frag")]
    Paths,
}

impl ModeStage {
    /// The path of the stage in the shader tree.
    pub const fn path(self) -> &'static str {
        match self {
            Self::Picture => "pbr.frag",
            Self::Debug => "debug.frag",
            Self::Paths => "paths.frag",
        }
    }
}

/// A debug mode.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
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
    /// Whether exposure and tone mapping apply.
    pub tonemap: bool,
    /// Whether the view averages frames, each of which is a noisy estimate.
    pub accumulate: bool,
    /// The stage that computes the value.
    pub stage: ModeStage,
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
    /// A description of the mode.
    pub doc: String,
    /// File as printed.
    #[serde(skip)]
    pub file: String,
    /// 1-based line of the annotation.
    #[serde(skip)]
    pub line: u32,
}

/// A specialization constant of the author. A change builds new pipelines.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Constant {
    /// Name in GLSL; the key in `settings.shader`.
    pub name: String,
    /// `constant_id`
    pub id: u32,
    /// Name for people.
    pub label: String,
    /// Type.
    #[serde(skip)]
    pub scalar: Scalar,
    /// Bits of the default; 0 or 1 for `bool`.
    pub default: u32,
    /// Smallest and largest value.
    pub range: Option<(f64, f64)>,
    /// Named values; empty if all values are allowed.
    pub choices: Vec<(String, i64)>,
    /// Choices that claim never to reflect more light than arrives. `None` if the constant does not affect that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conserves: Option<Vec<String>>,
    /// Choices that claim to be reciprocal: the same with light and eye exchanged. `None` if the constant does not affect that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reciprocal: Option<Vec<String>>,
    /// File as printed.
    #[serde(skip)]
    pub file: String,
    /// 1-based line of the annotation.
    #[serde(skip)]
    pub line: u32,
}

/// Type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ParameterType {
    /// `float`
    Float,
    /// `int`
    Int,
    /// `uint`
    Uint,
    /// `bool`, four bytes in a block.
    Bool,
    /// `vec2`
    Vec2,
    /// `vec3`
    Vec3,
    /// `vec4`
    Vec4,
}

impl ParameterType {
    /// The type of its components.
    pub fn scalar(self) -> Scalar {
        match self {
            Self::Int => Scalar::Int,
            Self::Uint => Scalar::Uint,
            Self::Bool => Scalar::Bool,
            Self::Float | Self::Vec2 | Self::Vec3 | Self::Vec4 => Scalar::Float,
        }
    }

    /// Number of components.
    pub fn components(self) -> usize {
        match self {
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            _ => 1,
        }
    }
}

/// A member of the author's `Params` block, or of a pass's own uniform block. A change only updates a uniform buffer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Name in GLSL; the key in `settings.shader`.
    pub name: String,
    /// Name for people.
    pub label: String,
    /// Bytes from the start of `Params`; `None` for a member of a pass's own block.
    pub offset: Option<u32>,
    /// Type.
    #[serde(rename = "type")]
    pub kind: ParameterType,
    /// Smallest and largest value.
    pub range: Option<(f64, f64)>,
    /// One number per component; a `bool` is 0 or 1.
    pub default: Vec<f64>,
    /// Whether the panel shows a color picker (linear RGB).
    pub color: bool,
    /// Named values; empty for free choice.
    pub choices: Vec<(String, i64)>,
    /// File as printed.
    #[serde(skip)]
    pub file: String,
    /// 1-based line of the annotation.
    #[serde(skip)]
    pub line: u32,
}

/// All annotations of a tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Annotations {
    /// Ordered by id.
    pub modes: Vec<Mode>,
    /// Ordered by id.
    pub constants: Vec<Constant>,
    /// Ordered by offset in `Params`, then those of passes by file and line.
    pub parameters: Vec<Parameter>,
    /// Ordered by name.
    pub passes: Vec<PassNote>,
    /// Ordered by name.
    pub textures: Vec<TextureNote>,
}

/// Reads the annotations of `files`. Ids, defaults and offsets come from the compiled modules.
///
/// # Errors
/// Annotations that do not parse, duplicate names, slugs or ids, and a `//@ui` on a declaration that no module has.
pub fn read<'p>(
    snapshot: &Snapshot<'_>,
    files: impl IntoIterator<Item = &'p TreePath>,
    modules: &[&Reflection],
) -> Result<Annotations, Vec<Diagnostic>> {
    let mut out = Annotations::default();
    let mut errors = Vec::new();
    let mut seen = Seen::default();
    for path in files {
        let Ok(text) = snapshot.read(path) else { continue };
        let file = snapshot.display_path(path);
        let (found, bad) = parse_file(&file, &text);
        errors.extend(bad);
        for found in found {
            let added = match found {
                Found::Mode(mode, place) => seen.mode(&mode, &place).map(|()| out.modes.push(mode)),
                Found::Ui(ui) => seen.ui(&ui).and_then(|()| resolve(ui, modules, &mut out)),
                Found::Pass(note) => {
                    let note = PassNote { stage: path.to_string(), ..note };
                    match StageKind::of(path) {
                        Some(StageKind::Fragment | StageKind::Compute) => {
                            seen.pass(&note).map(|()| out.passes.push(note))
                        }
                        _ => {
                            let message = "a pass is a file with main() that ends in .frag or .comp";
                            Err(Box::new(note.place.error(message)))
                        }
                    }
                }
                Found::Texture(note) => seen.texture(&note).map(|()| {
                    out.textures.push(TextureNote { declared_in: path.to_string(), ..note });
                }),
            };
            errors.extend(added.err().map(|error| *error));
        }
    }
    out.modes.sort_by_key(|mode| mode.id);
    out.constants.sort_by_key(|constant| constant.id);
    out.parameters.sort_by(|a, b| {
        let key = |p: &Parameter| (p.offset.is_none(), p.offset, p.file.clone(), p.line);
        key(a).cmp(&key(b))
    });
    out.passes.sort_by(|a, b| a.name.cmp(&b.name));
    out.textures.sort_by(|a, b| a.name.cmp(&b.name));
    if let Some(pair) = out.constants.windows(2).find(|pair| pair[0].id == pair[1].id) {
        let message = format!("constant_id {} is given twice: `{}` and `{}`", pair[0].id, pair[0].name, pair[1].name);
        let note = format!("the other is at {}:{}", pair[0].file, pair[0].line);
        errors.push(Diagnostic::error(&pair[1].file, message).on_line(pair[1].line, None).with_note(note));
    }
    if errors.is_empty() { Ok(out) } else { Err(errors) }
}

/// Whether a stage declares a pass that is off unless the user switches it on.
pub fn is_off(snapshot: &Snapshot<'_>, stage: &TreePath) -> bool {
    let Ok(text) = snapshot.read(stage) else { return false };
    parse_file("", &text).0.iter().any(|found| matches!(found, Found::Pass(note) if !note.on))
}

/// The first occurrence of each name.
#[derive(Default)]
struct Seen(BTreeMap<(&'static str, String), (String, u32)>);

impl Seen {
    fn mode(&mut self, mode: &Mode, place: &Place) -> Result<(), Box<Diagnostic>> {
        self.first("mode slug", &mode.slug, place)?;
        self.first("mode id", &mode.id.to_string(), place)?;
        self.first("mode name", &mode.name, place)?;
        match mode.key {
            Some(key) => self.first("mode key", &key.to_string(), place),
            None => Ok(()),
        }
    }

    fn ui(&mut self, ui: &Ui) -> Result<(), Box<Diagnostic>> {
        // Constants and parameters share a name space, since `Settings::shader` has one table for both.
        self.first("//@ui name", &ui.name, &ui.place)
    }

    fn pass(&mut self, note: &PassNote) -> Result<(), Box<Diagnostic>> {
        let error = |message| Box::new(note.place.error(message));
        self.only("//@pass of", &note.stage, (&note.place.file, note.place.line), error)?;
        self.only("pass or texture", &note.name, (&note.place.file, note.place.line), error)
    }

    fn texture(&mut self, note: &TextureNote) -> Result<(), Box<Diagnostic>> {
        let place = (note.place.file.as_str(), note.place.line);
        self.only("pass or texture", &note.name, place, |message| Box::new(note.place.error(message)))
    }

    fn first(&mut self, what: &'static str, value: &str, place: &Place) -> Result<(), Box<Diagnostic>> {
        self.only(what, value, (&place.file, place.line), |message| place.error(None, message))
    }

    fn only(
        &mut self,
        what: &'static str,
        value: &str,
        (file, line): (&str, u32),
        error: impl Fn(String) -> Box<Diagnostic>,
    ) -> Result<(), Box<Diagnostic>> {
        match self.0.insert((what, value.to_owned()), (file.to_owned(), line)) {
            None => Ok(()),
            Some((file, line)) => {
                let error = error(format!("{what} `{value}` is given twice"));
                Err(Box::new(error.with_note(format!("the other is at {file}:{line}"))))
            }
        }
    }
}

/// Combines a `//@ui` with its declaration in the compiled modules.
fn resolve(ui: Ui, modules: &[&Reflection], out: &mut Annotations) -> Result<(), Box<Diagnostic>> {
    let Ui { name, label, range, choices, conserves, reciprocal, color, default, declared, place } = ui;
    let (file, line) = (place.file.clone(), place.line);
    match declared {
        Declared::Constant(_) => {
            let found = modules.iter().flat_map(|module| &module.constants).find(|constant| constant.name == name);
            let Some(found) = found else {
                return Err(place.error(None, format!("`{name}` is in no compiled stage, so //@ui cannot set it")));
            };
            let value = match found.scalar {
                Scalar::Int => f64::from(found.default.cast_signed()),
                _ => f64::from(found.default),
            };
            if let Some(message) = outside_of_choices(&choices, value) {
                return Err(place.error(None, message));
            }
            let (id, scalar, default) = (found.id, found.scalar, found.default);
            out.constants.push(Constant {
                name,
                id,
                label,
                scalar,
                default,
                range,
                choices,
                conserves,
                reciprocal,
                file,
                line,
            });
        }
        Declared::Member(kind) => {
            let offset = match in_a_pass(&name, modules) {
                true => None,
                false => Some(offset_in_params(&name, modules, &place)?),
            };
            let default = default.unwrap_or_else(|| match choices.first() {
                // Without a default it is 0, or the first choice if 0 is not a choice.
                Some((_, first)) if outside_of_choices(&choices, 0.0).is_some() => vec![*first as f64],
                _ => vec![0.0; kind.components()],
            });
            out.parameters.push(Parameter { name, label, offset, kind, range, default, color, choices, file, line });
        }
    }
    Ok(())
}

/// Whether `name` is a member of a pass's own uniform block.
fn in_a_pass(name: &str, modules: &[&Reflection]) -> bool {
    let own = modules.iter().flat_map(|module| &module.descriptors).filter(|found| found.set == interface::SET_PASS);
    own.filter_map(|found| found.block.as_ref()).any(|block| block.members.iter().any(|member| member.name == name))
}

/// The offset of a member of `Params`. It must be the same in every module, since all share one buffer.
fn offset_in_params(name: &str, modules: &[&Reflection], place: &Place) -> Result<u32, Box<Diagnostic>> {
    let params = interface::BINDINGS.iter().find(|binding| binding.name == "BINDING_PARAMS");
    let blocks = modules.iter().filter_map(|module| module.descriptor(params?.set, params?.binding)?.block.as_ref());
    let mut offsets: Vec<u32> = blocks
        .flat_map(|block| &block.members)
        .filter(|member| member.name == name)
        .map(|member| member.offset)
        .collect();
    offsets.dedup();
    match offsets.as_slice() {
        [only] => Ok(*only),
        [] => {
            let message =
                format!("`{name}` is no member of the block at SET_FRAME, BINDING_PARAMS in any compiled stage");
            Err(place.error(None, message))
        }
        [first, other, ..] => {
            let message = format!("`{name}` is at byte {first} in one stage and at byte {other} in another");
            let help = "declare the Params block once, in a file that all stages include";
            Err(Box::new(place.error(None, message).with_help(help)))
        }
    }
}

// These tests run the compiler.
#[cfg(test)]
mod tests;
