//! A contact sheet: a picture of each of several modes, with its name below, in one PNG.

use std::path::Path;

use image::{Rgba, RgbaImage, imageops};

use super::label::Labels;
use super::{CaptureError, Renderer, Tell, image_of, tell, write};
use crate::settings::Settings;
use crate::shader::Mode;

/// Pixels between the pictures, and around them.
const GAP: u32 = 8;
/// Height of a name, pixels.
const TEXT: f32 = 15.0;
/// Height of the line with a name.
const LINE: u32 = 22;
const PAGE: Rgba<u8> = Rgba([15, 16, 18, 255]);
const NAME: [u8; 3] = [226, 228, 232];
const SLUG: [u8; 3] = [150, 154, 162];
/// Most pixels of a sheet: 1 GiB of memory.
const MOST_PIXELS: u64 = 1 << 28;

/// Contents and size of a sheet.
pub struct SheetPlan {
    /// The modes, in order.
    pub modes: Vec<Mode>,
    /// Width and height of a picture, pixels.
    pub size: (u32, u32),
    /// Pictures in a row; without it as many as make the sheet about 16:9.
    pub columns: Option<u32>,
}

impl SheetPlan {
    /// Columns and rows.
    fn grid(&self) -> (u32, u32) {
        let count = self.modes.len().max(1) as u32;
        let (width, height) = (f64::from(self.size.0) + f64::from(GAP), f64::from(self.size.1) + f64::from(LINE + GAP));
        let fitting = (f64::from(count) * 16.0 / 9.0 * height / width).sqrt().round() as u32;
        let columns = self.columns.unwrap_or(fitting).clamp(1, count);
        (columns, count.div_ceil(columns))
    }

    /// Width and height of the sheet, pixels.
    fn extent(&self) -> (u64, u64) {
        let (columns, rows) = self.grid();
        // No size that can be requested overflows 64 bits.
        let along = |count: u32, each: u64| u64::from(GAP) + u64::from(count) * (each + u64::from(GAP));
        (along(columns, self.size.0.into()), along(rows, u64::from(self.size.1) + u64::from(LINE)))
    }

    /// Draws the sheet and writes it. `paths` is the number of frames of path-traced modes. Restores the settings afterwards.
    ///
    /// # Errors
    /// No modes, a sheet that is too large, a picture that cannot be drawn, a file that cannot be written.
    pub fn write(&self, renderer: &mut dyn Renderer, path: &Path, tell: Tell<'_>) -> Result<(), CaptureError> {
        let sheet = self.draw(renderer, tell)?;
        write(sheet, path)
    }

    /// Draws the sheet.
    ///
    /// # Errors
    /// As [`SheetPlan::write`].
    pub fn draw(&self, renderer: &mut dyn Renderer, tell: Tell<'_>) -> Result<RgbaImage, CaptureError> {
        if self.modes.is_empty() {
            return Err(CaptureError::Usage("none of these modes has data in this model".to_owned()));
        }
        let (width, height) = self.extent();
        if width.saturating_mul(height) > MOST_PIXELS {
            let message =
                format!("a sheet of {width}x{height} pixels is too large; choose fewer modes or smaller pictures");
            return Err(CaptureError::Usage(message));
        }
        let before = renderer.settings().clone();
        let drawn = self.draw_with(renderer, &before, tell);
        *renderer.settings() = before;
        drawn
    }

    fn draw_with(
        &self,
        renderer: &mut dyn Renderer,
        settings: &Settings,
        progress: Tell<'_>,
    ) -> Result<RgbaImage, CaptureError> {
        let labels = Labels::new().map_err(CaptureError::Write)?;
        let (width, height) = self.extent();
        let mut sheet = RgbaImage::from_pixel(width as u32, height as u32, PAGE);
        let (columns, _) = self.grid();
        for (index, mode) in self.modes.iter().enumerate() {
            tell(progress, index, self.modes.len())?;
            let mut settings = Settings { mode: mode.slug.clone(), ..settings.clone() };
            if mode.traces {
                // A path-traced frame takes seconds on a software device.
                settings.view.frames = 1;
            }
            *renderer.settings() = settings;
            let picture = image_of(renderer.capture(self.size)?)?;
            let (column, row) = (index as u32 % columns, index as u32 / columns);
            let (x, y) = (GAP + column * (self.size.0 + GAP), GAP + row * (self.size.1 + LINE + GAP));
            imageops::overlay(&mut sheet, &picture, i64::from(x), i64::from(y));
            let room = self.size.0 as f32;
            let at = (x, y + self.size.1 + 3);
            let name = labels.write(&mut sheet, at, (TEXT, room), NAME, &mode.name);
            let left = room - name - 12.0;
            // The slug follows if it fits.
            if left > 40.0 && !mode.name.eq_ignore_ascii_case(&mode.slug) {
                labels.write(&mut sheet, (x + name as u32 + 8, at.1), (TEXT, left), SLUG, &mode.slug);
            }
        }
        tell(progress, self.modes.len(), self.modes.len())?;
        Ok(sheet)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_are_wide() {
        let plan = |count: usize, columns| SheetPlan { modes: vec![Mode::default(); count], size: (320, 180), columns };
        assert_eq!(plan(1, None).grid(), (1, 1));
        assert_eq!(plan(100, None).grid(), (11, 10));
        assert_eq!(plan(7, Some(3)).grid(), (3, 3));
        assert_eq!(plan(2, Some(9)).grid(), (2, 1));
        assert_eq!(plan(2, Some(1)).extent(), (336, 8 + 2 * 210));
    }
}
