//! A model on the device: one vertex buffer, one index buffer, textures, and a descriptor set for each material.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use glam::Mat3;
use rayon::prelude::*;

use crate::gpu::{
    Buffer, DescriptorSet, Gpu, GpuError, Image, ImageDesc, Memory, PrimitiveClass, Sampler, SamplerDesc, SetLayouts,
    SetWriter, Use, one_shot, vk,
};
use crate::interface::{self, Draw, TEXTURE_BASE_COLOR, TEXTURE_COUNT, TEXTURE_EMISSIVE, TEXTURE_NORMAL, Vertex};
use crate::scene::{self as model, AlphaMode, Model, Topology};

use super::mips;
use super::wanted::MaterialVariant;

/// Why a model cannot be put on the device.
#[derive(Debug, thiserror::Error)]
pub enum UploadError {
    /// An image is too large.
    #[error("image '{name}' is {width}x{height}; this device takes at most {most} pixels a side. Scale it down")]
    ImageTooLarge {
        /// Its name.
        name: String,
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The device's limit.
        most: u32,
    },
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// One draw call.
pub(super) struct GpuDraw {
    pub(super) push: Draw,
    pub(super) first_index: u32,
    pub(super) index_count: u32,
    pub(super) topology: vk::PrimitiveTopology,
    pub(super) front: vk::FrontFace,
    pub(super) double_sided: bool,
    pub(super) material: usize,
    pub(super) variant: MaterialVariant,
    pub(super) center_ws: glam::Vec3,
}

/// A model that can be drawn.
pub struct GpuScene {
    pub(super) indices: Arc<Buffer>,
    pub(super) vertices: Arc<Buffer>,
    pub(super) materials: Vec<Arc<DescriptorSet>>,
    pub(super) draws: Vec<GpuDraw>,
    variants: BTreeSet<MaterialVariant>,
}

impl GpuScene {
    /// Uploads a model and waits for it. From any thread.
    ///
    /// # Errors
    /// An image beyond the device's limit, or no memory left.
    pub fn upload(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, model: &Model) -> Result<Arc<Self>, UploadError> {
        let mut staging = Staging::new(gpu, model)?;
        let Geometry { vertices, indices, ranges } = staging.geometry(model)?;
        let textures = staging.textures(model)?;
        staging.submit()?;
        let materials = materials(gpu, layouts, model, &textures)?;
        let draws = draws(model, vertices.address(), &ranges);
        let variants = draws.iter().map(|d| d.variant).collect();
        Ok(Arc::new(Self { indices, vertices, materials, draws, variants }))
    }

    /// The kinds of material in the scene.
    pub fn variants(&self) -> &BTreeSet<MaterialVariant> {
        &self.variants
    }
}

/// All primitives in two buffers.
struct Geometry {
    vertices: Arc<Buffer>,
    indices: Arc<Buffer>,
    ranges: Vec<Range>,
}

/// Where a primitive lies in the shared buffers.
struct Range {
    first_vertex: u64,
    first_index: u32,
}

/// A texture as it is used: an image in one color space.
type Textures = HashMap<(usize, bool), Arc<Image>>;

/// Base color and emissive textures hold colors; the others hold numbers.
fn is_srgb(slot: usize) -> bool {
    slot == TEXTURE_BASE_COLOR as usize || slot == TEXTURE_EMISSIVE as usize
}

/// Collects copies into one staging buffer and runs them as one submission.
struct Staging<'a> {
    gpu: &'a Arc<Gpu>,
    buffer: Arc<Buffer>,
    used: u64,
    buffers: Vec<(u64, Arc<Buffer>)>,
    images: Vec<(u64, Arc<Image>)>,
}

const TEXTURE_USAGE: vk::ImageUsageFlags =
    vk::ImageUsageFlags::from_raw(vk::ImageUsageFlags::SAMPLED.as_raw() | vk::ImageUsageFlags::TRANSFER_DST.as_raw());

/// Images that stand in for missing textures: white, and a flat normal.
const WHITE: (usize, bool) = (usize::MAX, false);
const FLAT_NORMAL: (usize, bool) = (usize::MAX - 1, false);

