//! A model on the device: one vertex buffer, one index buffer, textures, and a descriptor set per material.

mod buffers;
mod deformables;
mod draw_list;
mod error;
mod frustum;
mod gpu_draw;
mod materials;
mod placed;
mod scratch;
mod sorted;
mod texel_formats;
mod upload;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;

use crate::frame::{Appearance, Scene, draws_by_index};
use crate::gpu::{Buffer, DescriptorSet, Gpu, GpuError, Image, SetLayouts, vk};
use crate::interface::{Draw, Vertex};
use crate::scene::{Instance, Model, Primitive, TextureSource, Topology, triangles};
use buffers::BufferPool;
pub(crate) use deformables::Deformables;
use draw_list::DrawLists;
pub(crate) use draw_list::Run;
pub use error::UploadError;
pub(crate) use frustum::Frustum;
pub(crate) use gpu_draw::GpuDraw;
use materials::{MaterialSets, Textures};
pub(crate) use placed::{PlacedScene, Posed, normals_from};
use scratch::Scratch;
pub(crate) use sorted::{Layer, SortedDraws};
pub use texel_formats::texel_forms;
use upload::{Range, Uploaded, upload, upload_textures};

/// A model on the device: geometry, textures and a descriptor set per material.
pub struct GpuModel {
    model: Arc<Model>,
    vertices: Arc<Buffer>,
    indices: Arc<Buffer>,
    ranges: Arc<[Range]>,
    materials: Vec<Arc<DescriptorSet>>,
    /// The textures of the materials, and those that are bound where a material has none.
    textures: Textures,
    deformables: Option<Arc<Deformables>>,
}

impl GpuModel {
    /// Uploads a model and waits until that is done. Any thread may call this. The model keeps everything but the pixels of its
    /// images.
    ///
    /// # Errors
    /// An image that exceeds the device's limit, or no memory left.
    pub fn upload(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, mut model: Model) -> Result<Arc<Self>, UploadError> {
        let is_other = |p: &Primitive| matches!(p.topology, Topology::TriangleStrip | Topology::TriangleFan);
        if model.primitives.iter().any(is_other) {
            Arc::make_mut(&mut model.primitives).iter_mut().for_each(list_triangles);
        }
        let Uploaded { vertices, indices, ranges, textures, deformers } = upload(gpu, &mut model)?;
        let deformables = deformers.and_then(|from| Deformables::new(&model, &ranges, &vertices, from));
        let materials = material_sets(gpu, layouts, &model, &textures)?;
        let (model, ranges) = (Arc::new(model), ranges.into());
        Ok(Arc::new(Self { model, vertices, indices, ranges, materials, textures, deformables }))
    }

    /// Uploads the textures of a model that has been uploaded while they were being decoded ([`Model::awaits_textures`]). All else is
    /// shared.
    ///
    /// # Errors
    /// As [`GpuModel::upload`].
    pub fn with_textures(
        &self,
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        mut model: Model,
    ) -> Result<Arc<Self>, UploadError> {
        model.primitives = self.model.primitives.clone();
        let textures = upload_textures(gpu, &mut model)?;
        let materials = material_sets(gpu, layouts, &model, &textures)?;
        let (vertices, indices, ranges) = (self.vertices.clone(), self.indices.clone(), self.ranges.clone());
        let (model, deformables) = (Arc::new(model), self.deformables.clone());
        Ok(Arc::new(Self { model, vertices, indices, ranges, materials, textures, deformables }))
    }

    /// The model that was uploaded, without the pixels of its images.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The texture on the device that a material reads in a slot.
    pub(crate) fn texture(&self, source: &TextureSource) -> Option<&Arc<Image>> {
        self.textures.get(source)
    }

