//! The passes that a shader tree adds to a frame with `//@pass`.

use serde::Serialize;

use super::place::AnnotationPlace;

/// Most instances of the model that a pass draws.
pub const MOST_COPIES: u32 = 1024;

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

impl Default for PassSize {
    fn default() -> Self {
        Self::Divided(1)
    }
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub enum Dispatch {
    /// As many as cover the pass's image with one invocation per pixel.
    #[default]
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
    /// The depth of the next layer of blended surfaces.
    Peel,
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
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize)]
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
    pub place: AnnotationPlace,
}

impl PassDesc {
    /// Whether it draws to the picture, so that it has no image of its own.
    pub fn to_picture(&self) -> bool {
        self.to == PassTarget::Picture
    }

    /// Whether it is one of the built-in steps of the picture: the model, what may replace it, and the steps to the display.
    pub fn is_built_in(&self) -> bool {
        matches!(self.to, PassTarget::Peel | PassTarget::Resolve | PassTarget::Mean | PassTarget::Display)
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
