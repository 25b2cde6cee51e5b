//! The values of one pixel in many modes, drawn as the window's inspector draws them.

use super::{Headless, HeadlessError};
use crate::frame::{FrameState, TargetFormat, mode_sets};
use crate::render::{PixelModes, Texel, Thumbnails, read_texels, texel_places};
use crate::shader::{Mode, PixelValue};

impl Headless {
    /// The values of the pixel `at`, counted from the upper left corner, in each of those `modes` that can be drawn together with
    /// others, in the order of drawing. Unlike [`Headless::pixel`], this leaves out passes after the model, and transmissive
    /// surfaces show nothing behind them.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn inspect(&mut self, at: (u32, u32), modes: &[Mode]) -> Result<Vec<(String, PixelValue)>, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let mut pixel = PixelModes::new(&self.gpu, &self.layouts, 1)?;
        let mut found = Vec::new();
        for set in mode_sets(modes, Thumbnails::most_at_once(&self.gpu)) {
            let frame = self.bind_modes(&set, self.size, TargetFormat::full(1), FrameState::with_numbers)?;
            let mut encoder = self.offscreen.frames.begin()?;
            pixel.draw(&mut encoder, 0, &frame, at)?;
            self.offscreen.frames.submit(encoder, Default::default())?;
            // SYNC: the CPU reads the values.
            self.offscreen.frames.wait()?;
            found.extend(set.iter().map(|mode| mode.slug.clone()).zip(pixel.values(0)));
        }
        Ok(found)
    }

    /// The texels that the pixel `at` reads, of each texture of its material.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn texels(&mut self, at: (u32, u32)) -> Result<Vec<Texel>, HeadlessError> {
        let places = texel_places(&*self.frame_state()?, at);
        Ok(read_texels(&self.gpu, &self.resources, &mut self.offscreen.frames, places)?)
    }
}
