//! The resources that random paths need beyond those of a picture: the model's triangles in a bounding volume hierarchy, its
//! materials in one buffer, and a table from which directions towards the environment's light are drawn.
//!
//! A path reaches any triangle of the model, and a descriptor set per material cannot be chosen by a shader on devices without
//! descriptor indexing. So everything after the first hit is compact: see `shaders/paths/scene.glsl`.
//!
//! A mode that says `stage=paths` is drawn by `paths.frag`. A path starts at the rasterized fragment, with its full
//! material and the user's edits. At each point it samples two directions, one towards a light (`paths/lights.glsl`)
//! and one of the BRDF's lobes (`paths/lobe_sampling.glsl`), weighted by the balance heuristic; both call
//! `evaluate_brdf`. A mode that says `traces` also sends rays through the model (`paths/bvh.glsl`): for shadows, and to
//! continue from what a ray hits, `view.bounces` times.
//!
//! | part of [`PathTracing`] | what it is | made by | bytes |
//! |---|---|---|---|
//! | nodes, triangles, corners | a binary BVH (binned SAH) over the triangles in world space | `scene/bvh.rs`, `geometry.rs` | up to 64 + 36 + 52 per triangle |
//! | materials | metallic-roughness factors, index of refraction, specular factors | `materials.rs` | 156 each |
//! | textures | base color, metallic-roughness and emission as 256 x 256 layers of one array | `materials.rs` | 256 KiB each, at most 256 |
//! | alias table | over 256 x 256 x 6 cells of the environment's cube map | `scene/environment/importance.rs` | 4.5 MiB |
//!
//! `paths/scene.glsl` lists the properties that a fragment has and a hit lacks: normal textures, all extensions but
//! specular factors, mip levels, the second of two TEXCOORD sets. Both faces of every triangle stop rays. At most 2^21
//! triangles are traced, so that each buffer stays within the 128 MiB that every device has; beyond that, the mode says
//! so. `user_surface` changes what a hit has as well (`hooked_surface`).
//!
//! These resources are made when a mode first needs them, and kept until the scene or the environment changes: without
//! a window by `Resources::provide`, in the window by the baker, while the last frame stays. A mode with `paths` alone
//! gets the alias table and an empty BVH.
//!
//! `path-error` is the path-traced picture minus the rasterized one. It is the sum of five modes, defined in
//! `debug/paths.glsl`:
//!
//! | mode | with | minus |
//! |---|---|---|
//! | `prefilter-error` | the split sum with exact means of the environment | the split sum as baked |
//! | `split-sum-error` | the exact integral of the unoccluded environment | the split sum with exact means |
//! | `occlusion-error` | what the model occludes of that integral | what the occlusion texture takes from the split sum |
//! | `shadow-error` | punctual lights with shadows | punctual lights without |
//! | `bounce-error` | light from other surfaces of the model | nothing |
//!
//! A path whose light is NaN, infinite or above 10^15 cd/m^2 counts as black. Its pixel turns magenta and is flagged,
//! so an edit that breaks a formula shows, and does not swamp the average. A frame of one path per pixel takes about 13
//! s of CPU time on lavapipe (shader ball, 960 x 640), and the window waits for it: a frame is not split into tiles.

mod error;
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
pub use error::PathTracingError;
use geometry::Geometry;
use materials::{Materials, layers};

const REPEAT: vk::SamplerAddressMode = vk::SamplerAddressMode::REPEAT;

/// Identifies the resources that path tracing needs.
#[derive(Clone)]
pub struct PathTracingKey {
    /// The scene, if the mode traces the model.
    pub(super) scene: Option<Scene>,
    /// The environment that light samples are drawn from.
    pub(super) environment: Arc<GpuEnvironment>,
}

impl PartialEq for PathTracingKey {
    fn eq(&self, other: &Self) -> bool {
        self.scene == other.scene && Arc::ptr_eq(&self.environment, &other.environment)
    }
}

/// A request to build the resources for path tracing.
#[derive(Clone)]
pub struct PathTracingRequest {
    pub(super) key: PathTracingKey,
    /// The model of the key's scene.
    pub(super) model: Option<Arc<GpuModel>>,
    /// The previous result. Its parts are reused where the key is unchanged.
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

/// The scene that rays are traced through, on the device.
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

    /// Builds the BVH of a scene and the alias table of an environment, and uploads both. Any thread may call this.
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

/// Reads an environment's cube map back and builds its alias table.
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
    let texels: Vec<[half::f16; 4]> = bytemuck::pod_collect_to_vec::<u8, [u16; 4]>(&texels.read())
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
