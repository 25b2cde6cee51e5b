//! Finds the resources that a pass reads and writes, by the names of its declarations.

use super::{Input, PassStage};
use crate::interface::SET_PASS;
use crate::message::did_you_mean;
use crate::shader::annotation::pass::{PassFormat, PassNote, TextureNote};
use crate::shader::compile::StageKind;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::spirv::reflect::Descriptor;

/// The largest storage buffer in bytes. Every device can bind one of this size.
const LARGEST_BUFFER: u32 = 128 << 20;
/// The largest uniform block in bytes. Every device can bind one of this size.
const LARGEST_BLOCK: u32 = 16 << 10;

/// The block in pass.glsl that holds the size of a pass's image: a `vec2` in pixels.
const SIZE_BLOCK: &str = "Pass";

/// The names that a pass can read.
pub struct Names<'a> {
    /// All declared passes.
    pub passes: &'a [PassNote],
    /// All declared textures.
    pub textures: &'a [TextureNote],
}

/// The resource at each binding of a pass.
///
/// # Errors
/// A name that no pass or texture has, or a declaration that does not fit the resource of that name.
pub fn inputs(note: &PassNote, stage: &PassStage<'_>, names: &Names<'_>) -> Result<Vec<Input>, Vec<Diagnostic>> {
    let own = stage.reflection.descriptors.iter().filter(|found| found.set == SET_PASS);
    let (mut inputs, mut errors) = (Vec::new(), Vec::new());
    for (index, found) in own.enumerate() {
        let found_input = match found.binding as usize == index && !is_doubled(stage, found) {
            true => input(note, stage.kind, found, names),
            false => {
                let message = format!("`{}` has a binding of its own", found.name);
                Err((message, "leave out layout(set, binding): a pass declares what it reads by name alone".into()))
            }
        };
        match found_input {
            Ok(input) => inputs.push(input),
            Err((message, help)) => {
                let error = stage.texts.error(&[found.name.as_str(), "uniform"], message);
                errors.push(if help.is_empty() { error } else { error.with_help(help) });
            }
        }
    }
    if errors.is_empty() { Ok(inputs) } else { Err(errors) }
}

/// Whether another descriptor of the pass has the same binding.
fn is_doubled(stage: &PassStage<'_>, found: &Descriptor) -> bool {
    let same = |other: &&Descriptor| (other.set, other.binding) == (found.set, found.binding);
    stage.reflection.descriptors.iter().filter(same).count() > 1
}

/// A message, and a help text that may be empty.
type Refusal = (String, String);

fn input(note: &PassNote, kind: StageKind, found: &Descriptor, names: &Names<'_>) -> Result<Input, Refusal> {
    let Descriptor { name, glsl, .. } = found;
    match glsl.as_str() {
        "sampler2D" => sampled(note, name, names),
        "uniform block" if name == SIZE_BLOCK => Ok(Input::Size),
        "uniform block" => {
            let block = found.block.clone().unwrap_or_default();
            if block.size > LARGEST_BLOCK {
                let message =
                    format!("the uniform block `{name}` has {} bytes, at most {LARGEST_BLOCK} fit", block.size);
                return Err((message, String::new()));
            }
            let members = block.members.into_iter().map(|member| (member.offset, member.name)).collect();
            Ok(Input::Parameters(block.size.next_multiple_of(16), members))
        }
        "buffer block" => buffer(found),
        glsl if glsl.ends_with("image2D") && kind != StageKind::Compute => {
            let message = format!("a fragment shader cannot write the image `{name}`");
            Err((message, "it draws to the image of its pass; a compute shader (.comp) writes it by imageStore".into()))
        }
        glsl if glsl.ends_with("image2D") && name == &note.name => written(note, found),
        glsl if glsl.ends_with("image2D") => {
            let message = format!("`{name}` is not the image of this pass, which is `{}`", note.name);
            Err((message, "a pass writes its own image; it reads those of others as `uniform sampler2D`".into()))
        }
        other => {
            let message = format!("a pass cannot have {other} `{name}`");
            let help = "it can have sampler2D, its own image2D, a buffer block or a uniform block".to_owned();
            Err((message, help))
        }
    }
}

