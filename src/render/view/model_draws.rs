//! Draws the model with the pipelines of a pass: with vertices and indices, or with mesh stages. Also draws quads.
//!
//! **Two ways to a draw.** Stages read the matrices, addresses and numbers of their draw from a block `draw`. In a model of
//! few draws, the block is push constants, which are recorded with each draw: a device reads nothing faster. In a model
//! of many, Specula rewrites the stages (`spirv/draw_index.rs`): they read the block from a buffer of all draws, which
//! is written when the pose changes, and one command draws all that share their state. The commands are in a buffer,
//! too. `frame::draws_by_index` decides. Stages that cannot be rewritten, such as those with tessellation, draw one by
//! one; so does a device without `multiDrawIndirect`, which needs no push constants then.
//!
//! **Mesh stages** (`VK_EXT_mesh_shader`) run in place of the vertex stage. Indices have an address in `Draw`, as
//! vertices do, so a mesh stage reads both through push constants, and no descriptor changes between draws. The
//! workgroup size of the stage says how many triangles a group has: the reflected `local_size`, 32 in
//! `common/model.mesh.glsl`, which keeps 96 vertices of a `Fragment` far below every limit. A draw starts `triangles /
//! local_size` workgroups times the instances; with a task stage, each of its invocations decides about one group.
//! Primitives that need more workgroups than each device can start take several draws (`first_triangle`). A device
//! without the extension refuses the stages in `pipeline/limits.rs`, after they have compiled, so `check` finds their
//! errors anywhere.
//!
//! Groups share no vertices between triangles, so each corner is transformed once per triangle, and they follow the
//! order of the indices, not the shape of the surface. `draws` and `triangles` of `bench` count what a mesh pipeline is
//! given, not what its stages keep.

use std::collections::HashMap;
use std::sync::Arc;

use super::declared::PassSets;
use crate::frame::{MaterialVariant, PipelineKey, QUADS};
use crate::gpu::{Buffer, DescriptorSet, DrawCommand, DrawRun, Encoder, Pipeline, SetLayouts, vk};
use crate::interface::{ALPHA_BLEND, Draw, MAX_LIGHT_VIEWS};
use crate::render::bound_frame::BoundFrame;
use crate::render::scene::{GpuDraw, PlacedScene, Run};
use crate::shader::GraphPass;
use crate::shader::annotation::pass::{Cull, Instances};
use crate::shader::graph::MeshStages;

/// Workgroups of task or mesh stages that every device can start along x, and in all.
const MOST_ALONG_X: u32 = 65_535;
const MOST_WORKGROUPS: u32 = 1 << 22;

/// Draws of a frame's model.
pub(super) struct ModelDraws<'a> {
    pub(super) layouts: &'a Arc<SetLayouts>,
    pub(super) frame: &'a BoundFrame,
    pub(super) placed: Option<&'a Arc<PlacedScene>>,
    pub(super) sets: &'a PassSets,
    /// How often each is drawn.
    pub(super) instances: u32,
    pub(super) pass: &'a Arc<GraphPass>,
}

/// Draws in the order in which they are recorded.
pub(super) struct Draws<'a> {
    pub(super) runs: &'a [Run],
    /// The commands of the runs.
    pub(super) commands: &'a [DrawCommand],
    /// The same commands for the device.
    pub(super) buffer: Option<&'a Arc<Buffer>>,
}

/// State that stays between draws. Only changes are recorded, since a scene may have many draws and few materials.
#[derive(Default)]
struct Bound<'a> {
    material: Option<&'a Arc<DescriptorSet>>,
    pipeline: Option<&'a Arc<Pipeline>>,
    raster: Option<(vk::PrimitiveTopology, vk::CullModeFlags, vk::FrontFace)>,
}

