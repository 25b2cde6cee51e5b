//! Parses `//@pass`, with which a shader tree adds passes to a frame.

use serde::Serialize;

use super::cursor::Cursor;
use super::name::{check_name, name};
use super::place::Place;
use crate::message::did_you_mean;
use crate::shader::diagnostic::Diagnostic;

/// Number of images that every device can draw to in one pass.
const MOST_IMAGES: usize = 4;

/// Most instances of the model that a pass draws.
pub const MOST_COPIES: u32 = 1024;

/// Most quads that a pass draws.
const MOST_QUADS: u32 = 1 << 20;

/// Largest side of a pass's image in pixels, if it is given in pixels. The device may offer less.
const LARGEST_SIDE: u32 = 16384;

/// The options, for suggestions.
const OPTIONS: [&str; 16] = [
    "to",
    "after",
    "size",
    "format",
    "also",
    "draw",
    "instances",
    "cull",
    "blend",
    "dispatch",
    "when",
    "mips",
    "keep",
    "off",
    "doc",
    "instead",
];

/// The pass from the HDR target to the LDR output. Every tree declares it, with `to=display`.
pub const TONEMAP: &str = "tonemap";

/// The pass that draws the model in the final picture. Every tree declares it, with `draw=model to=picture`.
pub const MODEL: &str = "model";

/// The size of a pass's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum PassSize {
    /// The frame's size divided by a whole number, rounded up.
    Divided(u32),
    /// Width and height, pixels.
    Pixels(u32, u32),
}

impl PassSize {
    /// Width and height in pixels, for a frame of this size. At least 1.
    pub fn pixels(self, (width, height): (u32, u32)) -> (u32, u32) {
        match self {
            Self::Divided(by) => (width.div_ceil(by).max(1), height.div_ceil(by).max(1)),
            Self::Pixels(width, height) => (width, height),
        }
    }
}

/// The texel format of a pass's image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum PassFormat {
    /// Four half floats.
    #[default]
    Rgba16f,
    /// Four floats.
    Rgba32f,
    /// Four 8-bit numbers, 0..1.
    Rgba8,
    /// Two half floats.
    Rg16f,
    /// Two floats.
    Rg32f,
    /// A half float.
    R16f,
    /// A float.
    R32f,
}

impl PassFormat {
    /// All formats, with their names in GLSL.
    pub const ALL: [(&'static str, Self); 7] = [
        ("rgba16f", Self::Rgba16f),
        ("rgba32f", Self::Rgba32f),
        ("rgba8", Self::Rgba8),
        ("rg16f", Self::Rg16f),
        ("rg32f", Self::Rg32f),
        ("r16f", Self::R16f),
        ("r32f", Self::R32f),
    ];

    /// Bytes of a texel.
    pub fn bytes(self) -> u32 {
        match self {
            Self::Rgba32f => 16,
            Self::Rgba16f | Self::Rg32f => 8,
            Self::Rgba8 | Self::Rg16f | Self::R32f => 4,
            Self::R16f => 2,
        }
    }

    /// The name in GLSL.
    pub fn glsl(self) -> &'static str {
        Self::ALL.iter().find(|(_, format)| *format == self).map_or("?", |(name, _)| name)
    }
}

/// The workgroups of a compute pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Dispatch {
    /// As many as cover the pass's image with one invocation per pixel.
    Size,
    /// This many along x, y and z.
    Groups([u32; 3]),
}

/// The image that a pass draws to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum PassTarget {
    /// An image of its own, with the name of the pass.
    #[default]
    Image,
    /// The HDR target.
    Picture,
    /// One color from the samples of each pixel.
    Resolve,
    /// The accumulation buffer, in modes that accumulate.
    Mean,
    /// The LDR output.
    Display,
}

/// The faces that a pass leaves out when it draws the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Cull {
    /// No faces.
    None,
    /// Faces towards the camera.
    Front,
    /// Faces away from it.
    Back,
}

/// How often a pass draws the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Instances {
    /// A fixed number of times.
    Count(u32),
    /// Once for each light of the frame, at most 16 times.
    Lights,
}

