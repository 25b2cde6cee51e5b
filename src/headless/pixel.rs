//! The values of one pixel in several modes.

use std::sync::Arc;

use rayon::prelude::*;

use super::{Headless, HeadlessError, Step};
use crate::frame::{Clock, FrameInputs, FrameState, Revisions, Scene};
use crate::pipeline::PipelineSet;
use crate::render::Redraw;
use crate::scene;
use crate::settings::Settings;
use crate::shader::{Mode, PixelValue, ShaderSet};

/// A frame of which one pixel is read.
pub(super) struct NearPixel {
    whole: Arc<FrameState>,
    all: Scene,
    /// The instances near the pixel; or all, if one of those is transmissive.
    part: Scene,
    settings: Settings,
    revisions: Revisions,
}

impl NearPixel {
    /// `None` if there is no scene.
    pub(super) fn new(headless: &Headless, at: (u32, u32)) -> Result<Option<Self>, HeadlessError> {
        let whole = headless.frame_state()?;
        let Some(all) = whole.scene.clone() else { return Ok(None) };
        let near = scene::near_pixel(all.model(), whole.camera.clip_from_world(), headless.size, at);
        let part = all.only(near);
        let shows_more = part.materials().iter().any(|material| whole.pipelines.is_transmissive(*material));
        let part = if shows_more { all.clone() } else { part };
        let (settings, revisions) = (headless.session.settings.clone(), headless.session.revisions);
        Ok(Some(Self { whole, all, part, settings, revisions }))
    }

    /// The frame in a mode with these shaders. Only the instances near the pixel are drawn, unless a pass may need the others.
    pub(super) fn state(&self, mode: &Mode, clock: Clock, shaders: &Arc<ShaderSet>) -> Arc<FrameState> {
        let state = self.state_in(mode, &self.part, clock, shaders);
        Arc::new(if state.pipelines.is_local() { state } else { self.state_in(mode, &self.all, clock, shaders) })
    }

    fn state_in(&self, mode: &Mode, scene: &Scene, clock: Clock, shaders: &Arc<ShaderSet>) -> FrameState {
        let settings = Settings { mode: mode.slug.clone(), ..self.settings.clone() };
        let scene = &scene.at(&settings.animation, clock.time_s);
        let (scene, revisions) = (Some(scene), self.revisions);
        let (size, target) = (self.whole.size, self.whole.pipelines.target);
        let inputs = FrameInputs { settings: &settings, shaders, scene, revisions, clock, size, target };
        FrameState::new(&inputs).with_numbers()
    }
}

impl Headless {
    /// The values of one pixel, counted from the upper left corner, in each of `modes`; zero where nothing covers the
    /// pixel.
    ///
    /// Only the instances near the pixel are drawn, and only their pipelines are created. If one of them is
    /// transmissive, all instances are drawn, since a transmissive surface refracts light from around the pixel.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn pixel(&mut self, at: (u32, u32), modes: &[Mode]) -> Result<Vec<PixelValue>, HeadlessError> {
        self.pixel_with(at, modes, |_| ())
    }

    /// [`Headless::pixel`], with a report to `progress` after each mode.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn pixel_with(
        &mut self,
        at: (u32, u32),
        modes: &[Mode],
        progress: impl Fn(&Step),
    ) -> Result<Vec<PixelValue>, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let Some(near) = NearPixel::new(self, at)? else { return Ok(Vec::new()) };
        let state_of = |mode: &Mode, clock: Clock| near.state(mode, clock, &near.whole.shaders);
        // The last frame of the sequence is read.
        let sequence = self.sequence;
        let states: Vec<(&Mode, Arc<FrameState>)> =
            modes.iter().map(|mode| (mode, state_of(mode, self.clock))).collect();
        self.view.probe = Some(at);
        let mut values = Vec::new();
        // A set keeps only the pipelines of its newest requests.
        for states in states.chunks(PipelineSet::REQUESTS_KEPT as usize / 2) {
            if let Some(set) = self.resources.pipelines() {
                // A driver compiles a pipeline on the calling thread.
                states.par_iter().try_for_each(|(_, state)| set.build(&state.pipelines).map(|_| ()))?;
            }
            for (mode, state) in states {
                self.view.restart_passes();
                let frame = self.resources.provide(state).map_err(|error| self.explained(error.into()))?;
                // A frame without animation needs no earlier frames.
                let earlier = if frame.is_animated() { sequence.frames.max(1) - 1 } else { 0 };
                for index in 0..earlier {
                    let state = state_of(mode, sequence.clock(index));
                    let frame = self.resources.provide(&state).map_err(|error| self.explained(error.into()))?;
                    self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))?;
                }
                let frame = self.resources.provide(state).map_err(|error| self.explained(error.into()))?;
                self.view.restart_mean();
                let frames = if state.pipelines.accumulates { self.session.settings.view.frames } else { 1 };
                for _ in 0..frames {
                    self.draw_frame(&frame, Redraw::Pixel(at.0, at.1), |_, _, _| Ok(()))?;
                }
                values.push(self.view.pixel(self.frames.current()).map(|pixel| pixel.value).unwrap_or_default());
                progress(&Step { done: values.len() as u64, of: modes.len() as u64, unit: "modes" });
            }
        }
        self.view.probe = None;
        Ok(values)
    }
}
