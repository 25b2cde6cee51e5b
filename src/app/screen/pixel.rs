//! The value of the pixel under the mouse.

use glam::Vec2;

use super::pointed::Pointed;
use super::{FRAMES_IN_FLIGHT, Screen};
use crate::frame::FrameState;
use crate::render::{NotFinitePixels, PixelAt, View};
use crate::shader::PixelValue;

/// The pixel under the mouse in the newest finished frame.
pub(in crate::app) struct PixelUnderMouse<'a> {
    pub(in crate::app) pixel: PixelAt,
    /// Whether it belongs to the picture that the user compares with.
    pub(in crate::app) is_of_reference: bool,
    /// The state of its picture.
    pub(in crate::app) state: &'a FrameState,
    /// Its value in 32 bits if that can be read, and `None` in it until it has been read.
    pub(in crate::app) exact: Option<Option<PixelValue>>,
}

impl Screen {
    /// The newest value under the mouse, and whether it is the reference's.
    pub(in crate::app) fn pixel(&self) -> Option<(PixelAt, bool)> {
        self.pixel
    }

    /// The pixel of the picture at a place of the window.
    pub(in crate::app) fn pixel_at(&self, at: Vec2) -> Option<(u32, u32)> {
        let (x, y) = (at.x - self.rect.at.0 as f32, at.y - self.rect.at.1 as f32);
        let (width, height) = self.last.as_ref()?.state.size;
        (x >= 0.0 && y >= 0.0).then_some((x as u32, y as u32)).filter(|(x, y)| *x < width && *y < height)
    }

    /// The pixel of the picture under the mouse.
    pub(in crate::app) fn mouse_pixel(&self) -> Option<(u32, u32)> {
        self.pixel_at(self.pointer?)
    }

    /// The mode of the grid at a place of the window.
    pub(in crate::app) fn grid_mode_at(&self, at: Vec2) -> Option<String> {
        self.cells.at(at).map(|(index, _)| self.cells.0[index].mode.clone())
    }

    /// The slot of the newest finished frame.
    fn newest_finished(&self) -> Option<usize> {
        let mut newest_first =
            (0..FRAMES_IN_FLIGHT).map(|age| (self.frames.current() + FRAMES_IN_FLIGHT - age) % FRAMES_IN_FLIGHT);
        newest_first.find(|slot| self.frames.is_finished(*slot))
    }

    /// The values in the images of passes that the newest finished frame reports.
    pub(in crate::app) fn pass_pixels(&self) -> Vec<(String, PixelAt)> {
        self.newest_finished().map(|slot| self.view.pass_pixels(slot)).unwrap_or_default()
    }

    /// The pixels with NaN in a finished frame that has looked for them.
    pub(in crate::app) fn take_scan(&mut self) -> Option<NotFinitePixels> {
        let mut finished = (0..FRAMES_IN_FLIGHT).filter(|slot| self.frames.is_finished(*slot));
        finished.find_map(|slot| self.view.take_scan(slot))
    }

    /// Reads the probed pixel of the newest finished frame.
    pub(super) fn read_pixel(&mut self) {
        if let Some(slot) = self.newest_finished() {
            let cell = self.cells.probed();
            self.pixel = match &self.reference {
                _ if cell.is_some() => cell.and_then(|cell| cell.view.pixel(slot)).map(|pixel| (pixel, false)),
                Some(reference) if reference.view.probe.is_some() => {
                    reference.view.pixel(slot).map(|pixel| (pixel, true))
                }
                _ => self.view.pixel(slot).map(|pixel| (pixel, false)),
            };
        }
    }

    /// Reads the samples of the newest finished frames, which decide automatic ranges and fill the histogram.
    pub(super) fn read_range_sample(&mut self) {
        for slot in (0..FRAMES_IN_FLIGHT).filter(|slot| self.frames.is_finished(*slot)) {
            self.view.take_range_sample(slot);
            self.cells.0.iter_mut().for_each(|cell| cell.view.take_range_sample(slot));
            if let Some(reference) = &mut self.reference {
                reference.view.take_range_sample(slot);
            }
        }
    }

    /// Requests the value under the mouse, from the picture or from the reference, whichever is shown there.
    pub(in crate::app) fn place_probe(&mut self) {
        let at = self.mouse_pixel();
        let cell = self.pointer.and_then(|at| self.cells.at(at));
        for (index, other) in self.cells.0.iter_mut().enumerate() {
            // A cell without a frame would never deliver a value.
            other.view.probe = cell.filter(|(of, _)| *of == index && other.shown.is_some()).map(|(_, at)| at);
        }
        let of_reference = at.is_some_and(|at| self.is_in_reference(at));
        self.view.probe = at.filter(|_| !of_reference);
        if let Some(reference) = &mut self.reference {
            // LDR colors of a file have no raw value.
            reference.view.probe = at.filter(|_| of_reference && !reference.is_stored());
        }
    }

    /// The value under the mouse. `shown`: the state of the selected mode's picture.
    pub(in crate::app) fn pixel_under_mouse<'a>(
        &'a self,
        shown: Option<&'a FrameState>,
    ) -> Option<PixelUnderMouse<'a>> {
        let (pixel, is_of_reference) = self.pixel.filter(|_| self.pointer.is_some())?;
        let reference = self.reference.as_ref().filter(|_| is_of_reference).map(|reference| &*reference.frame.state);
        let state = reference.or_else(|| self.pointed_at(shown))?;
        let number = self.pointed_number(shown).filter(|_| !is_of_reference);
        let number = number.filter(|pointed| (pointed.at[0], pointed.at[1]) == pixel.at);
        let exact = number.and_then(|pointed| self.between.number.value(&pointed));
        Some(PixelUnderMouse { pixel, is_of_reference, state, exact })
    }

    /// The pixel under the mouse, if its value can be read in 32 bits.
    pub(in crate::app) fn pointed_number(&self, shown: Option<&FrameState>) -> Option<Pointed> {
        let of_cell = self.cells.probed().and_then(|cell| cell.view.probe);
        let at = of_cell.or(self.view.probe).filter(|_| self.pointer.is_some())?;
        Pointed::new(self.pointed_at(shown)?, at)
    }

    /// The state of the picture under the mouse: that of a cell of the grid, or of the selected mode.
    fn pointed_at<'a>(&'a self, shown: Option<&'a FrameState>) -> Option<&'a FrameState> {
        let cell = self.cells.probed();
        let of_cell = cell.and_then(|cell| cell.shown.as_ref()).map(|shown| &*shown.frame.state);
        of_cell.or(shown)
    }

    /// The picture under the mouse, and the view that draws it.
    pub(in crate::app) fn pointed_view<'a>(
        &'a self,
        shown: Option<&'a FrameState>,
    ) -> Option<(&'a FrameState, &'a View)> {
        let cell = self.cells.probed();
        Some((self.pointed_at(shown)?, cell.map_or(&self.view, |cell| &cell.view)))
    }

    /// Whether the value under the mouse does not belong to the current picture yet.
    pub(super) fn awaits_pixel(&self) -> bool {
        let of = |view: &View, is_reference| view.probe.map(|at| (at, view.picture(), is_reference));
        let of_reference = self.reference.as_ref().and_then(|reference| of(&reference.view, true));
        let of_cell = self.cells.probed().and_then(|cell| of(&cell.view, false));
        let current = of_reference.or(of_cell).or_else(|| of(&self.view, false));
        current.is_some() && self.pixel.map(|(pixel, of)| (pixel.at, pixel.picture, of)) != current
    }
}
