//! A contact sheet: several pictures with their legends below, in one PNG.

use std::path::Path;

use clap::ValueEnum;
use image::{Rgba, RgbaImage, imageops};

use super::cells::Cell;
use super::label::Labels;
use super::{CaptureError, Renderer, Tell, image_of, tell, write};
use crate::frame::{Display, legend_limits, short};
use crate::picture;
use crate::report::{Report, Tile};
use crate::settings::ViewRange;

/// Pixels between the pictures, and around them.
const GAP: u32 = 8;
/// Height of a name, pixels.
const TEXT: f32 = 15.0;
/// Height of the line with a name.
const LINE: u32 = 22;
/// Most pixels of a sheet: 1 GiB of memory.
const MOST_PIXELS: u64 = 1 << 28;

/// The page of a sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Page {
    /// For screens.
    #[default]
    Dark,
    /// For print.
    Light,
}

impl Page {
    fn paper(self) -> Rgba<u8> {
        match self {
            Self::Dark => Rgba([15, 16, 18, 255]),
            Self::Light => Rgba([255, 255, 255, 255]),
        }
    }

    /// The colors of a name, and of what follows it.
    fn inks(self) -> ([u8; 3], [u8; 3]) {
        match self {
            Self::Dark => ([226, 228, 232], [150, 154, 162]),
            Self::Light => ([20, 21, 24], [96, 100, 108]),
        }
    }
}

/// Contents and size of a sheet.
pub struct SheetPlan {
    /// The pictures, in order.
    pub cells: Vec<Cell>,
    /// Width and height of a picture, pixels.
    pub size: (u32, u32),
    /// Pictures in a row; without it as many as make the sheet about 16:9.
    pub columns: Option<u32>,
    /// The page below the pictures.
    pub page: Page,
}

impl SheetPlan {
    /// Columns and rows.
    fn grid(&self) -> (u32, u32) {
        let count = self.cells.len().max(1) as u32;
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

    /// Draws the sheet and writes it. Restores the settings afterwards.
    ///
    /// # Errors
    /// No pictures, a sheet that is too large, a picture that cannot be drawn, a file that cannot be written.
    pub fn write(&self, renderer: &mut dyn Renderer, path: &Path, tell: Tell<'_>) -> Result<(), CaptureError> {
        let sheet = self.draw(renderer, &mut |_| (), tell)?;
        write(sheet, path)
    }

    /// The same, and a page of HTML with the pictures of the sheet.
    ///
    /// # Errors
    /// As [`SheetPlan::write`].
    pub fn write_with_page(
        &self,
        renderer: &mut dyn Renderer,
        (path, page): (&Path, &Path),
        tell: Tell<'_>,
    ) -> Result<(), CaptureError> {
        let mut tiles = Vec::new();
        let sheet = self.draw(renderer, &mut |tile| tiles.push(tile), tell)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut report = Report::new(&name);
        report.note("A click enlarges a picture. A click with Shift marks one, and the next click compares both.");
        report.gallery(&tiles, self.columns).map_err(CaptureError::Write)?;
        write(sheet, path)?;
        let cannot = |error| CaptureError::Write(format!("cannot write {}: {error}", page.display()));
        picture::replace_file(page, report.html().as_bytes()).map_err(cannot)
    }

    /// Draws the sheet. `taken` gets each picture.
    fn draw(
        &self,
        renderer: &mut dyn Renderer,
        taken: &mut dyn FnMut(Tile),
        tell: Tell<'_>,
    ) -> Result<RgbaImage, CaptureError> {
        if self.cells.is_empty() {
            return Err(CaptureError::Usage("none of these modes has data in this model".to_owned()));
        }
        let (width, height) = self.extent();
        if width.saturating_mul(height) > MOST_PIXELS {
            let message = format!("a sheet of {width}x{height} pixels is too large; choose fewer or smaller pictures");
            return Err(CaptureError::Usage(message));
        }
        let before = renderer.settings().clone();
        let drawn = self.draw_with(renderer, taken, tell);
        *renderer.settings() = before;
        drawn
    }

    fn draw_with(
        &self,
        renderer: &mut dyn Renderer,
        taken: &mut dyn FnMut(Tile),
        progress: Tell<'_>,
    ) -> Result<RgbaImage, CaptureError> {
        let labels = Labels::new().map_err(CaptureError::Write)?;
        let (width, height) = self.extent();
        let mut sheet = RgbaImage::from_pixel(width as u32, height as u32, self.page.paper());
        let (ink, quiet) = self.page.inks();
        let (columns, _) = self.grid();
        for (index, cell) in self.cells.iter().enumerate() {
            tell(progress, index, self.cells.len())?;
            renderer.settings().clone_from(&cell.settings);
            let view = &mut renderer.settings().view;
            if view.range == ViewRange::Mode {
                // The legend names the range.
                view.range = ViewRange::Auto;
            }
            let picture = image_of(renderer.capture(self.size)?)?;
            let (column, row) = (index as u32 % columns, index as u32 / columns);
            let (x, y) = (GAP + column * (self.size.0 + GAP), GAP + row * (self.size.1 + LINE + GAP));
            imageops::overlay(&mut sheet, &picture, i64::from(x), i64::from(y));
            let room = self.size.0 as f32;
            let at = (x, y + self.size.1 + 3);
            // A name that is cut would be that of its neighbors, too.
            let is_narrow = !cell.short.is_empty() && labels.width(TEXT, &cell.name) > room;
            let name = if is_narrow { &cell.short } else { &cell.name };
            let name = labels.write(&mut sheet, at, (TEXT, room), ink, name);
            let left = room - name - 12.0;
            let note = [range(renderer), cell.note.clone()].into_iter().filter(|part| !part.is_empty());
            let note = note.collect::<Vec<_>>().join(" · ");
            // The rest follows if it fits.
            if left > 40.0 && !note.is_empty() {
                labels.write(&mut sheet, (x + name as u32 + 8, at.1), (TEXT, left), quiet, &note);
            }
            taken(Tile { name: cell.name.clone(), note, image: picture });
        }
        tell(progress, self.cells.len(), self.cells.len())?;
        Ok(sheet)
    }
}

/// The range of the values in the last picture with their unit; empty for light and for colors that stand for numbers.
fn range(renderer: &dyn Renderer) -> String {
    let session = renderer.session();
    let Some(mode) = session.mode().filter(|mode| mode.numbers.is_none()) else { return String::new() };
    let fixed = Display::new(&session.settings.view, Some(mode)).limits(None, None);
    let Some((low, high)) = legend_limits(mode, renderer.measured_limits().or(fixed)) else { return String::new() };
    format!("{} to {} {}", short(low), short(high), mode.unit).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_are_wide() {
        let plan = |count: usize, columns| SheetPlan {
            cells: vec![Cell::default(); count],
            size: (320, 180),
            columns,
            page: Page::Light,
        };
        assert_eq!(plan(1, None).grid(), (1, 1));
        assert_eq!(plan(100, None).grid(), (11, 10));
        assert_eq!(plan(7, Some(3)).grid(), (3, 3));
        assert_eq!(plan(2, Some(9)).grid(), (2, 1));
        assert_eq!(plan(2, Some(1)).extent(), (336, 8 + 2 * 210));
    }
}
