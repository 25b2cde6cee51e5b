//! The value of the pixel under the mouse.

use super::number::Pointed;
use super::{FRAMES_IN_FLIGHT, Screen};
use crate::app::panels::overlay::swatches::swatches;
use crate::app::readings::{LegendOf, Readout};
use crate::app::screen::readout::readout;
use crate::app::state::State;
use crate::frame::FrameState;
use crate::render::View;

impl Screen {
    /// The pixel of the picture under the mouse.
    pub(in crate::app) fn mouse_pixel(&self) -> Option<(u32, u32)> {
        let (x, y) = (self.mouse.at.x - self.rect.at.0 as f32, self.mouse.at.y - self.rect.at.1 as f32);
        let (width, height) = self.last.as_ref()?.state.size;
        (x >= 0.0 && y >= 0.0).then_some((x as u32, y as u32)).filter(|(x, y)| *x < width && *y < height)
    }

    /// Reads the probed pixel of the newest finished frame.
    pub(super) fn read_pixel(&mut self) {
        let newest_first =
            (0..FRAMES_IN_FLIGHT).map(|age| (self.frames.current() + FRAMES_IN_FLIGHT - age) % FRAMES_IN_FLIGHT);
        let finished = newest_first.into_iter().find(|slot| self.frames.is_finished(*slot));
        if let Some(slot) = finished {
            let cell = self.cells.iter().find(|cell| cell.view.probe.is_some());
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
            self.cells.iter_mut().for_each(|cell| cell.view.take_range_sample(slot));
            if let Some(reference) = &mut self.reference {
                reference.view.take_range_sample(slot);
            }
        }
    }

    /// Requests the value under the mouse, from the picture or from the reference, whichever is shown there.
    pub(super) fn place_probe(&mut self) {
        let at = self.mouse.over.then(|| self.mouse_pixel()).flatten();
        let cell = if self.mouse.over { self.mouse_cell() } else { None };
        for (index, other) in self.cells.iter_mut().enumerate() {
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

    /// The value under the mouse.
    pub(super) fn readout(&self, state: &State) -> Option<Readout> {
        let (pixel, is_of_reference) = self.pixel.filter(|_| self.mouse.over)?;
        let reference = self.reference.as_ref().filter(|_| is_of_reference).map(|reference| &*reference.frame.state);
        let frame_state = reference.or_else(|| self.pointed_at(state))?;
        let number = self.pointed_number(state).filter(|_| !is_of_reference);
        let number = number.filter(|pointed| (pointed.at[0], pointed.at[1]) == pixel.at);
        let sides = self.reference.as_ref().and_then(|_| state.side_names());
        let side = sides.map(|[earlier, now]| if is_of_reference { earlier } else { now });
        let readout = readout(frame_state, &pixel, number.and_then(|pointed| self.number.value(&pointed)))?;
        Some(Readout { side, ..readout })
    }

    /// The pixel under the mouse, if its value can be read in 32 bits.
    pub(super) fn pointed_number(&self, state: &State) -> Option<Pointed> {
        let of_cell = self.cells.iter().find_map(|cell| cell.view.probe);
        let at = of_cell.or(self.view.probe).filter(|_| self.mouse.over)?;
        Pointed::new(self.pointed_at(state)?, at)
    }

    /// The state of the picture under the mouse: that of a cell of the grid, or of the selected mode.
    fn pointed_at<'a>(&'a self, state: &'a State) -> Option<&'a FrameState> {
        let cell = self.cells.iter().find(|cell| cell.view.probe.is_some());
        let of_cell = cell.and_then(|cell| cell.shown.as_ref()).map(|shown| &*shown.frame.state);
        of_cell.or_else(|| state.shown())
    }

    /// Returns the contents of the legend for the picture under the mouse.
    pub(super) fn legend(&self, state: &State) -> Option<LegendOf> {
        let frame_state = self.pointed_at(state)?;
        let view = self.cells.iter().find(|cell| cell.view.probe.is_some()).map_or(&self.view, |cell| &cell.view);
        let mode = frame_state.mode()?.clone();
        let scene = state.session.scene();
        Some(LegendOf {
            swatches: swatches(&mode, scene.as_ref(), &frame_state.shaders),
            mode,
            limits: view.limits(),
            range_sample: view.range_sample().cloned(),
            colormap: frame_state.display.colormap(),
            exposure: frame_state.exposure(),
        })
    }

    /// Whether the value under the mouse does not belong to the current picture yet.
    pub(super) fn awaits_pixel(&self) -> bool {
        let of = |view: &View, is_reference| view.probe.map(|at| (at, view.picture(), is_reference));
        let of_reference = self.reference.as_ref().and_then(|reference| of(&reference.view, true));
        let of_cell = self.cells.iter().find_map(|cell| of(&cell.view, false));
        let current = of_reference.or(of_cell).or_else(|| of(&self.view, false));
        current.is_some() && self.pixel.map(|(pixel, of)| (pixel.at, pixel.picture, of)) != current
    }
}
