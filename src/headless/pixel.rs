//! The values of one pixel in several modes.

use std::sync::Arc;

use rayon::prelude::*;

use super::{Headless, HeadlessError, Step};
use crate::frame::{FrameInputs, FrameState, Scene};
use crate::pipeline::PipelineSet;
use crate::render::Redraw;
use crate::scene;
use crate::settings::Settings;
use crate::shader::{Mode, PixelValue};

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

    /// [`Headless::pixel`], which tells `progress` after each mode how far it is.
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
        let whole = self.frame_state()?;
        let Some(all) = whole.scene.clone() else { return Ok(Vec::new()) };
        let near = scene::near_pixel(all.model(), whole.camera.clip_from_world(), self.size, at);
        let part = all.only(near);
        let part = if part.is_transmissive() { all.clone() } else { part };
        let state_in = |mode: &Mode, scene: &Scene| {
            let settings = Settings { mode: mode.slug.clone(), ..self.session.settings.clone() };
            let scene = Some(scene);
            let (shaders, revisions, target) = (&whole.shaders, self.session.revisions, whole.pipelines.target);
            let inputs = FrameInputs {
                settings: &settings,
                shaders,
                scene,
                revisions,
                clock: self.clock,
                size: self.size,
                target,
            };
            FrameState::new(&inputs).with_numbers()
        };
        let state_of = |mode: &Mode| {
            let state = state_in(mode, &part);
            if state.pipelines.is_local() { state } else { state_in(mode, &all) }
        };
        let states: Vec<Arc<FrameState>> = modes.iter().map(|mode| Arc::new(state_of(mode))).collect();
        self.view.probe = Some(at);
        let mut values = Vec::new();
        // A set keeps the pipelines of its newest requests only.
        for states in states.chunks(PipelineSet::REQUESTS_KEPT as usize / 2) {
            if let Some(set) = self.resources.pipelines() {
                // A driver compiles a pipeline on the calling thread.
                states.par_iter().try_for_each(|state| set.build(&state.pipelines).map(|_| ()))?;
            }
            for state in states {
                let frame = self.resources.provide(state).map_err(|error| self.explained(error.into()))?;
                self.view.restart_passes();
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
