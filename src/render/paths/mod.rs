//! The resources that random paths need beyond those of a picture: the model's triangles in a bounding volume hierarchy, its
//! materials in one buffer, and a table from which directions towards the environment's light are drawn.
//!
//! A path reaches any triangle of the model, and a descriptor set per material cannot be chosen by a shader on devices without
//! descriptor indexing. So everything after the first hit is compact: see `shaders/paths/scene.glsl`.

mod geometry;
mod materials;

use std::sync::Arc;
use std::time::Instant;

use crate::frame::Scene;
use crate::gpu::{Buffer, Gpu, GpuError, Image, Memory, Sampler, SamplerDesc, Use, one_shot, vk};
use crate::interface::{BvhNode, EnvironmentCell, TracedMaterial};
use crate::render::compute;
use crate::render::environment::maps::GpuEnvironment;
use crate::render::scene::GpuModel;
use crate::scene::environment::CubeLuminance;
use geometry::Geometry;
use materials::{Materials, layers};

const REPEAT: vk::SamplerAddressMode = vk::SamplerAddressMode::REPEAT;

/// Why a model cannot be path-traced.
#[derive(Debug, thiserror::Error)]
pub enum PathTracingError {
    /// The scene has too many triangles.
    #[error(
        "random paths trace at most {most} triangles, and this model has more. Modes without `traces` still show it"
    )]
    TooManyTriangles {
        /// The limit.
        most: usize,
    },
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Identifies what random paths trace.
#[derive(Clone)]
pub struct PathTracingKey {
    /// The scene, if the mode traces the model.
    pub(super) scene: Option<Scene>,
    /// The environment whose light paths are drawn towards.
    pub(super) environment: Arc<GpuEnvironment>,
}

impl PartialEq for PathTracingKey {
    fn eq(&self, other: &Self) -> bool {
        self.scene == other.scene && Arc::ptr_eq(&self.environment, &other.environment)
    }
}

/// A request to make what random paths trace.
#[derive(Clone)]
pub struct PathTracingRequest {
    pub(super) key: PathTracingKey,
    /// The model of the key's scene.
    pub(super) model: Option<Arc<GpuModel>>,
    /// The result that was made last. Its parts are taken over where the key is the same.
    pub(super) before: Option<(PathTracingKey, Arc<PathTracing>)>,
}

impl PathTracingRequest {
    /// Identifies the result.
    pub fn key(&self) -> &PathTracingKey {
        &self.key
    }
}

impl std::fmt::Debug for PathTracingRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PathTracingRequest").field("scene", &self.key.scene).finish_non_exhaustive()
    }
}

/// A scene that paths can hit, on the device.
pub(crate) struct TracedScene {
    pub(crate) nodes: Arc<Buffer>,
    pub(crate) triangles: Arc<Buffer>,
    pub(crate) corners: Arc<Buffer>,
    pub(crate) materials: Arc<Buffer>,
    pub(crate) textures: Arc<Image>,
    pub(crate) sampler: Arc<Sampler>,
}

/// The scene and the light that path tracing samples.
pub struct PathTracing {
    pub(crate) scene: Arc<TracedScene>,
    /// Alias table for importance sampling of the environment: the number of cells along a face's side, and the cells.
    pub(crate) alias_table: Arc<Buffer>,
}

impl PathTracing {
    /// No triangles, and an environment without light: for modes without path tracing.
    ///
    /// # Errors
    /// Out of memory.
    pub(crate) fn empty(gpu: &Arc<Gpu>) -> Result<Arc<Self>, GpuError> {
        Ok(Arc::new(Self { scene: TracedScene::empty(gpu)?, alias_table: alias_table_buffer(gpu, 0, &[])? }))
    }

    /// Builds the hierarchy of a scene and the table of an environment, and uploads both. Any thread may call this.
    ///
    /// # Errors
    /// Too many triangles, or out of memory.
    pub fn new(gpu: &Arc<Gpu>, request: &PathTracingRequest) -> Result<Arc<Self>, PathTracingError> {
        let PathTracingRequest { key, model, before } = request;
        let before = before.as_ref();
        let scene = match (before.filter(|(made, _)| made.scene == key.scene), &key.scene, model) {
            (Some((_, before)), ..) => before.scene.clone(),
            (None, Some(scene), Some(model)) => TracedScene::new(gpu, scene, model)?,
            _ => TracedScene::empty(gpu)?,
        };
        let alias_table = match before.filter(|(made, _)| Arc::ptr_eq(&made.environment, &key.environment)) {
            Some((_, before)) => before.alias_table.clone(),
            None => alias_table_of(gpu, &key.environment.radiance.cube)?,
        };
        Ok(Arc::new(Self { scene, alias_table }))
    }
}

