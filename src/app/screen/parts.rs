//! Draws the whole picture in parts between frames. Each part is a submission of its own, which waits until the device has run the one
//! before. So a frame waits for one of them at most, and an edit or an input for one and its frame.

use std::sync::Arc;

use crate::gpu::{Encoder, Frames, Gpu, GpuError};

/// The time that a part should take on the device, milliseconds.
const AIM_MS: f64 = 60.0;
/// Rows of the first part.
const FIRST: u32 = 32;
/// Fewest rows of a part.
const LEAST: u32 = 4;

/// The submissions of parts, of which the device has one at a time.
pub(super) struct Parts {
    pub(super) frames: Frames,
    /// Rows of the next part.
    pub(super) rows: u32,
    /// Rows of the last part, until its time was taken.
    pub(super) submitted: Option<u32>,
    /// Device time of the parts of this picture so far, milliseconds.
    pub(super) ms: f64,
}

/// The next step of a picture that is drawn in parts.
pub(in crate::app) enum Part {
    /// The device draws one.
    Drawing,
    /// All are drawn: a frame is due.
    Due,
    /// A loop of a stage did not end, or memory is short: the picture has to be drawn as a whole.
    Failed,
}

impl Parts {
    pub(super) fn new(gpu: &Arc<Gpu>) -> Result<Self, GpuError> {
        Ok(Self { frames: Frames::new(gpu, 1)?, rows: FIRST, submitted: None, ms: 0.0 })
    }

    /// Submits something else, once the last part is finished.
    pub(super) fn alone(&mut self, record: impl FnOnce(&mut Encoder) -> Result<(), GpuError>) -> Result<(), GpuError> {
        self.take_time()?;
        let mut encoder = self.frames.begin()?;
        record(&mut encoder)?;
        self.frames.submit(encoder, Default::default())
    }

    /// Whether the device has run the last part.
    pub(super) fn is_finished(&self) -> bool {
        self.frames.is_finished(0)
    }

    /// Takes the time of the last part, which is finished, and decides about the next one.
    pub(super) fn take_time(&mut self) -> Result<(), GpuError> {
        let Some(rows) = self.submitted.take() else { return Ok(()) };
        // SYNC: the part is finished.
        self.frames.wait_all()?;
        let Some(ms) = self.frames.last_device_ms() else { return Ok(()) };
        self.ms += ms;
        self.rows = next_rows(rows, ms);
        Ok(())
    }
}

/// How many rows the next part has, after one with `rows` took so many milliseconds.
fn next_rows(rows: u32, ms: f64) -> u32 {
    let fits = f64::from(rows) * AIM_MS / ms.max(0.01);
    // Rows differ in their content, and the first part does more than draw rows.
    (fits.min(f64::from(rows) * 4.0) as u32).max(rows / 4).max(LEAST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_take_about_as_long_as_they_should() {
        assert_eq!(next_rows(32, 60.0), 32);
        assert_eq!(next_rows(32, 120.0), 16);
        assert_eq!(next_rows(32, 30.0), 64);
        assert_eq!(next_rows(32, 0.0), 128, "the background alone");
        assert_eq!(next_rows(32, 5000.0), 8, "the first part compiles");
        assert_eq!(next_rows(4, 5000.0), 4);
    }
}
