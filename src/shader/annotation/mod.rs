//! Reads the `//@` comments with which shader authors declare debug modes, constants and parameters.
//!
//! ```glsl
//! //@mode d "Normal distribution D" group="BRDF terms" encode=data doc="GGX"
//! const uint MODE_BRDF_D = 120u;
//! layout(constant_id = USER_CONSTANTS + 0) const bool WRAP = false;   //@ui "Wrapped diffuse"
//! layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {
//!     float rim;         //@ui "Rim" 0..1 group="Material" doc="Its brightness" unit="cd/m^2" = 0.2
//!     vec3  rim_color;   //@ui color = 1 0.8 0.6
//! };
//! //@pass glow "Glow" size=1/4 mips
//! //@texture noise "noise.png" linear repeat
//! ```
//!
//! `//@pass` and `//@texture` stand anywhere in their file ([`pass`], [`texture`]). Any other annotation follows its declaration on
//! the same line, or is on the line before it.
//!
//! `conserves="A B"` and `reciprocal="A"` behind a list of choices name those that guarantee the property; a
//! combination guarantees what all of its choices do, and `specula brdf` checks it. A mode with `numbers=` shows a
//! color for each number, and gives the number itself where a single pixel is read (`FrameState::with_numbers`,
//! `frame.gives_numbers`); `PixelValue::text` and `json` say what it means. An annotation that does not parse is an
//! error with its line. Values are kept by name in `Settings::shader`, so they survive reloads in which offsets move.
//! Parameters go through a uniform buffer and cost nothing; constants build pipelines.

mod annotations;
mod cursor;
mod mode;
mod mode_list;
mod name;
pub mod options;
mod order;
mod parameter;
mod parse;
mod parse_pass;
pub mod pass;
pub mod place;
mod resolve;
pub mod texture;
mod ui;
mod value;

use std::collections::BTreeMap;

use crate::shader::compile::StageKind;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{TreePath, embedded};
use crate::shader::spirv::reflect::Reflection;
use parse::{Annotation, parse_file};
use pass::PassDesc;
use place::AnnotationPlace;
use resolve::resolve;
use texture::TextureDesc;
use ui::Ui;

pub use annotations::Annotations;
pub use mode::{DrawAs, Encode, Mode, Numbers, PATHS_STAGE};
pub use mode_list::{listed, neighbors};
pub use parameter::{Constant, Parameter, ParameterType};

/// Reads the annotations of `files`. Ids, defaults and offsets come from the compiled modules. `is_whole`: `files` are all of the
/// tree, so that the constant of a `when=` must be among them.
///
/// # Errors
/// Annotations that do not parse, duplicate names, slugs or ids, and a `//@ui` on a declaration that no module has.
pub fn read<'p>(
    snapshot: &Snapshot<'_>,
    files: impl IntoIterator<Item = &'p TreePath>,
    modules: &[&Reflection],
    is_whole: bool,
) -> Result<Annotations, Vec<Diagnostic>> {
    let mut out = Annotations::default();
    let mut errors = Vec::new();
    let mut seen = Seen::default();
    let mut places: BTreeMap<(String, u32), AnnotationPlace> = BTreeMap::new();
    for path in files {
        let Ok(text) = snapshot.read(path) else { continue };
        let file = snapshot.display_path(path);
        seen.is_shipped = embedded::read(None, path) == Some(text.as_bytes());
        let (found, bad) = parse_file(&file, &text);
        errors.extend(bad);
        for found in found {
            let added = match found {
                Annotation::Mode(mode, places) => seen.mode(&mode, &places).map(|()| out.modes.push(mode)),
                Annotation::Ui(ui) => {
                    places.insert((ui.place.file.clone(), ui.place.line), ui.place.clone());
                    seen.ui(&ui).and_then(|()| resolve(ui, modules, &mut out))
                }
                Annotation::Pass(desc) => {
                    let desc = PassDesc { stage: path.to_string(), ..desc };
                    match StageKind::of(path) {
                        Some(StageKind::Fragment | StageKind::Compute) => {
                            seen.pass(&desc).map(|()| out.passes.push(desc))
                        }
                        _ => {
                            let message = "a pass is a file with main() that ends in .frag or .comp";
                            Err(Box::new(desc.place.error(message)))
                        }
                    }
                }
                Annotation::Texture(desc) => seen.texture(&desc).map(|()| {
                    out.textures.push(TextureDesc { declared_in: path.to_string(), ..desc });
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
        let place = places.remove(&(pair[1].file.clone(), pair[1].line)).unwrap_or_default();
        errors.push(place.error_at(&pair[1].name, message).with_note(note));
    }
    errors.extend(out.parameters.iter().filter(|_| is_whole).filter_map(|parameter| {
        let message = out.unknown_constant(parameter.when.as_deref()?)?;
        let place = places.get(&(parameter.file.clone(), parameter.line))?;
        Some(place.error_at("when=", message))
    }));
    if errors.is_empty() { Ok(out) } else { Err(errors) }
}

/// The passes that a stage declares, without its errors.
pub fn passes_of(snapshot: &Snapshot<'_>, stage: &TreePath) -> impl Iterator<Item = PassDesc> {
    let found = snapshot.read(stage).map(|text| parse_file("", &text).0).unwrap_or_default();
    found.into_iter().filter_map(|found| match found {
        Annotation::Pass(desc) => Some(PassDesc { stage: stage.to_string(), ..desc }),
        _ => None,
    })
}

/// The first occurrence of each name.
#[derive(Default)]
struct Seen {
    /// Where the name occurs, and whether that file is unchanged from the shipped one.
    first: BTreeMap<(&'static str, String), (AnnotationPlace, bool)>,
    /// Whether the file that is being read is unchanged from the shipped one.
    is_shipped: bool,
}

impl Seen {
    fn mode(&mut self, mode: &Mode, [place, number]: &[AnnotationPlace; 2]) -> Result<(), Box<Diagnostic>> {
        self.first("mode slug", &mode.slug, place)?;
        self.first("mode id", &mode.id.to_string(), number)?;
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

    fn pass(&mut self, desc: &PassDesc) -> Result<(), Box<Diagnostic>> {
        self.first("//@pass of", &desc.stage, &desc.place)?;
        let names = std::iter::once(&desc.name).chain(desc.also.iter().map(|(name, _)| name));
        names.into_iter().try_for_each(|name| self.first("pass or texture", name, &desc.place))
    }

    fn texture(&mut self, desc: &TextureDesc) -> Result<(), Box<Diagnostic>> {
        self.first("pass or texture", &desc.name, &desc.place)
    }

    fn first(&mut self, what: &'static str, value: &str, place: &AnnotationPlace) -> Result<(), Box<Diagnostic>> {
        let now = (place.clone(), self.is_shipped);
        let Some((first, was_shipped)) = self.first.insert((what, value.to_owned()), now) else { return Ok(()) };
        // Report the author's file, not the shipped one.
        let (wrong, other) = if self.is_shipped && !was_shipped { (&first, place) } else { (place, &first) };
        let error = wrong.error_at(value, format!("{what} `{value}` is given twice"));
        Err(Box::new(error.with_note(format!("the other is at {}:{}", other.file, other.line))))
    }
}

// These tests run the compiler.
#[cfg(test)]
mod tests;