impl TracedScene {
    fn empty(gpu: &Arc<Gpu>) -> Result<Arc<Self>, GpuError> {
        let geometry = Geometry { nodes: vec![BvhNode::default()], ..Geometry::default() };
        Self::with(gpu, &geometry, &[], layers(gpu, &[])?)
    }

    fn new(gpu: &Arc<Gpu>, scene: &Scene, model: &GpuModel) -> Result<Arc<Self>, PathTracingError> {
        let start = Instant::now();
        let geometry = Geometry::new(scene)?;
        let mut materials = Materials::new(model);
        let replacement = scene.replacement();
        let own = (0..scene.model().materials.len()).map(|index| scene.material(index));
        let all = own.chain(&replacement);
        let packed: Vec<TracedMaterial> = all.map(|material| materials.pack(material)).collect();
        let (triangles, nodes) = (geometry.triangles.len(), geometry.nodes.len());
        let ms = start.elapsed().as_secs_f64() * 1e3;
        tracing::debug!("paths: {triangles} triangles in {nodes} nodes, {ms:.1} ms");
        Ok(Self::with(gpu, &geometry, &packed, layers(gpu, materials.layers())?)?)
    }

    fn with(
        gpu: &Arc<Gpu>,
        geometry: &Geometry,
        materials: &[TracedMaterial],
        textures: Arc<Image>,
    ) -> Result<Arc<Self>, GpuError> {
        let repeat = SamplerDesc { wrap_u: REPEAT, wrap_v: REPEAT, mips: false, ..SamplerDesc::LINEAR };
        Ok(Arc::new(Self {
            nodes: buffer(gpu, "bounding volumes", &geometry.nodes)?,
            triangles: buffer(gpu, "traced triangles", &geometry.triangles)?,
            corners: buffer(gpu, "traced corners", &geometry.corners)?,
            materials: buffer(gpu, "traced materials", materials)?,
            textures,
            sampler: Sampler::new(gpu, &repeat)?,
        }))
    }
}

/// A storage buffer of these elements, or of one blank element if there are none.
fn buffer<T: bytemuck::Pod>(gpu: &Arc<Gpu>, name: &str, elements: &[T]) -> Result<Arc<Buffer>, GpuError> {
    let blank = [T::zeroed()];
    let elements = if elements.is_empty() { &blank } else { elements };
    compute::upload_buffer(gpu, name, bytemuck::cast_slice(elements))
}

/// Reads an environment's cube map back and builds its table.
fn alias_table_of(gpu: &Arc<Gpu>, cube: &Arc<Image>) -> Result<Arc<Buffer>, GpuError> {
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let texels = Buffer::new(gpu, "environment readback", cube.desc().level_bytes(0), usage, Memory::Readback)?;
    one_shot(gpu, |encoder| {
        encoder.transition(cube, Use::Sampled, Use::CopyFrom);
        encoder.copy_from_image(cube, &texels);
        encoder.transition(cube, Use::CopyFrom, Use::Sampled);
        encoder.copies_done();
        Ok(())
    })?;
    let texels: Vec<[half::f16; 4]> = bytemuck::pod_collect_to_vec::<u8, [u16; 4]>(texels.content())
        .into_iter()
        .map(|texel| texel.map(half::f16::from_bits))
        .collect();
    let (side, alias_table) = CubeLuminance::new(cube.desc().width as usize, &texels).alias_table();
    alias_table_buffer(gpu, side as u32, &alias_table)
}

/// The block `EnvironmentCells` of shaders/paths/environment_sampling.glsl.
fn alias_table_buffer(gpu: &Arc<Gpu>, side: u32, alias_table: &[EnvironmentCell]) -> Result<Arc<Buffer>, GpuError> {
    let mut bytes = side.to_ne_bytes().to_vec();
    bytes.extend_from_slice(bytemuck::cast_slice(alias_table));
    bytes.resize(bytes.len().max(4 + size_of::<EnvironmentCell>()), 0);
    compute::upload_buffer(gpu, "environment cells", &bytes)
}
