//! The files of a toy that draw images, and the channels by which each reads the others.

use std::collections::BTreeSet;

use super::adapt::{self, has_key_functions, uses};
use super::channel::{Channel, Kind, channel_of, channels};
use super::declared::{self, BEFORE};
use crate::shader::glsl::code;

/// The image of a channel that names none.
pub(super) const NOISE: &str = "toy/noise.png";
/// The image of a sampler that nothing names.
pub(super) const BLACK: &str = "toy/black.png";
/// The pass that draws the state of the keys, for files that read it.
pub(super) const KEYBOARD: &str = "toy_keyboard";
/// Shadertoy has four buffers.
pub(super) const BUFFERS: [&str; 4] = ["buffer_a", "buffer_b", "buffer_c", "buffer_d"];

/// The names before the number of an image that glslViewer draws from a part of a file: its sampler, and the macro of the part.
const PARTS: [(&str, &str); 2] = [(declared::PARTS[0], "BUFFER_"), (declared::PARTS[1], "DOUBLE_BUFFER_")];
/// Images of the built-in tree that a file can read.
const IMAGES: [&str; 4] = ["picture", "depth", "behind", KEYBOARD];
/// Most parts of a file.
const MAX_PARTS: usize = 8;

/// A file that draws an image.
pub(super) struct Drawing {
    /// The name of its pass.
    pub(super) pass: String,
    /// The file, relative to the folder.
    pub(super) file: String,
    pub(super) text: String,
    /// The macro that selects its part of the file, where one file draws several images, as in glslViewer: `BUFFER_0`.
    pub(super) part: Option<String>,
}

/// The images that a file of glslViewer draws before its own: one for each number of `BUFFER_0` or `DOUBLE_BUFFER_0`.
pub(super) fn parts(file: &str, text: &str) -> Vec<Drawing> {
    let part = |number: usize| {
        let macros = PARTS.map(|(_, part)| format!("{part}{number}"));
        let part = macros.into_iter().find(|part| uses(text, part))?;
        Some(Drawing { pass: format!("part_{number}"), file: file.to_owned(), text: text.to_owned(), part: Some(part) })
    };
    if text.contains("BUFFER_") { (0..MAX_PARTS).filter_map(part).collect() } else { Vec::new() }
}

/// The samplers in glslViewer's names, and the names of the passes that they read.
fn parts_read(text: &str) -> Vec<(String, String)> {
    let names = PARTS.iter().flat_map(|(sampler, _)| (0..MAX_PARTS).map(move |number| (sampler, number)));
    let read = names.map(|(sampler, number)| (format!("{sampler}{number}"), format!("part_{number}")));
    read.filter(|(sampler, _)| uses(text, sampler)).collect()
}

/// Whether the last drawing's image of the previous frame is read, so that it cannot be drawn to the picture itself.
pub(super) fn keeps_image(drawings: &[Drawing]) -> bool {
    let Some(image) = drawings.last() else { return false };
    let reads = |drawing: &Drawing| {
        let is_own = drawing.file == image.file;
        channels(&drawing.text).iter().any(|(_, channel)| match channel {
            Channel::This => is_own,
            Channel::Drawing(file) => *file == image.file,
            Channel::Image(..) | Channel::Keyboard => false,
        })
    };
    drawings.iter().any(reads) || BEFORE.iter().any(|name| uses(&image.text, name))
}

/// The samplers of drawings whose image nothing names, as type and name, each with the index of the first drawing that declares it.
pub(super) fn without_image(drawings: &[Drawing]) -> Vec<(usize, [String; 2])> {
    let is_named = |name: &str| {
        let pass = name.strip_prefix("before_").unwrap_or(name);
        IMAGES.contains(&pass)
            || declared::is_built_in(name)
            || drawings.iter().any(|drawing| drawing.pass == pass || declared::has_texture(&drawing.text, name))
    };
    let mut out: Vec<(usize, [String; 2])> = Vec::new();
    for (place, drawing) in drawings.iter().enumerate() {
        for (kind, name) in declared::samplers(&code(&drawing.text)) {
            if !is_named(name) && out.iter().all(|(_, [_, other])| other != name) {
                out.push((place, [kind, name].map(str::to_owned)));
            }
        }
    }
    out
}