impl<'a> Staging<'a> {
    fn new(gpu: &'a Arc<Gpu>, model: &Model) -> Result<Self, UploadError> {
        let geometry: usize = model
            .primitives
            .iter()
            .map(|p| size_of_val(p.vertices.as_slice()) + size_of_val(p.indices.as_slice()) + 32)
            .sum();
        let bytes = |image: &model::Image| mips::bytes(image.width, image.height) + 16;
        let images: usize = uses(model).iter().map(|(image, _)| bytes(&model.images[*image])).sum();
        let size = (geometry + images + 64) as u64;
        let buffer = Buffer::new(gpu, "staging", size, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload)?;
        Ok(Self { gpu, buffer, used: 0, buffers: Vec::new(), images: Vec::new() })
    }

    /// Sets `length` bytes apart; returns where.
    fn reserve(&mut self, length: usize) -> u64 {
        let offset = self.used.next_multiple_of(16);
        self.used = offset + length as u64;
        offset
    }

    fn push(&mut self, bytes: &[u8]) -> u64 {
        let offset = self.reserve(bytes.len());
        self.buffer.write(offset, bytes);
        offset
    }

    fn geometry(&mut self, model: &Model) -> Result<Geometry, UploadError> {
        let (mut ranges, mut first_vertex, mut first_index) = (Vec::new(), 0u64, 0u32);
        for primitive in &model.primitives {
            ranges.push(Range { first_vertex, first_index });
            first_vertex += primitive.vertices.len() as u64;
            first_index += primitive.indices.len() as u32;
        }
        let flat: Vec<Vertex> = model.primitives.iter().flat_map(|p| p.vertices.iter().copied()).collect();
        let indices: Vec<u32> = model.primitives.iter().flat_map(|p| p.indices.iter().copied()).collect();
        use vk::BufferUsageFlags as Usage;
        let vertex_usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS | Usage::TRANSFER_DST;
        let vertices = self.buffer("vertices", bytemuck::cast_slice(&flat), vertex_usage)?;
        let index_usage = Usage::INDEX_BUFFER | Usage::TRANSFER_DST;
        let indices = self.buffer("indices", bytemuck::cast_slice(&indices), index_usage)?;
        Ok(Geometry { vertices, indices, ranges })
    }

    fn buffer(&mut self, name: &str, bytes: &[u8], usage: vk::BufferUsageFlags) -> Result<Arc<Buffer>, UploadError> {
        let buffer = Buffer::new(self.gpu, name, bytes.len() as u64, usage, Memory::Device)?;
        if !bytes.is_empty() {
            let offset = self.push(bytes);
            self.buffers.push((offset, buffer.clone()));
        }
        Ok(buffer)
    }

    fn textures(&mut self, model: &Model) -> Result<Textures, UploadError> {
        let mut textures = Textures::new();
        for (key, color) in [(WHITE, [255; 4]), (FLAT_NORMAL, [128, 128, 255, 255])] {
            let offset = self.push(&color);
            textures.insert(key, self.image("default", (1, 1), false, offset)?);
        }
        let most = self.gpu.max_image_size();
        let mut places = Vec::new();
        for (index, srgb) in uses(model) {
            let image = &model.images[index];
            let (name, width, height) = (&image.name, image.width, image.height);
            if width > most || height > most {
                return Err(UploadError::ImageTooLarge { name: name.clone(), width, height, most });
            }
            let offset = self.reserve(mips::bytes(width, height));
            textures.insert((index, srgb), self.image(name, (width, height), srgb, offset)?);
            places.push((image, srgb, offset));
        }
        // The first touch of staging memory costs as much as the copy, so that is shared out too.
        let staging = &self.buffer;
        places.par_iter().for_each(|(image, srgb, offset)| {
            staging.write(*offset, &image.rgba8);
            let below = mips::below(&image.rgba8, image.width, image.height, *srgb);
            staging.write(offset + image.rgba8.len() as u64, &below);
        });
        Ok(textures)
    }

