//! The value of the pixel under the mouse.

use super::{FRAMES_IN_FLIGHT, Screen};

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
            self.pixel = self.view.pixel(slot);
        }
    }

    /// Whether the value under the mouse does not belong to the current picture yet.
    pub(super) fn awaits_pixel(&self) -> bool {
        let current = self.view.probe.map(|at| (at, self.view.picture()));
        current.is_some() && self.pixel.map(|pixel| (pixel.at, pixel.picture)) != current
    }
}
