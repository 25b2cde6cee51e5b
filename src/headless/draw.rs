//! Draws the frames of a sequence and reads the last one back.

use std::sync::Arc;

use super::{Headless, HeadlessError, NotFinitePictures};
use crate::frame::Limits;
use crate::gpu::{Encoder, GpuError, Image};
use crate::render::{BoundFrame, Capture, ProvideError, Readback, Redraw, View};
use crate::shader::{Diagnostic, Severity};

/// Progress of rendering or of a readout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Frames, paths or modes that are drawn.
    pub done: u64,
    /// The total.
    pub of: u64,
    /// Unit of the count, as shown to the user.
    pub unit: &'static str,
}

impl Headless {
    /// Sets whether [`Headless::render`] frees all that its picture does not need, before and after it is drawn, since no other picture
    /// follows. A picture that follows all the same is only slower.
    pub fn set_last_picture(&mut self, is_last: bool) {
        self.is_last_picture = is_last;
    }

    /// Paths per pixel that [`Headless::render`] traces; `None` if the mode does not accumulate.
    ///
    /// # Errors
    /// As [`Headless::frame_state`].
    pub fn paths_per_pixel(&self) -> Result<Option<u64>, HeadlessError> {
        let request = self.frame_state()?.pipelines.clone();
        let paths = u64::from(request.paths_per_frame()) * u64::from(self.session.settings.view.frames);
        Ok(request.accumulates.then_some(paths))
    }

    /// Renders the frames of the sequence from the beginning, and reads the last one back. In an accumulating mode that is the
    /// average of `view.frames` frames.
    ///
    /// # Errors
    /// Settings that do not fit, a bad file, a device error.
    pub fn render(&mut self) -> Result<Capture, HeadlessError> {
        self.render_with(|_| ())
    }

