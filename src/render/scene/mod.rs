//! A model on the device: one vertex buffer, one index buffer, textures, and a descriptor set for each material.

mod appearance;
mod materials;
pub(super) mod mips;
mod texture_source;
mod upload;

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use glam::Mat3;

use crate::gpu::{Buffer, DescriptorSet, Gpu, GpuError, SetLayouts, vk};
use crate::interface::{Draw, FEATURE_TRANSMISSION, Vertex};
use crate::scene::{self as model, Model, Topology};

use crate::render::scene::appearance::Dress;
use crate::render::scene::materials::{Textures, materials, variant};
use crate::render::scene::upload::{Range, Uploaded, upload};
use crate::render::wanted::MaterialVariant;

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
pub(crate) struct GpuDraw {
    pub(crate) push: Draw,
    pub(crate) first_index: u32,
    pub(crate) index_count: u32,
    pub(crate) topology: vk::PrimitiveTopology,
    pub(crate) front: vk::FrontFace,
    pub(crate) double_sided: bool,
    pub(crate) material: usize,
    pub(crate) variant: MaterialVariant,
    pub(crate) center_ws: glam::Vec3,
}

/// A model that can be drawn.
pub struct GpuScene {
    pub(crate) indices: Arc<Buffer>,
    pub(crate) vertices: Arc<Buffer>,
    pub(crate) materials: Vec<Arc<DescriptorSet>>,
    pub(crate) draws: Vec<GpuDraw>,
    /// The images that stand in for missing textures.
    pub(crate) stand_ins: Textures,
    /// The last one that was made of it by [`GpuScene::dressed`].
    pub(crate) last_dress: Mutex<Option<(Dress, Arc<GpuScene>)>>,
    variants: BTreeSet<MaterialVariant>,
    own_lights: usize,
}

impl GpuScene {
    /// Uploads a model and waits for it. From any thread. The model comes back without pixels: `rgba8` of each of its
    /// images is empty.
    ///
    /// # Errors
    /// An image beyond the device's limit, or no memory left.
    pub fn upload(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        mut model: Model,
    ) -> Result<(Model, Arc<Self>), UploadError> {
        let Uploaded { vertices, indices, ranges, textures } = upload(gpu, &mut model)?;
        let materials = materials(gpu, layouts, &model, &textures)?;
        let draws = draws(&model, vertices.address(), &ranges);
        let variants = draws.iter().map(|d| d.variant).collect();
        let stand_ins = textures.into_iter().filter(|(source, _)| source.image(&model).is_none()).collect();
        let last_dress = Mutex::new(None);
        let own_lights = model.lights.len();
        let scene = Self { indices, vertices, materials, draws, stand_ins, last_dress, variants, own_lights };
        Ok((model, Arc::new(scene)))
    }

    /// The same with only those of the model's instances that are `kept`.
    pub fn only(&self, kept: &[bool]) -> Arc<Self> {
        let draws = self.draws.iter().zip(kept).filter(|(_, kept)| **kept).map(|(draw, _)| draw.clone());
        self.with(self.materials.clone(), draws.collect())
    }

    /// The same geometry, drawn otherwise.
    pub(crate) fn with(&self, materials: Vec<Arc<DescriptorSet>>, draws: Vec<GpuDraw>) -> Arc<Self> {
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
