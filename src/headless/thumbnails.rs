//! Thumbnails of debug modes, as the window's gallery shows them.

use std::sync::Arc;

use super::{Headless, HeadlessError};
use crate::frame::{FrameState, TargetFormat, mode_sets};
use crate::gpu::{Buffer, Memory, Use, vk};
use crate::render::{BoundFrame, Thumbnails};
use crate::shader::Mode;

/// A small picture of a mode.
#[derive(Clone, Debug)]
pub struct Thumbnail {
    /// The mode's name on the command line.
    pub slug: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// RGBA, 8 bits, rows from the top.
    pub rgba8: Vec<u8>,
}

impl Headless {
    /// Draws a thumbnail of each of those `modes` that can have one, in the order of drawing.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn thumbnails(&mut self, size: (u32, u32), modes: &[Mode]) -> Result<Vec<Thumbnail>, HeadlessError> {
        self.finish_or_fail()?;
        let target = self.target()?;
        let mut thumbnails = Thumbnails::new(&self.gpu, &self.layouts, 1)?;
        let mut drawn = Vec::new();
        for set in mode_sets(modes, Thumbnails::most_at_once(&self.gpu)) {
            let frame = self.bind_modes(&set, size, target, |state| state)?;
            let atlas = Thumbnails::atlas(&self.gpu, size, (1, set.len() as u32))?;
            let corners: Vec<(u32, u32)> = (0..set.len() as u32).map(|row| (0, row * size.1)).collect();
            let bytes = atlas.desc().bytes();
            let pixels =
                Buffer::new(&self.gpu, "thumbnails", bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
            let mut encoder = self.offscreen.frames.begin()?;
            encoder.transition(&atlas, Use::Undefined, Use::CopyTo);
            thumbnails.draw(&mut encoder, 0, &frame, &atlas, &corners)?;
            encoder.transition(&atlas, Use::CopyTo, Use::CopyFrom);
            encoder.copy_from_image(&atlas, &pixels);
            encoder.copies_done();
            self.offscreen.frames.submit(encoder, Default::default())?;
            // SYNC: the CPU reads the thumbnails.
            self.offscreen.frames.wait()?;
            let mut rgba8 = pixels.read();
            rgba8.chunks_exact_mut(4).for_each(|bgra| bgra.swap(0, 2));
            let each = rgba8.chunks_exact(rgba8.len() / set.len());
            let made = set.iter().zip(each);
            drawn.extend(made.map(|(mode, rgba8)| Thumbnail { slug: mode.slug.clone(), size, rgba8: rgba8.to_vec() }));
        }
        Ok(drawn)
    }

    /// The frame that draws a set of modes at once, with its pipelines. `adapt` changes its state first.
    pub(super) fn bind_modes(
        &mut self,
        set: &[&Mode],
        size: (u32, u32),
        target: TargetFormat,
        adapt: impl FnOnce(FrameState) -> FrameState,
    ) -> Result<BoundFrame, HeadlessError> {
        let (shaders, scene) = (self.shaders(), self.session.scene());
        let inputs = self.session.inputs(&shaders, scene.as_ref(), self.clock, size, target);
        let state = Arc::new(adapt(FrameState::of_modes(&inputs, set)));
        self.resources.provide(&state).map_err(|error| self.explained(error.into()))
    }
}