    /// [`Headless::render`], with a report to `progress` after each frame.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn render_with(&mut self, mut progress: impl FnMut(&Step)) -> Result<Capture, HeadlessError> {
        self.offscreen.view.restart_passes();
        self.offscreen.view.forget_limits();
        let frames = self.sequence.frames.max(1);
        let last = frames - 1;
        for index in 0..last {
            self.clock = self.sequence.clock(index);
            let frame = self.bind()?;
            self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))?;
            progress(&Step { done: u64::from(index) + 1, of: u64::from(frames), unit: "frames" });
        }
        self.clock = self.sequence.clock(last);
        self.offscreen.view.restart_mean();
        let mut frame = self.bind()?;
        if self.is_last_picture {
            self.resources.free_unread(&mut frame);
        }
        if frame.state.pipelines.accumulates {
            let (samples, paths) = (self.session.settings.view.frames, frame.state.pipelines.paths_per_frame());
            let [of, paths] = [u64::from(samples) * u64::from(paths), u64::from(paths)];
            for sample in 1..samples {
                self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))?;
                progress(&Step { done: u64::from(sample) * paths, of, unit: "paths per pixel" });
            }
        }
        if self.is_last_picture { self.read_last_frame(&frame) } else { self.read_frame(&frame) }
    }

    /// Renders the first frame with its model in parts of so many rows, each submitted alone, as a window does between frames. In an
    /// accumulating mode that is the average of `view.frames` frames.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn render_in_parts(&mut self, rows: u32) -> Result<Capture, HeadlessError> {
        self.offscreen.view.restart_passes();
        self.offscreen.view.forget_limits();
        self.offscreen.view.restart_mean();
        self.clock = self.sequence.clock(0);
        let frame = self.bind()?;
        let frames = if frame.state.pipelines.accumulates { self.session.settings.view.frames } else { 1 };
        let mut readback = None;
        for _ in 0..frames {
            while self.offscreen.draw_part(&frame, rows)? {}
            readback = self.draw_frame(&frame, Redraw::IfChanged, View::read_back)?;
        }
        let readback = readback.ok_or_else(|| HeadlessError::Settings("nothing was drawn".into()))?;
        Ok(readback.finish())
    }

    /// Draws a frame and reads it back. With an automatic range, it is tone mapped again once its values are known.
    fn read_frame(&mut self, frame: &BoundFrame) -> Result<Capture, HeadlessError> {
        let mut readback = self.draw_frame(frame, Redraw::Always, View::read_back)?;
        if frame.state.display.is_measured() {
            readback = self.draw_frame(frame, Redraw::ToneMap, View::read_back)?;
        }
        self.capture_of(readback)
    }

    /// [`Self::read_frame`] with as little memory as possible: on a software device, what frames need is most of it.
    fn read_last_frame(&mut self, frame: &BoundFrame) -> Result<Capture, HeadlessError> {
        self.draw_frame(frame, Redraw::Always, |_, _, _| Ok(()))?;
        if frame.state.display.is_measured() {
            self.draw_frame(frame, Redraw::ToneMap, |_, _, _| Ok(()))?;
        }
        let readback = self.offscreen.read_back_last()?;
        self.capture_of(readback)
    }

    fn capture_of(&mut self, readback: Option<Readback>) -> Result<Capture, HeadlessError> {
        let readback = readback.ok_or_else(|| HeadlessError::Settings("nothing was drawn".into()))?;
        let capture = readback.finish();
        self.not_finite.add(&capture, &self.session.settings.mode);
        Ok(capture)
    }

    /// The pixels with NaN or infinity in the pictures that were read back since the last call.
    pub fn take_not_finite(&mut self) -> NotFinitePictures {
        std::mem::take(&mut self.not_finite)
    }

    /// Warnings about loops that were cut short since the last call, though they end.
    pub fn take_cut_short(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.cut_short)
    }

    /// The limits of the values in the last frame, if its range is automatic.
    pub fn measured_limits(&self) -> Option<Limits> {
        self.offscreen.view.measured_limits()
    }

    /// Renders the frame after the last one, with the images that passes have kept, and reads it back.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn render_next(&mut self) -> Result<Capture, HeadlessError> {
        self.clock = self.sequence.clock(self.clock.frame_index + 1);
        let frame = self.bind()?;
        self.read_frame(&frame)
    }

    /// [`Headless::render_next`] without reading the frame back.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn draw_next(&mut self) -> Result<(), HeadlessError> {
        self.clock = self.sequence.clock(self.clock.frame_index + 1);
        self.draw()
    }

    /// Renders one frame and waits for it without reading it back: the same work as a frame in a window.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn draw(&mut self) -> Result<(), HeadlessError> {
        let frame = self.bind()?;
        self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))
    }

    /// [`Headless::draw`] of the first picture that a window shows after an edit: in the light that was baked before it.
    ///
    /// # Errors
    /// Settings that do not fit, a device error, or a resource that no edit replaces is missing.
    pub fn draw_on_screen(&mut self) -> Result<(), HeadlessError> {
        let state = self.frame_state()?;
        let (frame, _) = self.resources.bind(&state, false)?;
        self.draw_frame(&frame.ok_or(ProvideError::Stale)?, Redraw::Always, |_, _, _| Ok(()))
    }

    /// Draws a frame to the output image, records `more`, and waits for both.
    pub(super) fn draw_frame<T>(
        &mut self,
        frame: &BoundFrame,
        redraw: Redraw,
        more: impl FnOnce(&View, &mut Encoder, &Arc<Image>) -> Result<T, GpuError>,
    ) -> Result<T, HeadlessError> {
        let mut rest = redraw;
        if let Some(rows) = self.offscreen.rows_at_once(frame, redraw) {
            while self.offscreen.draw_part(frame, rows)? {
                self.tell_endless_loop(self.offscreen.endless_loop())?;
            }
            rest = Redraw::IfChanged;
        }
        let result = self.offscreen.draw(frame, rest, more)?;
        self.tell_endless_loop(self.offscreen.endless_loop())?;
        Ok(result)
    }

    /// Keeps the warning of a loop whose rounds were too many, by the words that the device has written.
    ///
    /// # Errors
    /// It does not end.
    pub(super) fn tell_endless_loop(&mut self, words: Option<[u32; 2]>) -> Result<(), HeadlessError> {
        let Some(words) = words else { return Ok(()) };
        match self.explained(HeadlessError::Gpu(GpuError::EndlessLoop(words))) {
            // A loop that ends, but takes too many rounds, costs only its own pixels.
            HeadlessError::Shaders(found) if found.iter().all(|d| d.severity == Severity::Warning) => {
                self.cut_short = found;
                Ok(())
            }
            error => Err(error),
        }
    }
}
