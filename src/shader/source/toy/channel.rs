//! The lines with which a toy names the images that its channels read: `#iChannel0 "file"` and `#iChannel0::Type "CubeMap"`.

/// The source of a channel, as a line `#iChannel0 "..."` names it. The form is that of editors' Shadertoy extensions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    /// The image of this file, one frame ago.
    This,
    /// Another file that draws an image, relative to the folder.
    Drawing(String),
    /// An image file, relative to the folder, with a `*` for the faces or slices if it has several files.
    Image(String, Sampler),
    /// The state of the keys.
    Keyboard,
}

/// The sampler of a channel, as a line `#iChannel0::Type "CubeMap"` names it. Without such a line, it is flat.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Sampler {
    #[default]
    Flat,
    Cube,
    Volume,
}

impl Sampler {
    /// The names of the samplers in the file.
    pub(super) const NAMES: [(&'static str, Self); 3] =
        [("Texture2D", Self::Flat), ("CubeMap", Self::Cube), ("Volume", Self::Volume)];

    /// The name in GLSL.
    pub(super) fn glsl(self) -> &'static str {
        match self {
            Self::Flat => "sampler2D",
            Self::Cube => "samplerCube",
            Self::Volume => "sampler3D",
        }
    }

    /// How Shadertoy reads such an image: it flips 2D images vertically, but neither faces nor slices.
    pub(super) fn options(self) -> &'static str {
        match self {
            Self::Flat => "linear mips flip",
            Self::Cube => "linear mips clamp",
            Self::Volume => "linear mips",
        }
    }
}

/// The extensions of files that draw an image.
pub(super) const SHADERS: [&str; 3] = [".glsl", ".frag", ".fs"];

/// Shadertoy has four channels.
pub(super) const CHANNELS: usize = 4;

/// The channels that a text names, with their numbers.
pub(super) fn channels(text: &str) -> Vec<(usize, Channel)> {
    let samplers = samplers(text);
    let with_sampler = |line| {
        let (number, channel) = channel(line)?;
        Some((number, channel.with(samplers[number])))
    };
    text.lines().filter_map(with_sampler).collect()
}

impl Channel {
    pub(super) fn with(self, sampler: Sampler) -> Self {
        match self {
            // The file has {} where Specula has a `*`.
            Self::Image(file, _) if sampler != Sampler::Flat => Self::Image(file.replacen("{}", "*", 1), sampler),
            other => other,
        }
    }
}

/// The samplers of the channels.
pub(super) fn samplers(text: &str) -> [Sampler; CHANNELS] {
    let mut out = [Sampler::Flat; CHANNELS];
    for (number, sampler) in text.lines().filter_map(channel_type) {
        out[number] = sampler.unwrap_or_default();
    }
    out
}

/// The number of the channel that a line begins with, and the rest of the line.
fn numbered(line: &str) -> Option<(usize, &str)> {
    let rest = line.trim().strip_prefix("#iChannel")?;
    let number = rest.chars().next()?.to_digit(10).map(|number| number as usize).filter(|number| *number < CHANNELS)?;
    Some((number, &rest[1..]))
}

/// The text in quotes that begins here.
fn quoted(text: &str) -> Option<&str> {
    text.trim().strip_prefix('"')?.split('"').next()
}

/// Parses `#iChannel0::Type "CubeMap"`. Without a sampler if there is none of that name.
pub(super) fn channel_type(line: &str) -> Option<(usize, Option<Sampler>)> {
    let (number, rest) = numbered(line)?;
    let name = quoted(rest.strip_prefix("::Type")?).unwrap_or_default();
    let known = Sampler::NAMES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
    Some((number, known.map(|(_, sampler)| *sampler)))
}

/// Parses `#iChannel0 "file"`. Other lines of that kind, as `#iChannel0::WrapMode`, name no file.
pub(super) fn channel(line: &str) -> Option<(usize, Channel)> {
    let (number, rest) = numbered(line)?;
    let name = quoted(rest)?;
    let file = name.strip_prefix("file://").unwrap_or(name);
    let file = file.strip_prefix("./").unwrap_or(file).to_owned();
    let is_shader = SHADERS.iter().any(|ending| file.ends_with(ending));
    let channel = match name {
        "self" => Channel::This,
        _ if file == "keyboard" => Channel::Keyboard,
        _ if is_shader => Channel::Drawing(file),
        _ => Channel::Image(file, Sampler::Flat),
    };
    Some((number, channel))
}
