//! Draws the model of a picture in parts, so that nothing else waits for the whole.
//!
//! Each part is a submission of its own: the next rows of the model, from the lowest up. The last of them leaves the targets as one draw of the
//! whole model does, bit for bit, since a part has the same commands with another scissor. [`View::draw`] then draws the rest of the picture.
//!
//! With several samples, lavapipe also draws to the row above the scissor. Upwards, that row belongs to the next part, which clears it.

use super::declared::{FrameImages, PassContext};
use super::new_picture::{InParts, NewPicture, picture_rect};
use super::passes::{Part, Passes};
use super::peel_images::PeelImages;
use super::{Redraw, View};
use crate::frame::FrameState;
use crate::gpu::{Encoder, GpuError, Rect};
use crate::render::bound_frame::BoundFrame;

impl View {
    /// Whether the targets hold the picture of `frame`, for an accumulating mode with one frame or more in its mean.
    pub fn holds(&self, frame: &BoundFrame) -> bool {
        self.targets.is_some() && self.new_picture(frame, None, Redraw::ToneMap).is_none()
    }

    /// Whether more frames would improve the picture of `frame`.
    pub fn improves(&self, frame: &BoundFrame) -> bool {
        frame.state.pipelines.accumulates && self.accumulated() < Self::MOST_ACCUMULATED
    }

    /// How many rows of the model of the next picture of `frame` are drawn.
    pub fn rows_in_parts(&self, frame: &BoundFrame) -> u32 {
        self.parts.as_ref().filter(|parts| parts.is_of(frame)).map_or(0, |parts| parts.rows)
    }

    /// Draws the next `rows` or a few more of the model of a new picture of `frame`, as [`View::draw`] does, which draws the rest of the picture once
    /// [`View::rows_in_parts`] are all. Any other picture in between drops them. `at`: the upper left corner of that output.
    ///
    /// # Errors
    /// Out of memory. Call [`View::forget`] then.
    pub fn draw_part(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        at: (u32, u32),
        rows: u32,
    ) -> Result<(), GpuError> {
        if self.targets.is_none() {
            return Ok(());
        }
        let next = self.parts.take().filter(|parts| parts.is_of(frame) && !parts.is_whole());
        let begun = || self.new_picture(frame, None, Redraw::IfChanged).map(|new| (new, 0));
        let Some((new, drawn)) = next.map(|parts| (parts.new, parts.rows)).or_else(begun) else { return Ok(()) };
        if !frame.state.pipelines.accumulates {
            // The target is drawn over; an accumulation buffer stays until the frame is added.
            self.drawn = None;
        }
        let part = part_of(&frame.state, drawn, rows);
        self.draw_rows(encoder, slot, frame, (at, new), part)?;
        self.parts = Some(InParts { frame: frame.clone(), new, rows: drawn + part.rows.height });
        Ok(())
    }

    fn draw_rows(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        (at, new): ((u32, u32), NewPicture),
        part: Part,
    ) -> Result<(), GpuError> {
        let set = self.frame_set(slot, frame)?;
        let limits = self.limits();
        let rect = picture_rect(frame, at);
        let constants = frame.constants(rect, new.sample_index, new.cameras[1]);
        let constants = frame.state.display.constants(constants, limits);
        let Some(targets) = &self.targets else { return Ok(()) };
        let in_flight = &mut self.in_flight[slot];
        in_flight.uniforms.write(&constants, (&frame.lights(), &frame.state.light_grid), frame.state.params());
        encoder.bind_set(&self.layouts, &set);
        let placed = match part.is_first {
            true => self.motion.place(encoder, slot, frame, &set, true)?,
            false => self.motion.placed().cloned(),
        };
        let (placed, depth, blocks) = (placed.as_ref(), targets.read_depth(), &in_flight.blocks);
        let context = PassContext { frame, placed, frame_set: &set, blocks, constants: &constants, depth };
        if part.is_first {
            self.declared.before_model(encoder, &context)?;
        }
        let (samples, opaque_scene) = (targets.multisampled.as_ref(), targets.opaque_scene.as_ref());
        let images = FrameImages { picture: Some(&targets.color), samples, opaque_scene, ..FrameImages::default() };
        let sets = self.declared.sets_of(&context, &images, frame.state.pipelines.model_keys())?;
        let peeling = PeelImages::new(&mut self.declared, &context, targets)?;
        let (layouts, more, peeling) = (&self.layouts, &[][..], peeling.as_ref());
        let (only, part) = (None, Some(part));
        Passes { layouts, targets, frame, placed, sets: &sets, only, more, peeling, part }.model(encoder);
        Ok(())
    }
}

/// Rows of a part are a multiple of this. Fragments have derivatives over blocks of two rows, in which a fragment that is cut off may read
/// other values than one that is drawn.
const BLOCK: u32 = 4;

/// The next rows of a frame, of which so many are `drawn`.
fn part_of(state: &FrameState, drawn: u32, rows: u32) -> Part {
    let (width, height) = state.size;
    let end = height - drawn;
    let begin = end.saturating_sub(rows.max(1)) / BLOCK * BLOCK;
    let rows = Rect { x: 0, y: begin, width, height: end - begin };
    Part { rows, is_first: drawn == 0, is_last: begin == 0 }
}
