//! Draws the whole picture of a preview in parts.

use std::sync::Arc;

use super::Screen;
use super::parts::Part;
use super::request::FRAMES_IN_FLIGHT;
use crate::frame::FrameState;
use crate::gpu::GpuError;
use crate::render::BoundFrame;

impl Screen {
    /// Whether the device has run the last part.
    pub(in crate::app) fn parts_are_finished(&self) -> bool {
        self.parts.is_finished()
    }

    /// Draws the next part of the last frame's picture, once the device has run the one before.
    ///
    /// # Errors
    /// A device error other than out of memory, which is kept for the end of the frame.
    pub(in crate::app) fn draw_part(&mut self) -> Result<Part, GpuError> {
        if !self.parts.is_finished() {
            return Ok(Part::Drawing);
        }
        self.parts.take_time()?;
        if let Some(words) = self.parts.frames.endless_loop(0) {
            let state = self.last.as_ref().map(|frame| frame.state.clone());
            state.into_iter().for_each(|state| self.part_is_endless(state, words));
            return Ok(Part::Failed);
        }
        let Some(frame) = self.last.clone() else { return Ok(Part::Due) };
        let done = self.view.rows_in_parts(&frame);
        if done >= frame.state.size.1 || self.view.holds(&frame) && !self.view.improves(&frame) {
            return Ok(Part::Due);
        }
        if done == 0 {
            self.parts.ms = 0.0;
        }
        let recorded = self.record_part(&frame);
        if recorded.as_ref().is_err_and(GpuError::is_shortage) {
            self.view.forget();
        }
        Ok(if self.survive(recorded)?.is_some() { Part::Drawing } else { Part::Failed })
    }

    fn record_part(&mut self, frame: &BoundFrame) -> Result<(), GpuError> {
        let mut encoder = self.parts.frames.begin()?;
        let rows = self.parts.rows;
        self.view.draw_part(&mut encoder, FRAMES_IN_FLIGHT, frame, self.rect.at, rows)?;
        self.parts.frames.submit(encoder, Default::default())?;
        self.parts.submitted = Some(rows);
        Ok(())
    }

    fn part_is_endless(&mut self, state: Arc<FrameState>, words: [u32; 2]) {
        self.view.forget();
        self.loops.part_is_endless(state, words);
    }

    /// Device time of the parts of the picture that the last frame has completed, milliseconds.
    pub(in crate::app) fn parts_ms(&self) -> f64 {
        self.parts.ms
    }
}