impl ModelDraws<'_> {
    /// Draws with the pipelines that `key` selects by material.
    pub(super) fn draw(
        &self,
        encoder: &mut Encoder,
        draws: &Draws<'_>,
        key: impl Fn(MaterialVariant) -> Option<PipelineKey>,
    ) {
        let Some(placed) = self.placed else { return };
        // It keeps all vertices that draws read by address.
        encoder.keep(placed);
        encoder.bind_indices(&placed.scene.indices);
        let pipeline_of = |material| key(material).and_then(|key| self.frame.pipelines.get(&key));
        let (mut known, mut bound) = (HashMap::new(), Bound::default());
        let (mut last, records) = (None, placed.records());
        for run in draws.runs {
            let GpuDraw { variant, material, .. } = &placed.scene.draws[run.draw as usize];
            let pipeline = match last {
                Some((of, pipeline)) if of == *variant => pipeline,
                _ => *known.entry(*variant).or_insert_with(|| pipeline_of(*variant)),
            };
            last = Some((*variant, pipeline));
            let Some(pipeline) = pipeline.filter(|pipeline| !pipeline.draws_by_index || records.is_some()) else {
                continue;
            };
            if bound.material.replace(material).is_none_or(|last| !Arc::ptr_eq(last, material)) {
                encoder.bind_set(self.layouts, material);
            }
            if bound.pipeline.replace(pipeline).is_none_or(|last| !Arc::ptr_eq(last, pipeline)) {
                self.sets.bind(encoder, pipeline);
                if let Some(records) = records.filter(|_| pipeline.draws_by_index) {
                    encoder.push(self.layouts, &records);
                }
            }
            self.draw_run(encoder, &mut bound, draws, run, pipeline.draws_by_index);
        }
    }

    /// Draws what a declared pass draws: the model, or its quads.
    pub(super) fn draw_pass(&self, encoder: &mut Encoder) {
        let request = &self.frame.state.pipelines;
        if !self.pass.desc.quads {
            let key = |material| Some(request.model_pass_key(self.pass, material));
            // Blended surfaces keep the order of the scene.
            return self.draw_all(encoder, self.pass.desc.blend, key);
        }
        let Some(pipeline) = self.frame.pipelines.get(&request.model_pass_key(self.pass, QUADS)) else { return };
        // World space is object space.
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let [x, y, z] = identity;
        let world_from_object = [x, y, z, [0.0; 3]];
        encoder.push(self.layouts, &Draw { world_from_object, normal_ws_from_object: identity, ..Draw::default() });
        self.sets.bind(encoder, pipeline);
        let topology = match self.pass.pre_rasterization.tessellation {
            Some(_) => vk::PrimitiveTopology::PATCH_LIST,
            None => vk::PrimitiveTopology::TRIANGLE_LIST,
        };
        let cull = match self.pass.desc.cull {
            Some(Cull::Front) => vk::CullModeFlags::FRONT,
            Some(Cull::Back) => vk::CullModeFlags::BACK,
            Some(Cull::None) | None => vk::CullModeFlags::NONE,
        };
        encoder.set_raster(topology, cull, vk::FrontFace::COUNTER_CLOCKWISE);
        encoder.draw_quads(self.instances);
    }

    /// Draws the whole model, seen or not; if `is_ordered`, in the order of the scene.
    pub(super) fn draw_all(
        &self,
        encoder: &mut Encoder,
        is_ordered: bool,
        key: impl Fn(MaterialVariant) -> Option<PipelineKey>,
    ) {
        let Some(placed) = self.placed else { return };
        let (draws, lists) = (&placed.scene.draws, placed.lists());
        let list = if is_ordered { lists.ordered(draws) } else { lists.grouped(draws) };
        let commands = list.commands(self.instances);
        let draws = Draws { runs: &list.runs, commands: &commands.list, buffer: commands.buffer.as_ref() };
        self.draw(encoder, &draws, key);
    }

    fn draw_run(&self, encoder: &mut Encoder, bound: &mut Bound<'_>, draws: &Draws<'_>, run: &Run, by_index: bool) {
        let Some(placed) = self.placed else { return };
        let (draw, front_face) = (&placed.scene.draws[run.draw as usize], placed.front_face(run.draw));
        // A blended double-sided surface is drawn back faces first, since they lie behind. Its run is a single draw.
        let passes: &[vk::CullModeFlags] = match (self.pass.desc.cull, draw.double_sided, draw.variant.alpha) {
            (Some(Cull::None), ..) => &[vk::CullModeFlags::NONE],
            (Some(Cull::Front), ..) => &[vk::CullModeFlags::FRONT],
            (None, true, ALPHA_BLEND) => &[vk::CullModeFlags::FRONT, vk::CullModeFlags::BACK],
            (None, true, _) => &[vk::CullModeFlags::NONE],
            (Some(Cull::Back), ..) | (None, false, _) => &[vk::CullModeFlags::BACK],
        };
        let topology = match self.pass.pre_rasterization.tessellation {
            Some(_) => vk::PrimitiveTopology::PATCH_LIST,
            None => draw.topology,
        };
        let DrawRun { first, count, .. } = run.commands;
        let commands = &draws.commands[first as usize..][..count as usize];
        for cull in passes {
            let raster = (topology, *cull, front_face);
            let is_new = bound.raster.replace(raster) != Some(raster);
            if let Some(mesh) = &self.pass.pre_rasterization.mesh {
                if is_new {
                    encoder.set_facing(*cull, front_face);
                }
                commands.iter().for_each(|draw| self.draw_mesh(encoder, placed.push(draw.first_instance), mesh));
                continue;
            }
            if is_new {
                encoder.set_raster(topology, *cull, front_face);
            }
            if by_index {
                encoder.draw_run(draws.commands, draws.buffer, &run.commands, self.instances);
                continue;
            }
            for draw in commands {
                encoder.push(self.layouts, placed.push(draw.first_instance));
                encoder.draw_indexed(draw.index_count, draw.first_index, self.instances);
            }
        }
    }

    /// Draws the triangles of a primitive with mesh stages, in as many draws as a device may require.
    fn draw_mesh(&self, encoder: &mut Encoder, push: &Draw, mesh: &MeshStages) {
        let each = mesh.triangles.saturating_mul(mesh.groups).max(1);
        let workgroups = (MOST_WORKGROUPS / self.instances.max(1)).clamp(1, MOST_ALONG_X);
        let (most, all) = (workgroups.saturating_mul(each), push.triangle_count);
        let mut first_triangle = 0;
        while first_triangle < all {
            let triangles = most.min(all - first_triangle);
            encoder.push(self.layouts, &Draw { first_triangle, ..*push });
            encoder.draw_mesh(triangles.div_ceil(each), self.instances, triangles);
            first_triangle += triangles;
        }
    }
}

/// How often a pass draws the model, or how many quads; 0 if it does not.
pub(super) fn instances(frame: &BoundFrame, pass: &GraphPass) -> u32 {
    match pass.desc.model {
        Some(Instances::Count(count)) => count,
        Some(Instances::Lights) => frame.lights().len().min(MAX_LIGHT_VIEWS) as u32,
        None => 0,
    }
}
