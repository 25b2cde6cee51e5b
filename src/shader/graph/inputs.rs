//! Finds the resources that a pass reads and writes, by the names of its declarations.

use std::collections::BTreeMap;

use super::{GraphPass, Input, Inputs, PassStage, TextureKind};
use crate::interface::{SET_PASS, VERTEX_BINDINGS};
use crate::message::did_you_mean;
use crate::shader::annotation::pass::{PassDesc, PassFormat, PassTarget};
use crate::shader::annotation::texture::TextureDesc;
use crate::shader::compile::StageKind;
use crate::shader::diagnostic::Diagnostic;
use crate::shader::spirv::reflect::Descriptor;

/// The largest storage buffer in bytes. Every device can bind one of this size.
const LARGEST_BUFFER: u32 = 128 << 20;
/// The largest uniform block in bytes. Every device can bind one of this size.
const LARGEST_BLOCK: u32 = 16 << 10;

/// The block with the properties of a pass's image and the clock, in pass.glsl and toy.glsl.
const PASS_BLOCK: &str = "Pass";
/// The members that it may have, and their types in GLSL.
const PASS_MEMBERS: [(&str, &str); 6] = [
    ("size_px", "vec2"),
    ("mouse_px", "vec4"),
    ("date", "vec4"),
    ("time_s", "float"),
    ("delta_s", "float"),
    ("frame_index", "uint"),
];

/// The samplers that a stage can have.
const SAMPLERS: &str = "sampler2D, samplerCube, sampler3D, sampler2DArray";

impl Input {
    /// Whether it may change in every frame, even if nothing else has changed.
    pub fn is_of_picture(&self) -> bool {
        match self {
            Self::Picture
            | Self::Samples
            | Self::Peeled
            | Self::OpaqueScene
            | Self::Depth
            | Self::Before(_)
            | Self::Output
            | Self::Buffer(..) => true,
            Self::Image(_) | Self::Texture(..) | Self::Parameters(..) | Self::Pass(..) => false,
        }
    }
}

/// The names that a pass can read.
pub struct Names<'a> {
    /// All declared passes.
    pub passes: &'a [PassDesc],
    /// All declared textures.
    pub textures: &'a [TextureDesc],
}

/// The inputs of all stages of a declared pass.
///
/// # Errors
/// Those of the first stage that has errors.
pub fn inputs_of<'s, 't: 's>(
    desc: &PassDesc,
    stages: impl Iterator<Item = &'s PassStage<'t>>,
    names: &Names<'_>,
) -> Result<Inputs, Vec<Diagnostic>> {
    let mut all = Inputs::new();
    for stage in stages {
        all.extend(inputs(desc, stage, names)?);
    }
    Ok(all)
}

/// Removes the images on which no output of a pass depends. A pass that draws the model calls the author's hooks, but may use
/// only a part of what they change: a shadow map uses only the holes. So an image that only affects a color is no input of the
/// shadow map. Otherwise no hook could read the ambient occlusion, which is computed from the model's distance.
pub fn without_dead(mut inputs: Inputs, desc: &PassDesc, stage: &PassStage<'_>) -> Inputs {
    let is_dead = |binding: u32, input: &Input| {
        matches!(input, Input::Image(_)) && binding < VERTEX_BINDINGS && !(stage.live)().contains(&binding)
    };
    if desc.draws_model() && !desc.is_built_in() {
        inputs.retain(|binding, input| !is_dead(*binding, input));
    }
    inputs
}

/// The inputs of a stage.
///
/// # Errors
/// A name that nothing has, or a declaration that does not fit what has the name.
fn inputs(desc: &PassDesc, stage: &PassStage<'_>, names: &Names<'_>) -> Result<Inputs, Vec<Diagnostic>> {
    inputs_by(stage, |found| input(desc, stage.kind, found, names))
}

