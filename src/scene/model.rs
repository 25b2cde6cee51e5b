//! The scene as plain data: what a loader fills and what `render` uploads. No Vulkan, no file handles.

use std::path::PathBuf;

use glam::{Affine2, Mat4, Vec3, Vec4};

pub use crate::interface::Vertex;

/// A loaded model. Indices into its vectors are always in range; a loader that cannot promise that returns an error.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// File stem, or the built-in name.
    pub name: String,
    /// Unique geometry.
    pub primitives: Vec<Primitive>,
    /// At least one; index 0 is glTF's default material.
    pub materials: Vec<Material>,
    /// Images paired with samplers.
    pub textures: Vec<Texture>,
    /// Decoded images.
    pub images: Vec<Image>,
    /// What is drawn: primitives placed in the world.
    pub instances: Vec<Instance>,
    /// KHR_lights_punctual, placed in the world.
    pub lights: Vec<Light>,
    /// Cameras, placed in the world.
    pub cameras: Vec<Camera>,
    /// World bounds of all instances.
    pub bounds: Bounds,
    /// The outermost vertices in world space, for framing; empty stands for the corners of `bounds`.
    pub outline: Vec<Vec3>,
    /// Every file that was read, absolute: these are watched.
    pub files: Vec<PathBuf>,
    /// What the loader tolerated: unknown extensions, replaced tangents. One sentence each.
    pub warnings: Vec<String>,
    /// Where the loading time went.
    pub timing: LoadTiming,
}

/// Milliseconds spent on each part of a load.
#[derive(Clone, Copy, Debug, Default, serde::Serialize)]
pub struct LoadTiming {
    /// Reading and parsing the file and its buffers.
    pub parse_ms: f64,
    /// Decoding images (wall time; they decode in parallel).
    pub decode_ms: f64,
    /// Making tangents (wall time, in parallel with decoding).
    pub tangents_ms: f64,
}

/// Axis-aligned bounds in world space, meters. Empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner.
    pub min: Vec3,
    /// Largest corner.
    pub max: Vec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY }
    }
}

impl Bounds {
    /// Grows to hold `point`.
    pub fn include(&mut self, point: Vec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Whether nothing was included.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        let pick = |bit: usize, min: f32, max: f32| if bit == 0 { min } else { max };
        std::array::from_fn(|i| {
            Vec3::new(
                pick(i & 1, self.min.x, self.max.x),
                pick(i & 2, self.min.y, self.max.y),
                pick(i & 4, self.min.z, self.max.z),
            )
        })
    }

    /// Middle of the box; the origin when empty.
    pub fn center(&self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { (self.min + self.max) * 0.5 }
    }

    /// Radius of the sphere around the box; 1 when empty or a single point.
    pub fn radius(&self) -> f32 {
        let radius = if self.is_empty() { 0.0 } else { (self.max - self.min).length() * 0.5 };
        if radius > 0.0 && radius.is_finite() { radius } else { 1.0 }
    }
}

/// How vertices form primitives. A line loop is made a strip; a triangle strip or fan a list when flat normals or
/// tangents are made for it, which splits its vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topology {
    /// Points.
    Points,
    /// Lines.
    Lines,
    /// Line strip.
    LineStrip,
    /// Triangles.
    Triangles,
    /// Triangle strip.
    TriangleStrip,
    /// Triangle fan.
    TriangleFan,
}

/// Geometry with one material.
#[derive(Clone, Debug)]
pub struct Primitive {
    /// Mesh name and primitive number, for messages.
    pub name: String,
    /// Vertices, object space.
    pub vertices: Vec<Vertex>,
    /// Indices into `vertices`; always present.
    pub indices: Vec<u32>,
    /// How the indices are read.
    pub topology: Topology,
    /// Index into `Model::materials`.
    pub material: usize,
    /// `interface::ATTRIBUTE_*` bits.
    pub attributes: u32,
    /// Object-space bounds.
    pub bounds: Bounds,
}

/// A primitive placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Index into `Model::primitives`.
    pub primitive: usize,
    /// Object to world; finite; a negative determinant flips the winding.
    pub world_from_object: Mat4,
    /// Index of the glTF node.
    pub node: usize,
    /// Name of the node, or empty.
    pub node_name: String,
}

