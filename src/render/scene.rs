//! A model on the device: one vertex buffer, one index buffer, textures, and a descriptor set for each material.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use glam::Mat3;
use rayon::prelude::*;

use crate::gpu::{Buffer, DescriptorSet, Gpu, GpuError, Image, ImageDesc, Memory, SetLayouts, Use, one_shot, vk};
use crate::interface::{Draw, FEATURE_TRANSMISSION, Vertex};
use crate::scene::{self as model, Model, Topology};

use super::dress::Dress;
use super::materials::{Textures, materials, variant};
use super::mips;
use super::sources::{Source, sources};
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
#[derive(Clone)]
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
    /// The images that stand in for missing textures.
    pub(super) stand_ins: Textures,
    /// The last one that was made of it by [`GpuScene::dressed`].
    pub(super) last_dress: Mutex<Option<(Dress, Arc<GpuScene>)>>,
    variants: BTreeSet<MaterialVariant>,
    own_lights: usize,
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
        let stand_ins = textures.into_iter().filter(|(source, _)| source.image(model).is_none()).collect();
        let last_dress = Mutex::new(None);
        let own_lights = model.lights.len();
        Ok(Arc::new(Self { indices, vertices, materials, draws, stand_ins, last_dress, variants, own_lights }))
    }

    /// The same with only those of the model's instances that are `kept`.
    pub fn only(&self, kept: &[bool]) -> Arc<Self> {
        let draws = self.draws.iter().zip(kept).filter(|(_, kept)| **kept).map(|(draw, _)| draw.clone());
        self.with(self.materials.clone(), draws.collect())
    }

    /// The same geometry, drawn otherwise.
    pub(super) fn with(&self, materials: Vec<Arc<DescriptorSet>>, draws: Vec<GpuDraw>) -> Arc<Self> {
        Arc::new(Self {
            indices: self.indices.clone(),
            vertices: self.vertices.clone(),
            materials,
            stand_ins: self.stand_ins.clone(),
            last_dress: Mutex::new(None),
            variants: draws.iter().map(|draw| draw.variant).collect(),
            own_lights: self.own_lights,
            draws,
        })
    }

    /// Whether light passes through a surface, so that what lies behind it must be drawn first.
    pub fn is_transmissive(&self) -> bool {
        self.variants.iter().any(|v| v.features & FEATURE_TRANSMISSION != 0)
    }

    /// How many lights the model has.
    pub fn own_lights(&self) -> usize {
        self.own_lights
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

impl<'a> Staging<'a> {
    fn new(gpu: &'a Arc<Gpu>, model: &Model) -> Result<Self, UploadError> {
        let geometry: usize = model
            .primitives
            .iter()
            .map(|p| size_of_val(p.vertices.as_slice()) + size_of_val(p.indices.as_slice()) + 32)
            .sum();
        let bytes = |source: &Source| {
            let (width, height) = size(source, model);
            mips::bytes(width, height) + 16
        };
        let images: usize = sources(model).iter().map(bytes).sum();
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
        let most = self.gpu.max_image_size();
        let mut places = Vec::new();
        for source in sources(model) {
            let (width, height) = size(&source, model);
            let name = source.image(model).map_or("default", |image| &image.name);
            if width > most || height > most {
                return Err(UploadError::ImageTooLarge { name: name.to_owned(), width, height, most });
            }
            let offset = self.reserve(mips::bytes(width, height));
            textures.insert(source, self.image(name, (width, height), source.is_srgb(), offset)?);
            places.push((source, (width, height), offset));
        }
        // The first touch of staging memory costs as much as the copy, so that is shared out too.
        let staging = &self.buffer;
        places.par_iter().for_each(|(source, (width, height), offset)| {
            let pixels = source.pixels(model);
            staging.write(*offset, &pixels);
            let below = mips::below(&pixels, *width, *height, source.is_srgb());
            staging.write(offset + pixels.len() as u64, &below);
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

/// Width and height.
fn size(source: &Source, model: &Model) -> (u32, u32) {
    source.image(model).map_or((1, 1), |image| (image.width, image.height))
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
            variant: variant(model, primitive, material, primitive.attributes),
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