    /// Makes an image whose levels will lie at `offset`, one after the other.
    fn image(
        &mut self,
        name: &str,
        (width, height): (u32, u32),
        srgb: bool,
        offset: u64,
    ) -> Result<Arc<Image>, UploadError> {
        let format = if srgb { vk::Format::R8G8B8A8_SRGB } else { vk::Format::R8G8B8A8_UNORM };
        let mips = mips::count(width, height);
        let image =
            Image::new(self.gpu, name, ImageDesc { mips, ..ImageDesc::new(width, height, format, TEXTURE_USAGE) })?;
        self.images.push((offset, image.clone()));
        Ok(image)
    }

    /// Copies everything.
    fn submit(self) -> Result<(), UploadError> {
        one_shot(self.gpu, |encoder| {
            for (offset, buffer) in &self.buffers {
                encoder.copy_buffer(&self.buffer, *offset, buffer, buffer.size());
            }
            for (offset, image) in &self.images {
                encoder.transition(image, Use::Undefined, Use::CopyTo);
                encoder.copy_to_image(&self.buffer, *offset, image);
                encoder.transition(image, Use::CopyTo, Use::Sampled);
            }
            encoder.copies_done();
            Ok(())
        })?;
        Ok(())
    }
}

/// Every image that a material uses, with whether it is read as sRGB.
fn uses(model: &Model) -> BTreeSet<(usize, bool)> {
    let slots = model.materials.iter().flat_map(|m| m.textures.iter().enumerate());
    slots.filter_map(|(slot, u)| u.map(|u| (model.textures[u.texture].image, is_srgb(slot)))).collect()
}

fn materials(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    model: &Model,
    textures: &Textures,
) -> Result<Vec<Arc<DescriptorSet>>, UploadError> {
    let mut samplers: HashMap<model::Sampler, Arc<Sampler>> = HashMap::new();
    let mut sets = Vec::new();
    for (id, material) in (0u32..).zip(&model.materials) {
        let packed = pack(material, id);
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let buffer = Buffer::new(gpu, "material", size_of_val(&packed) as u64, usage, Memory::Upload)?;
        buffer.write(0, bytemuck::bytes_of(&packed));
        let mut writer = SetWriter::default().buffer(0, &buffer);
        for (slot, used) in material.textures.iter().enumerate() {
            let default = if slot == TEXTURE_NORMAL as usize { FLAT_NORMAL } else { WHITE };
            let texture = used.map(|u| model.textures[u.texture]);
            let key = texture.map_or(default, |t| (t.image, is_srgb(slot)));
            let wanted = texture.map(|t| t.sampler).unwrap_or_default();
            let sampler = match samplers.get(&wanted) {
                Some(sampler) => sampler.clone(),
                None => samplers.entry(wanted).or_insert(make_sampler(gpu, &wanted)?).clone(),
            };
            if let Some(image) = textures.get(&key) {
                writer = writer.texture(1 + slot as u32, image, &sampler);
            }
        }
        sets.push(DescriptorSet::new(layouts, interface::SET_MATERIAL, writer)?);
    }
    Ok(sets)
}

fn pack(material: &model::Material, id: u32) -> interface::Material {
    let mut packed = interface::Material {
        base_color_factor: material.base_color_factor.to_array(),
        emissive_factor: material.emissive_factor.to_array(),
        metallic_factor: material.metallic_factor,
        roughness_factor: material.roughness_factor,
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        alpha_cutoff: material.alpha_cutoff,
        id,
        uv_from_texture: [[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]; TEXTURE_COUNT],
        ..Default::default()
    };
    for (slot, used) in material.textures.iter().enumerate() {
        let Some(used) = used else { continue };
        packed.texture_mask |= 1 << slot;
        packed.uv1_mask |= used.uv_set << slot;
        let m = used.uv_from_mesh;
        packed.uv_from_texture[slot] =
            [m.matrix2.x_axis.to_array(), m.matrix2.y_axis.to_array(), m.translation.to_array()];
    }
    packed
}

