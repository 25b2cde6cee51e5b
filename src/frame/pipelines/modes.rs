//! The pipelines that draw several modes at once.

use super::PipelineRequest;
use crate::frame::{Scene, SharedMode, TargetFormat};
use crate::settings::Settings;
use crate::shader::graph::RenderPhase;
use crate::shader::{Mode, ShaderSet};

impl PipelineRequest {
    /// The pipelines that draw these modes at once. `modes` is one of [`crate::frame::mode_sets`].
    pub(crate) fn of_modes(
        settings: &Settings,
        shaders: &ShaderSet,
        scene: Option<&Scene>,
        target: TargetFormat,
        modes: &[&Mode],
    ) -> Self {
        let mode = modes.first().map(|mode| mode.slug.clone()).unwrap_or_default();
        let mut request = Self::new(&Settings { mode, ..settings.clone() }, shaders, scene, target);
        request
            .passes
            .retain(|pass| matches!(pass.phase, RenderPhase::BeforeModel | RenderPhase::Model | RenderPhase::Tonemap));
        (request.wireframe, request.wireframe_stage) = (None, String::new());
        if modes.len() > 1 {
            request.modes = modes.iter().map(|mode| SharedMode { id: mode.id, encode: mode.encode.id() }).collect();
        }
        request
    }
}