    /// The draws of a scene of this model. Uploads only the materials that the settings change.
    ///
    /// # Errors
    /// No memory left.
    pub fn scene(&self, gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, scene: &Scene) -> Result<Arc<GpuScene>, GpuError> {
        let (replacement, samplers) = (scene.replacement(), HashMap::new());
        let mut sets = MaterialSets { gpu, layouts, model: &self.model, textures: &self.textures, samplers };
        let replacement_set = replacement.as_ref().map(|material| sets.set(material, 0)).transpose()?;
        let mut of_material = |(index, own): (usize, &Arc<DescriptorSet>)| match scene.changed_material(index) {
            Some(material) if replacement.is_none() => sets.set(material, index as u32),
            _ => Ok(own.clone()),
        };
        let materials: Vec<_> = self.materials.iter().enumerate().map(&mut of_material).collect::<Result<_, _>>()?;
        let addresses = [self.vertices.address(), self.indices.address()];
        let draw = |(index, instance): (usize, &Instance)| {
            let appearance = scene.appearance(instance, replacement.as_ref());
            let own = appearance.material.and_then(|index| materials.get(index));
            let set = own.or(replacement_set.as_ref())?.clone();
            let draw = draw(&self.model, instance, &self.ranges[instance.primitive], addresses, &appearance, set);
            Some(GpuDraw { instance: index, ..draw })
        };
        let draws = scene.wanted_instances().filter_map(draw).collect();
        let Self { vertices, indices, deformables, .. } = self;
        let (vertices, indices, deformables) = (vertices.clone(), indices.clone(), deformables.clone());
        Ok(Arc::new(GpuScene {
            vertices,
            indices,
            draws,
            deformables,
            buffers: draws_by_index(&self.model).then(|| BufferPool::new(gpu).into()),
            scratch: Mutex::default(),
            lists: Mutex::default(),
        }))
    }
}

fn material_sets(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    model: &Model,
    textures: &Textures,
) -> Result<Vec<Arc<DescriptorSet>>, GpuError> {
    let mut sets = MaterialSets { gpu, layouts, model, textures, samplers: HashMap::new() };
    (0..).zip(model.materials.iter()).map(|(id, material)| sets.set(material, id)).collect()
}

/// The draws of a [`Scene`]. They stay while the scene's pose changes.
pub struct GpuScene {
    pub(crate) vertices: Arc<Buffer>,
    pub(crate) indices: Arc<Buffer>,
    pub(crate) draws: Vec<GpuDraw>,
    /// The instances whose vertices move, drawn or not.
    pub(crate) deformables: Option<Arc<Deformables>>,
    /// Buffers for draws and commands, if the stages find their draw in one, as far as they and the device can.
    buffers: Option<Arc<BufferPool>>,
    scratch: Mutex<Scratch>,
    /// The lists of the last pose.
    lists: Mutex<Option<Arc<DrawLists>>>,
}

impl GpuScene {
    /// The lists of the draws, of which a pose mirrors and hides some.
    fn lists(&self, mirrored: Vec<bool>, hidden: Vec<bool>) -> Arc<DrawLists> {
        let mut lists = self.lists.lock().unwrap_or_else(PoisonError::into_inner);
        match &*lists {
            Some(known) if known.mirrored == mirrored && known.hidden == hidden => known.clone(),
            _ => lists.insert(Arc::new(DrawLists::new(mirrored, hidden, self.buffers.clone()))).clone(),
        }
    }
}

fn draw(
    model: &Model,
    instance: &Instance,
    range: &Range,
    [vertices, indices]: [u64; 2],
    appearance: &Appearance,
    material: Arc<DescriptorSet>,
) -> GpuDraw {
    let primitive = &model.primitives[instance.primitive];
    GpuDraw {
        instance: 0,
        push: Draw {
            vertices: vertices + range.first_vertex * size_of::<Vertex>() as u64,
            attributes: appearance.attributes,
            primitive_id: instance.primitive as u32,
            node_id: instance.node as u32,
            indices: indices + u64::from(range.first_index) * size_of::<u32>() as u64,
            triangle_count: if primitive.topology == Topology::Triangles {
                primitive.indices.len() as u32 / 3
            } else {
                0
            },
            ..Draw::default()
        },
        first_index: range.first_index,
        index_count: primitive.indices.len() as u32,
        topology: topology(primitive.topology),
        double_sided: appearance.double_sided,
        material,
        variant: appearance.variant,
        center: primitive.bounds.center(),
        half_size: match primitive.bounds.is_empty() {
            true => Vec3::INFINITY,
            false => primitive.bounds.max - primitive.bounds.center(),
        },
    }
}

/// Turns a strip or fan of triangles into a list, since a tessellation stage takes triangles one by one.
fn list_triangles(primitive: &mut Primitive) {
    let list = triangles(primitive.topology, &primitive.indices);
    // A strip may have no triangle with a non-zero area.
    if primitive.topology != Topology::Triangles && !list.is_empty() {
        primitive.indices = list.as_flattened().to_vec();
        primitive.topology = Topology::Triangles;
    }
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
