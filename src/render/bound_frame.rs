//! A picture together with the device objects that draw it.

use std::sync::Arc;

use glam::Mat4;

use super::brdf::tables::Tables;
use super::environment::maps::GpuEnvironment;
use super::paths::PathTracing;
use super::scene::GpuScene;
use crate::frame::FrameState;
use crate::gpu::{Buffer, Rect};
use crate::interface::{CLOCK, Frame, Light};
use crate::pipeline::BoundPipelines;
use crate::shader::graph::{Input, RenderPhase};

/// A [`FrameState`] with all the pipelines and resources that draw it. It keeps them alive after newer ones replace them.
#[derive(Clone)]
pub struct BoundFrame {
    /// The picture.
    pub state: Arc<FrameState>,
    pub(super) pipelines: Arc<BoundPipelines>,
    pub(super) scene: Option<Arc<GpuScene>>,
    pub(super) tables: Arc<Tables>,
    pub(super) environment: Arc<GpuEnvironment>,
    pub(super) measured: Arc<Buffer>,
    pub(super) path_tracing: Arc<PathTracing>,
}

impl BoundFrame {
    /// The same pipelines and resources with another state, which must need the same ones: only camera, lights or time may
    /// differ.
    #[must_use]
    pub fn with_state(&self, state: FrameState) -> Self {
        Self { state: Arc::new(state), ..self.clone() }
    }

    /// [`FrameState::constants`] with this environment.
    pub(super) fn constants(&self, rect: Rect, sample_index: u32, before: Mat4) -> Frame {
        self.state.constants(rect, self.environment.scale_and_suns(), sample_index, before)
    }

    /// The lights of the frame, then the suns of its environment.
    pub(super) fn lights(&self) -> Vec<Light> {
        self.state.lights_and_suns(self.environment.scale_and_suns())
    }

    /// The size of [`Self::lights`], bytes.
    pub(super) fn light_bytes(&self) -> usize {
        size_of::<Light>() * (self.state.lights.len() + self.state.pipelines.sun_count as usize)
    }

    /// Whether both draw the same frame, bit for bit.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.has_same_resources(other) && (Arc::ptr_eq(&self.state, &other.state) || self.state.is_same(&other.state))
    }

    /// Whether the model looks the same in both: they differ only in the time and in what passes after the model do with it.
    /// Accumulation then continues.
    pub(super) fn is_same_model(&self, other: &Self) -> bool {
        match self.has_animated_model() {
            true => self.is_same(other),
            false => self.has_same_resources(other) && self.state.is_same_model(&other.state),
        }
    }

    /// Whether the frame depends on the time: a stage reads the clock, a pass reads its previous output, or the model has an animation.
    pub fn is_animated(&self) -> bool {
        self.has_moving_shaders() || self.state.scene.as_ref().is_some_and(|scene| scene.is_animated())
    }

    /// Whether the frame stays the same as time passes. An animation that is not repeated ends.
    pub fn rests(&self) -> bool {
        !self.has_moving_shaders() && self.state.scene.as_ref().is_none_or(|scene| !scene.is_playing())
    }

    /// Whether a frame of another size, alone, shows the same: no stage reads earlier frames, nor the camera that they had.
    pub fn stands_alone(&self) -> bool {
        let mut inputs = self.state.pipelines.passes.iter().flat_map(|pass| pass.inputs.values());
        !self.reads_motion() && !inputs.any(|input| matches!(input, Input::Before(_) | Input::Buffer(..)))
    }

    /// Whether both have the same pipelines, light and tables: they differ in camera, lights, parameters, factors of materials, pose or time.
    pub fn is_drawn_alike(&self, other: &Self) -> bool {
        self.has_same_pipelines(other)
            && Arc::ptr_eq(&self.tables, &other.tables)
            && Arc::ptr_eq(&self.environment, &other.environment)
            && Arc::ptr_eq(&self.measured, &other.measured)
    }

    /// Whether both have the same pipelines.
    pub fn has_same_pipelines(&self, other: &Self) -> bool {
        self.pipelines.is_same(&other.pipelines)
    }

    /// Whether a stage reads the clock, or a pass its previous output.
    fn has_moving_shaders(&self) -> bool {
        self.pipelines.read_clock || self.state.pipelines.passes.iter().any(|pass| pass.moves)
    }

    /// Whether a stage reads keys.
    pub fn reads_keys(&self) -> bool {
        self.pipelines.read_keys
    }

    /// Whether the model, or a pass that it reads, changes as time passes.
    fn has_animated_model(&self) -> bool {
        let request = &self.state.pipelines;
        let passes = || request.passes.iter().filter(|pass| pass.phase <= RenderPhase::Mean);
        let before = || passes().filter(|pass| pass.phase == RenderPhase::BeforeModel);
        let mut keys = request.model_keys().chain(before().flat_map(|pass| request.pass_keys(pass)));
        let compute = |stage: &str| self.pipelines.compute(stage).is_some_and(|of| of.usage.reads_frame(&CLOCK));
        keys.any(|key| self.pipelines.get(&key).is_some_and(|pipeline| pipeline.usage.reads_frame(&CLOCK)))
            || passes().any(|pass| pass.moves)
            || before().any(|pass| compute(&pass.desc.stage))
    }

    /// Whether a stage reads the camera of the previous frame.
    pub(super) fn reads_motion(&self) -> bool {
        self.pipelines.read_motion
    }

    fn has_same_resources(&self, other: &Self) -> bool {
        let same_scene = match (&self.scene, &other.scene) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        same_scene
            && self.pipelines.is_same(&other.pipelines)
            && Arc::ptr_eq(&self.tables, &other.tables)
            && Arc::ptr_eq(&self.environment, &other.environment)
            && Arc::ptr_eq(&self.measured, &other.measured)
            && Arc::ptr_eq(&self.path_tracing, &other.path_tracing)
    }
}
