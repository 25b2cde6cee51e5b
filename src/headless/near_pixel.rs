//! The part of a frame that one of its pixels needs.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::stage_plan::Extent;
use crate::frame::{Clock, FrameInputs, FrameState, MaterialVariant, Revisions, Scene, TargetFormat};
use crate::scene;
use crate::settings::Settings;
use crate::shader::{Mode, ShaderSet};

/// A frame of which one pixel is read.
#[derive(Clone)]
pub(super) struct NearPixel {
    whole: Arc<FrameState>,
    all: Scene,
    /// The instances near the pixel; or all, if one of those is transmissive.
    part: Scene,
    settings: Settings,
    revisions: Revisions,
    /// The format of the picture.
    pub(super) target: TargetFormat,
}

impl NearPixel {
    /// The pixel `at` of the frame `whole`, which has these settings. `None` if there is no scene.
    pub(super) fn new(
        whole: &Arc<FrameState>,
        settings: &Settings,
        revisions: Revisions,
        at: (u32, u32),
    ) -> Option<Self> {
        let all = whole.scene.clone()?;
        let near = scene::near_pixel(all.model(), whole.camera.clip_from_world(), whole.size, at);
        let part = all.only(near);
        let shows_more = part.materials().iter().any(|material| whole.pipelines.is_transmissive(*material));
        let part = if shows_more { all.clone() } else { part };
        let target = whole.pipelines.target;
        Some(Self { whole: whole.clone(), all, part, settings: settings.clone(), revisions, target })
    }

    /// The kinds of material near the pixel.
    pub(super) fn materials(&self) -> &BTreeSet<MaterialVariant> {
        self.part.materials()
    }

    /// The frame in a mode with these shaders. Only the instances near the pixel are drawn, unless a pass may need the others.
    pub(super) fn state(&self, mode: &Mode, clock: Clock, shaders: &Arc<ShaderSet>) -> Arc<FrameState> {
        let state = self.state_in(mode, &self.part, clock, shaders);
        Arc::new(if state.pipelines.is_local() { state } else { self.state_in(mode, &self.all, clock, shaders) })
    }

    /// The frame in a mode with these shaders, of a part of the scene.
    pub(super) fn state_of(
        &self,
        extent: Extent,
        mode: &Mode,
        clock: Clock,
        shaders: &Arc<ShaderSet>,
    ) -> Arc<FrameState> {
        match extent {
            Extent::Near => self.state(mode, clock, shaders),
            Extent::All => Arc::new(self.state_in(mode, &self.all, clock, shaders)),
            Extent::Instance(instance) => {
                let only = (0..self.all.model().instances.len()).map(|other| other == instance).collect();
                Arc::new(self.state_in(mode, &self.all.only(only), clock, shaders))
            }
        }
    }

    fn state_in(&self, mode: &Mode, scene: &Scene, clock: Clock, shaders: &Arc<ShaderSet>) -> FrameState {
        let settings = Settings { mode: mode.slug.clone(), ..self.settings.clone() };
        let scene = &scene.at(&settings.animation, clock.time_s);
        let (scene, revisions) = (Some(scene), self.revisions);
        let (size, target) = (self.whole.size, self.target);
        let inputs = FrameInputs { settings: &settings, shaders, scene, revisions, clock, size, target };
        FrameState::new(&inputs).with_numbers()
    }
}
