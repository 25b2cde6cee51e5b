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

/// The sampler of a channel, as lines like `#iChannel0::Type "CubeMap"` describe it. Without such a line, it is flat.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Sampler {
    pub(super) kind: Kind,
    /// `Repeat`, `Clamp` or `Mirror`.
    wrap: Option<String>,
    /// A filter of OpenGL, as `Nearest` or `LinearMipMapLinear`.
    min: Option<String>,
    mag: Option<String>,
}

/// The image that a channel reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Kind {
    #[default]
    Flat,
    Cube,
    Volume,
}

impl Kind {
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
}

/// The options of a channel in editors' Shadertoy extensions, with the values that each may have.
pub(super) const OPTIONS: [(&str, &[&str]); 4] = [
    ("Type", &["Texture2D", "CubeMap", "Volume"]),
    ("WrapMode", &["Repeat", "Clamp", "Mirror"]),
    ("MinFilter", &FILTERS),
    ("MagFilter", &["Nearest", "Linear"]),
];
const FILTERS: [&str; 6] =
    ["Nearest", "Linear", "NearestMipMapNearest", "LinearMipMapNearest", "NearestMipMapLinear", "LinearMipMapLinear"];

impl Sampler {
    /// The options of a `//@texture`. Shadertoy flips 2D images vertically, but neither faces nor slices.
    pub(super) fn options(&self) -> String {
        let is_nearest = |filter: &Option<String>| filter.as_ref().is_some_and(|filter| filter.starts_with("Nearest"));
        let has_mips = self.min.as_ref().is_none_or(|filter| filter.contains("MipMap"));
        let wrap = match (self.wrap.as_deref(), self.kind) {
            (Some("Clamp"), _) | (None, Kind::Cube) => "clamp",
            (Some("Mirror"), _) => "mirror",
            _ => "",
        };
        let words = [
            "linear",
            if has_mips { "mips" } else { "" },
            wrap,
            if is_nearest(&self.min) { "min=nearest" } else { "" },
            if is_nearest(&self.mag) { "mag=nearest" } else { "" },
            if self.kind == Kind::Flat { "flip" } else { "" },
        ];
        words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
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
        Some((number, channel.with(&samplers[number])))
    };
    text.lines().filter_map(with_sampler).collect()
}

impl Channel {
    pub(super) fn with(self, sampler: &Sampler) -> Self {
        match self {
            // The file has {} where Specula has a `*`.
            Self::Image(file, _) if sampler.kind != Kind::Flat => {
                Self::Image(file.replacen("{}", "*", 1), sampler.clone())
            }
            Self::Image(file, _) => Self::Image(file, sampler.clone()),
            other => other,
        }
    }
}

/// The samplers of the channels.
pub(super) fn samplers(text: &str) -> [Sampler; CHANNELS] {
    let mut out: [Sampler; CHANNELS] = Default::default();
    for (number, option, value) in text.lines().filter_map(option) {
        let sampler = &mut out[number];
        match option {
            "Type" => {
                let known = Kind::NAMES.iter().find(|(known, _)| *known == value);
                sampler.kind = known.map(|(_, kind)| *kind).unwrap_or_default();
            }
            "WrapMode" => sampler.wrap = Some(value.to_owned()),
            "MinFilter" => sampler.min = Some(value.to_owned()),
            _ => sampler.mag = Some(value.to_owned()),
        }
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

/// Parses `#iChannel0::Type "CubeMap"`: the channel, the option and its value. `None` for one that is unknown.
fn option(line: &str) -> Option<(usize, &'static str, &'static str)> {
    let (number, rest) = numbered(line)?;
    let rest = rest.strip_prefix("::")?;
    let (option, values) = OPTIONS.iter().find(|(option, _)| rest.starts_with(option))?;
    let value = quoted(&rest[option.len()..])?;
    let value = values.iter().find(|known| known.eq_ignore_ascii_case(value))?;
    Some((number, option, value))
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
        _ => Channel::Image(file, Sampler::default()),
    };
    Some((number, channel))
}

/// The number of the channel that a sampler of glslViewer's names stands for: `u_tex0`.
pub(super) fn channel_of(name: &str) -> Option<usize> {
    let number = ["u_texture_", "u_texture", "u_tex"].iter().find_map(|prefix| name.strip_prefix(prefix))?;
    number.parse().ok().filter(|number| *number < CHANNELS)
}