/// Declares the channels that a drawing, or the text that all files share, uses.
pub(super) fn declarations(drawings: &[Drawing], index: usize, shared: &str) -> String {
    let Drawing { pass, text, .. } = &drawings[index];
    let named = channels(text);
    // A channel reads what was drawn earlier in this frame, or otherwise the previous frame.
    let of_frame = |place: usize| match place < index {
        true => drawings[place].pass.clone(),
        false => format!("before_{}", drawings[place].pass),
    };
    let (mut lines, mut sizes) = (BTreeSet::new(), Vec::new());
    for (number, buffer) in BUFFERS.iter().enumerate() {
        let name = format!("iChannel{number}");
        let aliases = aliases(text, number);
        if aliases.is_empty() && !uses(text, &name) && !uses(shared, &name) {
            sizes.push("vec3(0.0)".to_owned());
            continue;
        }
        let mut kind = Kind::Flat;
        let drawn = |is_it: &dyn Fn(&Drawing) -> bool| drawings.iter().position(is_it).map(of_frame);
        let sampler = match named.iter().find(|(channel, _)| *channel == number).map(|(_, channel)| channel) {
            Some(Channel::This) => Some(format!("before_{pass}")),
            Some(Channel::Drawing(file)) => drawn(&|drawing| drawing.file == *file),
            Some(Channel::Image(_, sampler)) => {
                kind = sampler.kind;
                Some(adapt::texture_name(pass, number))
            }
            Some(Channel::Keyboard) => Some(KEYBOARD.to_owned()),
            None => drawn(&|drawing| drawing.pass == *buffer),
        };
        let sampler = sampler.unwrap_or_else(|| {
            lines.insert(format!("//@texture {pass}_noise \"{NOISE}\" linear mips\n"));
            lines.insert("#include \"toy/kinds.glsl\"\n".to_owned());
            format!("{pass}_noise")
        });
        sizes.push(match kind {
            Kind::Volume => format!("vec3(textureSize({name}, 0))"),
            Kind::Flat | Kind::Cube => format!("vec3(textureSize({name}, 0), 1.0)"),
        });
        lines.insert(format!("uniform {} {sampler};\n", kind.glsl()));
        lines.extend(aliases.iter().chain([&name]).map(|name| format!("#define {name} {sampler}\n")));
    }
    for (name, pass) in parts_read(text) {
        let sampler = drawings.iter().position(|drawing| drawing.pass == pass).map(of_frame);
        lines.insert(format!("uniform sampler2D {};\n", sampler.as_ref().unwrap_or(&name)));
        lines.extend(sampler.map(|sampler| format!("#define {name} {sampler}\n")));
    }
    for name in BEFORE.iter().filter(|name| uses(text, name)) {
        lines.insert(format!("uniform sampler2D before_{pass};\n#define {name} before_{pass}\n"));
    }
    if has_key_functions(text) || has_key_functions(shared) {
        lines.insert(format!("uniform sampler2D {KEYBOARD};\n"));
    }
    let black = without_image(drawings).into_iter().filter(|(place, _)| *place == index);
    let layers = |kind: &str| if matches!(kind, "sampler3D" | "sampler2DArray") { " layers=2" } else { "" };
    lines.extend(black.map(|(_, [kind, name])| format!("//@texture {name} \"{BLACK}\"{}\n", layers(&kind))));
    lines.insert(format!("#define iChannelResolution vec3[4]({})\n", sizes.join(", ")));
    lines.into_iter().collect()
}

/// The samplers and sizes of glslViewer's names that a text declares for a channel: `u_tex0`, `u_tex0Resolution`.
fn aliases(text: &str, number: usize) -> Vec<String> {
    let code = code(text);
    let declared = declared::declarations(&code).into_iter().flat_map(|declaration| declaration.names);
    let of_channel = declared.map(|name| name.text.strip_suffix("Resolution").unwrap_or(name.text));
    let mut names: Vec<String> =
        of_channel.filter(|name| channel_of(name) == Some(number)).map(str::to_owned).collect();
    names.retain(|name| !declared::has_texture(text, name));
    names.dedup();
    names
}