/// The description of a declared pass.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct PassDesc {
    /// Name of the pass and of its image.
    pub name: String,
    /// Display name.
    pub label: String,
    /// Size of its image.
    pub size: PassSize,
    /// Format of its image.
    pub format: PassFormat,
    /// Further images that it draws, with their formats: those of the outputs at locations 1 and up.
    pub also: Vec<(String, PassFormat)>,
    /// Whether its image has mip levels, which are generated after the pass.
    pub mips: bool,
    /// Whether the image of the previous frame is kept, as `before_NAME`.
    pub keep: bool,
    /// Whether it is on until the user switches it off.
    pub on: bool,
    /// The image that it draws to.
    pub to: PassTarget,
    /// A pass that comes before this pass, besides those whose images it reads.
    pub after: Option<String>,
    /// The workgroups of a compute pass.
    pub dispatch: Dispatch,
    /// How often it draws the model, or quads; `None` if it covers its image with one triangle.
    pub model: Option<Instances>,
    /// Whether it draws quads, which its vertex stage places, and not the model.
    pub quads: bool,
    /// Whether its triangle lies behind the model.
    pub background: bool,
    /// The pass that it replaces in the debug modes that name its stage.
    pub instead: Option<String>,
    /// The pass whose stage it copies to show an expression; it is drawn just before it. No tree writes this.
    #[serde(skip)]
    pub watches: Option<String>,
    /// Whether the first row of its image is the lowest one, as in OpenGL.
    #[serde(skip)]
    pub rows_up: bool,
    /// The faces of the model that it leaves out; `None`: as the material says.
    pub cull: Option<Cull>,
    /// Whether its colors, premultiplied by alpha, are blended with the picture.
    pub blend: bool,
    /// The author's constant that switches the pass on. Stages that read its image can read the constant, too.
    pub when: Option<String>,
    /// A description of the pass.
    pub doc: String,
    /// Path of its stage in the tree.
    pub stage: String,
    /// Location of the annotation.
    #[serde(skip)]
    pub place: Place,
}

impl PassDesc {
    /// Whether it draws to the picture, so that it has no image of its own.
    pub fn to_picture(&self) -> bool {
        self.to == PassTarget::Picture
    }

    /// Whether it is one of the built-in steps of the picture: the model, what may replace it, and the steps to the display.
    pub fn is_built_in(&self) -> bool {
        matches!(self.to, PassTarget::Resolve | PassTarget::Mean | PassTarget::Display)
            || self.instead.is_some()
            || self.name == MODEL
    }

    /// Whether it draws an image of this name.
    pub fn draws(&self, image: &str) -> bool {
        self.to == PassTarget::Image && self.images().any(|(name, _)| name == image)
    }

    /// The names and formats of its own images, by location; empty if it draws to another target.
    pub fn images(&self) -> impl Iterator<Item = (&str, PassFormat)> {
        let also = self.also.iter().map(|(name, format)| (name.as_str(), *format));
        std::iter::once((self.name.as_str(), self.format)).chain(also)
    }

    /// Whether it draws the model, and not quads.
    pub fn draws_model(&self) -> bool {
        self.model.is_some() && !self.quads
    }

    /// Whether it draws to the multisampled target, together with the model.
    pub fn is_drawn_with_model(&self) -> bool {
        self.to_picture() && (self.model.is_some() || self.background)
    }
}

/// Parses the rest of a `//@pass`.
pub fn pass(cursor: &mut Cursor<'_>) -> Result<PassDesc, Box<Diagnostic>> {
    let name = name(cursor, "pass")?;
    let label = cursor.string()?.filter(|label| !label.trim().is_empty()).unwrap_or_else(|| name.clone());
    let mut desc = PassDesc {
        name,
        label,
        size: PassSize::Divided(1),
        format: PassFormat::default(),
        also: Vec::new(),
        mips: false,
        keep: false,
        on: true,
        to: PassTarget::Image,
        after: None,
        dispatch: Dispatch::Size,
        model: None,
        quads: false,
        background: false,
        instead: None,
        watches: None,
        rows_up: false,
        cull: None,
        blend: false,
        when: None,
        doc: String::new(),
        stage: String::new(),
        place: cursor.place().clone(),
    };
    while !cursor.at_end() {
        let (bytes, key) = cursor.key();
        match key {
            "mips" => desc.mips = true,
            "keep" => desc.keep = true,
            "off" => desc.on = false,
            "blend" => desc.blend = true,
            "instead" => desc.instead = Some(cursor.value(key)?.1),
            "watches" => desc.watches = Some(cursor.value(key)?.1),
            "rows" => desc.rows_up = cursor.one_of(key, &[("up", true), ("down", false)])?,
            "cull" => {
                let all = [("none", Cull::None), ("front", Cull::Front), ("back", Cull::Back)];
                desc.cull = Some(cursor.one_of(key, &all)?);
            }
            "size" => desc.size = size(cursor)?,
            "format" => desc.format = format(cursor)?,
            "also" => desc.also = also(cursor)?,
            "after" => desc.after = Some(cursor.value(key)?.1),
            "dispatch" => desc.dispatch = dispatch(cursor)?,
            "when" => desc.when = Some(cursor.value(key)?.1),
            "instances" => desc.model = Some(instances(cursor)?),
            "draw" => match cursor.value(key)? {
                (_, what) if what == "model" => desc.model = desc.model.or(Some(Instances::Count(1))),
                (_, what) if what == "quads" => {
                    (desc.model, desc.quads) = (desc.model.or(Some(Instances::Count(1))), true);
                }
                (_, what) if what == "background" => desc.background = true,
                (bytes, other) => {
                    let message = format!("expected draw=model, draw=quads or draw=background, found `{other}`");
                    return Err(cursor.error(bytes, message));
                }
            },
            "doc" => desc.doc = cursor.value(key)?.1,
            "to" => {
                let all = [
                    ("picture", PassTarget::Picture),
                    ("resolve", PassTarget::Resolve),
                    ("mean", PassTarget::Mean),
                    ("display", PassTarget::Display),
                ];
                desc.to = cursor.one_of(key, &all)?;
            }
            other => {
                let known = "to=picture|resolve|mean|display, after=, size=, format=, also=, draw=model|quads|background, instances=, cull=, \
                             blend, instead=, dispatch=, when=, mips, keep, off or doc=";
                if other == "camera" {
                    let message = "the camera of a pass is its vertex stage: a .vert file of the same name decides where vertices go";
                    return Err(cursor.error(bytes, message.to_owned()));
                }
                if other.starts_with('=') {
                    return Err(cursor.error(bytes, format!("the option before `{other}` takes no value")));
                }
                let hint = did_you_mean(other, OPTIONS);
                return Err(cursor.error(bytes, format!("expected {known}, found `{other}`.{hint}")));
            }
        }
    }
    Ok(desc)
}