/// Coverage, as in glTF.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Fragments below the cutoff are discarded.
    Mask,
    /// Blended over what is behind.
    Blend,
}

/// A use of a texture by a material.
#[derive(Clone, Copy, Debug)]
pub struct TextureUse {
    /// Index into `Model::textures`.
    pub texture: usize,
    /// TEXCOORD set, 0 or 1.
    pub uv_set: u32,
    /// KHR_texture_transform: texture coordinates from mesh coordinates.
    pub uv_from_mesh: Affine2,
}

/// A metallic-roughness material. Colors are linear.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name, or empty.
    pub name: String,
    /// RGBA factor.
    pub base_color_factor: Vec4,
    /// 0..1.
    pub metallic_factor: f32,
    /// Perceptual roughness, 0..1.
    pub roughness_factor: f32,
    /// RGB factor, KHR_materials_emissive_strength multiplied in.
    pub emissive_factor: Vec3,
    /// Scale of the normal texture.
    pub normal_scale: f32,
    /// Strength of the occlusion texture.
    pub occlusion_strength: f32,
    /// Cutoff for [`AlphaMode::Mask`].
    pub alpha_cutoff: f32,
    /// Coverage.
    pub alpha_mode: AlphaMode,
    /// Draw both faces.
    pub double_sided: bool,
    /// KHR_materials_unlit.
    pub unlit: bool,
    /// The textures, indexed by `interface::TEXTURE_*`.
    pub textures: [Option<TextureUse>; crate::interface::TEXTURE_COUNT],
}

impl Default for Material {
    /// glTF's default material: white, rough metal.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color_factor: Vec4::ONE,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            emissive_factor: Vec3::ZERO,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha_cutoff: 0.5,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            textures: [None; crate::interface::TEXTURE_COUNT],
        }
    }
}

/// An image with a way to read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture {
    /// Index into `Model::images`.
    pub image: usize,
    /// Filtering and wrapping.
    pub sampler: Sampler,
}

/// glTF sampler. The default is linear with mips, repeating.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Magnification is linear, not nearest.
    pub mag_linear: bool,
    /// Minification is linear, not nearest.
    pub min_linear: bool,
    /// Mip levels: none, nearest or linear.
    pub mip: Mip,
    /// Horizontal wrap.
    pub wrap_u: Wrap,
    /// Vertical wrap.
    pub wrap_v: Wrap,
}

impl Default for Sampler {
    fn default() -> Self {
        Self { mag_linear: true, min_linear: true, mip: Mip::Linear, wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat }
    }
}

/// Use of mip levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mip {
    /// Level 0 only.
    None,
    /// The nearest level.
    Nearest,
    /// Between two levels.
    Linear,
}

/// Texture coordinates outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Repeat.
    Repeat,
    /// Mirrored repeat.
    Mirror,
    /// Clamp to edge.
    Clamp,
}

/// A decoded image, RGBA, 8 bits a channel, rows top to bottom. Color space depends on the use, so it is not converted.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name or URI, for messages.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba8: Vec<u8>,
}

/// What a light radiates like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light; intensity in lux.
    Directional,
    /// Intensity in candela.
    Point,
    /// Intensity in candela; cone half-angles in radians.
    Spot {
        /// Where the falloff starts.
        inner: f32,
        /// Where it ends.
        outer: f32,
    },
}

/// A punctual light in world space.
#[derive(Clone, Debug)]
pub struct Light {
    /// Name, or empty.
    pub name: String,
    /// Kind and cone.
    pub kind: LightKind,
    /// World position, meters.
    pub position: Vec3,
    /// Where it shines to, unit.
    pub direction: Vec3,
    /// Linear RGB times candela or lux.
    pub intensity: Vec3,
    /// Distance at which it ends, meters; `None` is without end.
    pub range: Option<f32>,
}

/// A camera of the model in world space.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Name, or empty.
    pub name: String,
    /// Position.
    pub eye: Vec3,
    /// Looks along this, unit.
    pub forward: Vec3,
    /// Up, unit.
    pub up: Vec3,
    /// Vertical field of view in radians. An orthographic camera gives the one that frames the same height at the depth
    /// of the model's center.
    pub fovy: f32,
}