fn inputs_by(
    stage: &PassStage<'_>,
    input: impl Fn(&Descriptor) -> Result<Input, Refusal>,
) -> Result<Inputs, Vec<Diagnostic>> {
    let (mut inputs, mut errors) = (Inputs::new(), Vec::new());
    for found in stage.reflection.descriptors.iter().filter(|found| found.set == SET_PASS) {
        let found_input = match is_doubled(stage, found) {
            false => input(found),
            true => {
                let message = format!("`{}` has a binding of its own", found.name);
                Err((message, "leave out layout(set, binding): images and buffers are found by their names".into()))
            }
        };
        match found_input {
            Ok(input) => {
                inputs.insert(found.binding, input);
            }
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

fn input(desc: &PassDesc, kind: StageKind, found: &Descriptor, names: &Names<'_>) -> Result<Input, Refusal> {
    let Descriptor { name, glsl, .. } = found;
    match glsl.as_str() {
        "sampler2D" => sampled(desc, name, names),
        "sampler2DMS" if desc.to == PassTarget::Resolve && name == "samples" => Ok(Input::Samples),
        "sampler2DMS" if desc.to == PassTarget::Resolve => {
            let message = format!("the pass `{}` has no `{name}`", desc.name);
            Err((message, "it reads the samples of the picture: uniform sampler2DMS samples;".into()))
        }
        "sampler2DMS" if desc.to == PassTarget::Peel && name == "peeled_samples" => Ok(Input::Peeled),
        "sampler2DMS" if desc.to == PassTarget::Peel => {
            let message = format!("the pass `{}` has no `{name}`", desc.name);
            Err((message, "it reads the depth of the last layer: uniform sampler2DMS peeled_samples;".into()))
        }
        "uniform block" if desc.is_built_in() && name != PASS_BLOCK => {
            let message = format!("the uniform block `{name}` has no binding");
            Err((message, "add its members to Params in user/params.glsl, which every stage reads".into()))
        }
        "uniform block" if name == PASS_BLOCK => {
            let block = found.block.clone().unwrap_or_default();
            for member in &block.members {
                if !PASS_MEMBERS.contains(&(member.name.as_str(), member.type_name.as_str())) {
                    let known: Vec<String> = PASS_MEMBERS.iter().map(|(name, glsl)| format!("{glsl} {name}")).collect();
                    let message = format!("`{PASS_BLOCK}` has no `{} {}`", member.type_name, member.name);
                    return Err((message, format!("its members can be {}", known.join(", "))));
                }
            }
            let members = block.members.into_iter().map(|member| (member.offset, member.name)).collect();
            Ok(Input::Pass(block.size.next_multiple_of(16), members))
        }
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
            let message = format!("only a compute shader can write the image `{name}`");
            Err((
                message,
                "a fragment shader draws to the image of its pass; a .comp file writes it by imageStore".into(),
            ))
        }
        glsl if glsl.ends_with("image2D") && name == &desc.name => written(desc, found),
        glsl if glsl.ends_with("image2D") => {
            let message = format!("`{name}` is not the image of this pass, which is `{}`", desc.name);
            Err((message, "a pass writes its own image; it reads those of others as `uniform sampler2D`".into()))
        }
        other => match TextureKind::of(other) {
            Some(kind) => texture(name, kind, names),
            None => {
                let message = format!("a pass cannot have {other} `{name}`");
                Err((message, format!("it can have {SAMPLERS}, its own image2D, a buffer block or a uniform block")))
            }
        },
    }
}

/// The images that Specula provides to a pass, by name.
fn given(desc: &PassDesc) -> &'static [(&'static str, Input)] {
    match desc.to {
        PassTarget::Resolve => &[],
        PassTarget::Peel => &[("peeled", Input::Peeled)],
        PassTarget::Mean | PassTarget::Display => &[("picture", Input::Picture)],
        PassTarget::Picture if desc.is_drawn_with_model() => &[("behind", Input::OpaqueScene)],
        PassTarget::Picture | PassTarget::Image => &[("picture", Input::Picture), ("depth", Input::Depth)],
    }
}

fn sampled(desc: &PassDesc, name: &str, names: &Names<'_>) -> Result<Input, Refusal> {
    let given = given(desc);
    if let Some((_, input)) = given.iter().find(|(known, _)| *known == name) {
        return Ok(input.clone());
    }
    match name {
        "picture" | "depth" if desc.is_drawn_with_model() => {
            let message = format!("`{name}` is not there yet: `{}` is drawn together with the model", desc.name);
            Err((message, "a pass with to=picture, without draw=, reads what is drawn so far".into()))
        }
        name if name == desc.name || desc.draws(name) => {
            let message = format!("a pass cannot read the image that it draws, `{name}`");
            Err((message, format!("read `before_{name}`, the image one frame ago")))
        }
        name => image(name, names).unwrap_or_else(|| {
            let given: Vec<&str> = given.iter().map(|(name, _)| *name).collect();
            Err(unknown(name, &given, names))
        }),
    }
}

/// The image that a name reads with a delay of one frame: `glow` for `before_glow`. Passes of the tree keep `picture` and
/// `depth`.
pub fn read_later(name: &str) -> Option<&str> {
    match name.strip_prefix("before_")? {
        "picture" => Some("last_picture"),
        "depth" => Some("last_depth"),
        image => Some(image),
    }
}