fn size(cursor: &mut Cursor<'_>) -> Result<PassSize, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("size")?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=LARGEST_SIDE).contains(side));
    let size = match value.split_once(['/', 'x']) {
        None if value == "1" => Some(PassSize::Divided(1)),
        None => side(&value).map(|side| PassSize::Pixels(side, side)),
        Some(("1", by)) if value.contains('/') => {
            by.parse().ok().filter(|by| (1..=64).contains(by)).map(PassSize::Divided)
        }
        Some((width, height)) if value.contains('x') => {
            side(width).zip(side(height)).map(|(width, height)| PassSize::Pixels(width, height))
        }
        _ => None,
    };
    size.ok_or_else(|| {
        let message = format!(
            "expected size=1, size=1/2 to size=1/64, size=512x256 or size=512 (1 to {LARGEST_SIDE} pixels a side), \
             found `{value}`"
        );
        cursor.error(bytes, message)
    })
}

fn format(cursor: &mut Cursor<'_>) -> Result<PassFormat, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("format")?;
    format_named(&value).map_err(|message| cursor.error(bytes, message))
}

fn format_named(name: &str) -> Result<PassFormat, String> {
    let found = PassFormat::ALL.iter().find(|(known, _)| *known == name);
    found.map(|(_, format)| *format).ok_or_else(|| {
        let names: Vec<&str> = PassFormat::ALL.iter().map(|(name, _)| *name).collect();
        if name.starts_with('d') && name[1..].parse::<u32>().is_ok() {
            return "a pass with draw= has a depth of its own; to keep depth, write gl_FragCoord.z to format=r32f"
                .to_owned();
        }
        format!("expected one of the formats {}, found `{name}`", names.join(", "))
    })
}

/// Parses further images, as `also=normals:rgba16f,albedo`.
fn also(cursor: &mut Cursor<'_>) -> Result<Vec<(String, PassFormat)>, Box<Diagnostic>> {
    let (bytes, value) = cursor.value("also")?;
    let images: Result<Vec<_>, String> = value
        .split(',')
        .map(|image| {
            let (name, format) = image.split_once(':').unwrap_or((image, PassFormat::default().glsl()));
            check_name(name, "image")?;
            Ok((name.to_owned(), format_named(format)?))
        })
        .collect();
    let images = images.map_err(|message| cursor.error(bytes.clone(), message))?;
    // Every device draws to four images at a time.
    if images.len() >= MOST_IMAGES {
        let message = format!("a pass draws at most {MOST_IMAGES} images, this one {}", images.len() + 1);
        return Err(cursor.error(bytes, message));
    }
    Ok(images)
}

fn dispatch(cursor: &mut Cursor<'_>) -> Result<Dispatch, Box<Diagnostic>> {
    /// The most workgroups along an axis that every device supports.
    const MOST: u32 = 65535;
    let (bytes, value) = cursor.value("dispatch")?;
    if value == "size" {
        return Ok(Dispatch::Size);
    }
    let counts: Option<Vec<u32>> = value.split('x').map(|count| count.parse().ok()).collect();
    let groups = counts.filter(|counts| counts.len() <= 3 && counts.iter().all(|count| (1..=MOST).contains(count)));
    match groups.as_deref() {
        Some([x]) => Ok(Dispatch::Groups([*x, 1, 1])),
        Some([x, y]) => Ok(Dispatch::Groups([*x, *y, 1])),
        Some([x, y, z]) => Ok(Dispatch::Groups([*x, *y, *z])),
        _ => {
            let message = format!(
                "expected dispatch=size or a number of workgroups, as dispatch=64 or dispatch=8x8x1 (1 to {MOST}), \
                 found `{value}`"
            );
            Err(cursor.error(bytes, message))
        }
    }
}

fn instances(cursor: &mut Cursor<'_>) -> Result<Instances, Box<Diagnostic>> {
    const MOST: u32 = MOST_QUADS;
    let (bytes, value) = cursor.value("instances")?;
    if value == "lights" {
        return Ok(Instances::Lights);
    }
    let count = value.parse().ok().filter(|count| (1..=MOST).contains(count));
    count.map(Instances::Count).ok_or_else(|| {
        let message = format!("expected instances=lights, or instances=1 to instances={MOST}, found `{value}`");
        cursor.error(bytes, message)
    })
}