fn make_sampler(gpu: &Arc<Gpu>, sampler: &model::Sampler) -> Result<Arc<Sampler>, GpuError> {
    let filter = |linear| if linear { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
    let wrap = |wrap| match wrap {
        model::Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        model::Wrap::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
        model::Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    // A software device pays for each anisotropic sample; a GPU hardly notices.
    let smooth = sampler.mag_linear && sampler.min_linear && sampler.mip == model::Mip::Linear;
    let anisotropy = if smooth && gpu.info().kind != "cpu" { 8 } else { 1 };
    Sampler::new(
        gpu,
        &SamplerDesc {
            mag: filter(sampler.mag_linear),
            min: filter(sampler.min_linear),
            mip: match sampler.mip {
                model::Mip::Linear => vk::SamplerMipmapMode::LINEAR,
                model::Mip::None | model::Mip::Nearest => vk::SamplerMipmapMode::NEAREST,
            },
            mips: sampler.mip != model::Mip::None,
            wrap_u: wrap(sampler.wrap_u),
            wrap_v: wrap(sampler.wrap_v),
            anisotropy,
        },
    )
}

fn draws(model: &Model, vertices: u64, ranges: &[Range]) -> Vec<GpuDraw> {
    let draw = |instance: &model::Instance| {
        let primitive = &model.primitives[instance.primitive];
        let range = &ranges[instance.primitive];
        let material = &model.materials[primitive.material];
        let world = instance.world_from_object;
        let linear = Mat3::from_mat4(world);
        let determinant = linear.determinant();
        // The cofactors are the inverse transpose times the determinant, and exist for flattened objects too, which have no
        // inverse. The shader normalizes, so only the determinant's sign is missing.
        let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
        let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
        let normals = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign;
        let push = Draw {
            vertices: vertices + range.first_vertex * size_of::<Vertex>() as u64,
            world_from_object: world.to_cols_array_2d().map(|c| [c[0], c[1], c[2]]),
            normal_ws_from_object: normals.to_cols_array_2d(),
            attributes: primitive.attributes,
            primitive_id: instance.primitive as u32,
            node_id: instance.node as u32,
        };
        GpuDraw {
            push,
            first_index: range.first_index,
            index_count: primitive.indices.len() as u32,
            topology: topology(primitive.topology),
            front: if determinant < 0.0 { vk::FrontFace::CLOCKWISE } else { vk::FrontFace::COUNTER_CLOCKWISE },
            double_sided: material.double_sided,
            material: primitive.material,
            variant: variant(primitive, material),
            center_ws: world.transform_point3(primitive.bounds.center()),
        }
    };
    model.instances.iter().map(draw).collect()
}

fn topology(topology: Topology) -> vk::PrimitiveTopology {
    match topology {
        Topology::Points => vk::PrimitiveTopology::POINT_LIST,
        Topology::Lines => vk::PrimitiveTopology::LINE_LIST,
        Topology::LineStrip => vk::PrimitiveTopology::LINE_STRIP,
        Topology::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
        Topology::TriangleStrip => vk::PrimitiveTopology::TRIANGLE_STRIP,
        Topology::TriangleFan => vk::PrimitiveTopology::TRIANGLE_FAN,
    }
}

fn variant(primitive: &model::Primitive, material: &model::Material) -> MaterialVariant {
    let has_frame = primitive.attributes & interface::ATTRIBUTE_TANGENT_FRAME != 0;
    let has_normal_texture = material.textures[TEXTURE_NORMAL as usize].is_some() && has_frame;
    MaterialVariant {
        alpha: match material.alpha_mode {
            AlphaMode::Opaque => interface::ALPHA_OPAQUE,
            AlphaMode::Mask => interface::ALPHA_MASK,
            AlphaMode::Blend => interface::ALPHA_BLEND,
        },
        features: if material.unlit { interface::FEATURE_UNLIT } else { 0 }
            | if has_normal_texture { interface::FEATURE_NORMAL_TEXTURE } else { 0 },
        class: match primitive.topology {
            Topology::Points => PrimitiveClass::Points,
            Topology::Lines | Topology::LineStrip => PrimitiveClass::Lines,
            Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan => PrimitiveClass::Triangles,
        },
    }
}
