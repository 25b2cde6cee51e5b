//! The values of one pixel in several modes.

use std::sync::Arc;

use rayon::prelude::*;

use super::near_pixel::NearPixel;
use super::{Headless, HeadlessError, Step};
use crate::frame::{Clock, FrameState};
use crate::pipeline::PipelineSet;
use crate::render::Redraw;
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
        let (whole, session) = (self.frame_state()?, &self.session);
        let near = NearPixel::new(&whole, &session.settings, session.revisions, at);
        let Some(near) = near else { return Ok(Vec::new()) };
        let state_of = |mode: &Mode, clock: Clock| near.state(mode, clock, &whole.shaders);
        // The last frame of the sequence is read.
        let sequence = self.sequence;
        let states: Vec<(&Mode, Arc<FrameState>)> =
            modes.iter().map(|mode| (mode, state_of(mode, self.clock))).collect();
        self.offscreen.view.probe = Some(at);
        let mut values = Vec::new();
        // A set keeps only the pipelines of its newest requests.
        for states in states.chunks(PipelineSet::REQUESTS_KEPT as usize / 2) {
            if let Some(set) = self.resources.pipelines() {
                // A driver compiles a pipeline on the calling thread.
                states.par_iter().try_for_each(|(_, state)| set.build(&state.pipelines).map(|_| ()))?;
            }
            for (mode, state) in states {
                self.offscreen.view.restart_passes();
                let frame = self.resources.provide(state).map_err(|error| self.explained(error.into()))?;
                // A frame without animation needs no earlier frames.
                let earlier = if frame.is_animated() { sequence.frames.max(1) - 1 } else { 0 };
                for index in 0..earlier {
                    let state = state_of(mode, sequence.clock(index));
                    let frame = self.resources.provide(&state).map_err(|error| self.explained(error.into()))?;
                    self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))?;
                }
                let frame = self.resources.provide(state).map_err(|error| self.explained(error.into()))?;
                self.offscreen.view.restart_mean();
                let frames = if state.pipelines.accumulates { self.session.settings.view.frames } else { 1 };
                for _ in 0..frames {
                    self.draw_frame(&frame, Redraw::Pixel(at.0, at.1), |_, _, _| Ok(()))?;
                }
                values.push(
                    self.offscreen
                        .view
                        .pixel(self.offscreen.frames.current())
                        .map(|pixel| pixel.value)
                        .unwrap_or_default(),
                );
                progress(&Step { done: values.len() as u64, of: modes.len() as u64, unit: "modes" });
            }
        }
        self.offscreen.view.probe = None;
        Ok(values)
    }
}