/// The image of a pass, of this frame or the previous one, or a texture. `None` if nothing has this name.
fn image(name: &str, names: &Names<'_>) -> Option<Result<Input, Refusal>> {
    let find = |name: &str| names.passes.iter().find(|pass| pass.name == name || pass.draws(name));
    if let Some((before, pass)) = read_later(name).and_then(|before| Some((before, find(before)?))) {
        return Some(match pass.to == PassTarget::Image {
            true => Ok(Input::Before(before.to_owned())),
            false => Err(not_kept(before)),
        });
    }
    match find(name) {
        Some(pass) if pass.to != PassTarget::Image => {
            let message = format!("`{name}` gives what it draws to the picture, so it has no image of its own");
            Some(Err((message, format!("read `picture` in a pass with after={name}"))))
        }
        Some(_) => Some(Ok(Input::Image(name.to_owned()))),
        None => {
            let is_texture = names.textures.iter().any(|texture| texture.name == name);
            is_texture.then(|| Ok(Input::Texture(name.to_owned(), TextureKind::Flat)))
        }
    }
}

/// A texture other than a `sampler2D`. Only files of the tree can be such textures.
fn texture(name: &str, kind: TextureKind, names: &Names<'_>) -> Result<Input, Refusal> {
    if names.textures.iter().any(|texture| texture.name == name) {
        return Ok(Input::Texture(name.to_owned(), kind));
    }
    let glsl = kind.glsl();
    let drawn = name.strip_prefix("before_").unwrap_or(name);
    if ["picture", "depth", "behind"].contains(&name) || names.passes.iter().any(|pass| pass.name == drawn) {
        let message = format!("`{name}` is drawn, so it is no {glsl}");
        return Err((message, format!("declare it as `uniform sampler2D {name};`")));
    }
    let known: Vec<&str> = names.textures.iter().map(|texture| texture.name.as_str()).collect();
    let message = format!("no texture is named `{name}`.{}", did_you_mean(name, known.iter().copied()));
    let example = if kind == TextureKind::Cube { "_*.png\"" } else { ".png\" layers=8" };
    Err((message, format!("declare it: //@texture {name} \"{name}{example}")))
}

/// Refuses to read `picture`, `depth` or a pass that draws to the picture one frame later: only images of passes are kept.
fn not_kept(name: &str) -> Refusal {
    let is_image = matches!(name, "picture" | "depth" | "behind");
    let message = match is_image {
        true => format!("the `{name}` of the frame before is not kept"),
        false => format!("`{name}` gives what it draws to the picture, which is not kept for the next frame"),
    };
    let (read, after) = if is_image { (name, String::new()) } else { ("picture", format!(" after={name}")) };
    let help = format!(
        "let a pass copy it: `//@pass last{after}` with `uniform sampler2D {read};`, and read `before_last` here"
    );
    (message, help)
}

/// Refuses an unknown name. `given` are the images that Specula provides to the stage.
fn unknown(name: &str, given: &[&str], names: &Names<'_>) -> Refusal {
    let mut known: Vec<String> = given.iter().map(|name| (*name).to_owned()).collect();
    let images = |pass: &PassDesc| -> Vec<String> { pass.images().map(|(name, _)| name.to_owned()).collect() };
    known.extend(names.passes.iter().filter(|pass| pass.to == PassTarget::Image).flat_map(images));
    let kept = names.passes.iter().filter(|pass| pass.keep).flat_map(images);
    known.extend(kept.map(|name| format!("before_{name}")));
    known.extend(names.textures.iter().map(|texture| texture.name.clone()));
    let hint = did_you_mean(name, known.iter().map(String::as_str));
    if let Some(now) = name.strip_prefix("before_").filter(|now| given.contains(now)) {
        return not_kept(now);
    }
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
    Ok(Input::Buffer(name.clone(), block.size, found.is_written))
}

fn written(desc: &PassDesc, found: &Descriptor) -> Result<Input, Refusal> {
    if desc.mips {
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
    if declared == Some(desc.format) {
        return Ok(Input::Output);
    }
    let message = format!("the image of `{}` has the format {}", desc.name, desc.format.glsl());
    Err((message, format!("write `layout({}) uniform image2D {};`", desc.format.glsl(), desc.name)))
}

/// Errors of passes whose buffer another pass declares with another size.
pub fn different_buffers(passes: &[GraphPass]) -> Vec<Diagnostic> {
    let mut first: BTreeMap<&str, (u32, String)> = BTreeMap::new();
    let mut errors = Vec::new();
    for pass in passes {
        for input in pass.inputs.values() {
            let Input::Buffer(name, bytes, _) = input else { continue };
            let (size, other) = first.entry(name).or_insert_with(|| (*bytes, format!("the pass `{}`", pass.name())));
            if *size != *bytes {
                let message =
                    format!("the buffer `{name}` has {bytes} bytes here and {size} in {other}; both share it");
                errors.push(pass.desc.place.error(message).with_help("declare it once, in a file that both include"));
            }
        }
    }
    errors
}