fn sampled(note: &PassNote, name: &str, names: &Names<'_>) -> Result<Input, Refusal> {
    let is_pass = |name: &str| names.passes.iter().find(|pass| pass.name == name);
    if let Some(before) = name.strip_prefix("before_") {
        return match is_pass(before) {
            Some(pass) if pass.keep => Ok(Input::Before(before.to_owned())),
            Some(pass) => {
                let message = format!("the image of `{before}` one frame ago is not kept");
                Err((message, format!("write `keep` in its //@pass ({}:{})", pass.place.file, pass.place.line)))
            }
            None => Err(unknown(name, names)),
        };
    }
    match name {
        "picture" => Ok(Input::Picture),
        "depth" => Ok(Input::Depth),
        name if name == note.name => {
            let message = format!("a pass cannot read the image that it draws, `{name}`");
            Err((message, format!("write `keep` in its //@pass and read `before_{name}`, the image one frame ago")))
        }
        name if is_pass(name).is_some_and(|pass| pass.to_picture) => {
            let message = format!("`{name}` gives what it draws to the picture, so it has no image of its own");
            Err((message, format!("read `picture`, with after={name} in the //@pass of `{}`", note.name)))
        }
        name if is_pass(name).is_some() => Ok(Input::Image(name.to_owned())),
        name if names.textures.iter().any(|texture| texture.name == name) => Ok(Input::Texture(name.to_owned())),
        _ => Err(unknown(name, names)),
    }
}

fn unknown(name: &str, names: &Names<'_>) -> Refusal {
    let mut known: Vec<String> = vec!["picture".into(), "depth".into()];
    known.extend(names.passes.iter().map(|pass| pass.name.clone()));
    known.extend(names.passes.iter().filter(|pass| pass.keep).map(|pass| format!("before_{}", pass.name)));
    known.extend(names.textures.iter().map(|texture| texture.name.clone()));
    let hint = did_you_mean(name, known.iter().map(String::as_str));
    (format!("no pass or texture is named `{name}`.{hint}"), format!("there are {}", known.join(", ")))
}

fn buffer(found: &Descriptor) -> Result<Input, Refusal> {
    let (name, block) = (&found.name, found.block.clone().unwrap_or_default());
    if let Some(member) = block.members.iter().find(|member| member.type_name.ends_with("[]")) {
        let message = format!("`{}` in the buffer `{name}` has no length", member.name);
        return Err((message, "give the array a length, so that Specula knows how large the buffer is".into()));
    }
    if block.size > LARGEST_BUFFER {
        let message = format!("the buffer `{name}` has {} bytes, at most {LARGEST_BUFFER} fit", block.size);
        return Err((message, String::new()));
    }
    Ok(Input::Buffer(name.clone(), block.size))
}

fn written(note: &PassNote, found: &Descriptor) -> Result<Input, Refusal> {
    if note.mips {
        let message = "a compute pass writes one level; leave out `mips`".to_owned();
        return Err((message, String::new()));
    }
    let formats = [
        (1, PassFormat::Rgba32f),
        (2, PassFormat::Rgba16f),
        (3, PassFormat::R32f),
        (4, PassFormat::Rgba8),
        (6, PassFormat::Rg32f),
        (7, PassFormat::Rg16f),
        (9, PassFormat::R16f),
    ];
    let declared = formats.iter().find(|(format, _)| *format == found.image_format).map(|(_, format)| *format);
    if declared == Some(note.format) {
        return Ok(Input::Output);
    }
    let message = format!("the image of `{}` has the format {}", note.name, note.format.glsl());
    Err((message, format!("write `layout({}) uniform image2D {};`", note.format.glsl(), note.name)))
}
