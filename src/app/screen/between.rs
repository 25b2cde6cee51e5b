//! Draws thumbnails and values of pixels between frames.

use std::time::{Duration, Instant};

use super::Screen;
use crate::app::actions::compare::cut_short;
use crate::app::engine::Engine;
use crate::app::frames::progress::awaits_edit;
use crate::app::state::State;
use crate::gpu::GpuError;

/// Polling interval for a submission's end, for which drivers send no event.
const POLL: Duration = Duration::from_millis(2);

/// How long a software device may continue between frames. Showing a thumbnail takes it longer than drawing one.
const UNSEEN: Duration = Duration::from_millis(200);

/// The next step of the window.
pub(in crate::app) enum Next {
    /// Draws a frame.
    Frame,
    /// Waits, then asks again.
    After(Duration),
    /// Waits for an event.
    Event,
}

impl Screen {
    /// Draws more between two frames, once the device has run the last submission, or reports that a frame is due.
    pub(in crate::app) fn go_on(&mut self, state: &mut State, engine: &mut Engine) -> Result<Next, GpuError> {
        let now = Instant::now();
        let left = |due: Option<Instant>| due.map(|due| due.saturating_duration_since(now));
        let is_finished = self.background.is_finished();
        if left(self.due).is_some_and(|left| left.is_zero()) || (is_finished && engine.gpu_is_fast()) {
            return Ok(Next::Frame);
        }
        let mut wait = self.time_to_poll();
        if is_finished && !awaits_edit(state, engine) {
            if left(self.shows_at()).is_some_and(|left| left.is_zero()) {
                return Ok(Next::Frame);
            }
            wait = self.draw_background(state, engine, self.egui.pixels_per_point())?;
        }
        Ok(wait.into_iter().chain(left(self.due)).min().map_or(Next::Event, Next::After))
    }

    /// When a frame is due that shows new results.
    fn shows_at(&self) -> Option<Instant> {
        self.background.is_unseen.then(|| self.last_frame + UNSEEN)
    }

    /// The time until the next poll of the device; `None` if it draws nothing between frames.
    fn time_to_poll(&self) -> Option<Duration> {
        (!self.background.is_finished()).then_some(POLL)
    }

    /// Collects the results of the last submission, if it is finished. Returns whether there are any.
    fn take_background(&mut self, state: &mut State, engine: &mut Engine) -> bool {
        self.take_thumbnail(state);
        self.inspector.take(&self.background, state);
        self.number.take(&self.background);
        let is_new = self.background.is_finished() && std::mem::take(&mut self.background.is_unread);
        if is_new && self.background.frames.endless_loop(0).is_some() {
            self.end_background(state, engine);
        }
        is_new
    }

    /// Collects the results for the frame that begins.
    pub(super) fn show_background(&mut self, state: &mut State, engine: &mut Engine) {
        self.take_background(state, engine);
        self.background.is_unseen = false;
    }

    /// Draws thumbnails and values of pixels that are out of date. Returns the time until they or results that no frame has shown need the
    /// next frame, or `None`. A lack of memory drops them.
    ///
    /// # Errors
    /// A device error other than out of memory.
    pub(super) fn draw_background(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        pixels_per_point: f32,
    ) -> Result<Option<Duration>, GpuError> {
        if !self.background.is_finished() {
            return Ok(Some(POLL));
        }
        self.background.is_unseen |= self.take_background(state, engine);
        let recorded = self.record_background(state, engine, pixels_per_point);
        let submitted = recorded.and_then(|waits| self.background.submit().map(|()| waits));
        let waits = self.survive(submitted)?;
        if waits.is_none() {
            self.background.encoder = None;
            (self.thumbnails, self.thumbnail, self.lacks_thumbnails) = (None, None, true);
            self.gallery.forget();
            self.inspector.forget();
            self.number.stop();
            // The newest picture matters more.
            self.shortage = None;
        }
        // The frame that follows shows the results.
        let wait = self.time_to_poll().or_else(|| waits.into_iter().flatten().flatten().min());
        let shows = self.shows_at().map(|at| at.saturating_duration_since(Instant::now()));
        Ok(wait.into_iter().chain(shows).min())
    }

    fn record_background(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        pixels_per_point: f32,
    ) -> Result<[Option<Duration>; 3], GpuError> {
        let recorded = self.record_thumbnail(state, engine);
        if self.survive(recorded)?.is_none() {
            (self.thumbnails, self.thumbnail, self.shortage) = (None, None, None);
            self.lacks_thumbnails = true;
        }
        let context = (&self.layouts, pixels_per_point);
        let thumbnails = self.gallery.draw(&mut self.background, (&mut *state, &mut *engine), &mut self.ui, context)?;
        let of_pixel = (self.rect.size, self.mouse.over.then(|| self.mouse_pixel()).flatten());
        let values = self.inspector.draw(&mut self.background, state, engine, &self.layouts, of_pixel)?;
        let pointed = self.pointed_number(state);
        let number = self.number.draw(&mut self.background, state, engine, &self.layouts, pointed)?;
        Ok([thumbnails, values, number])
    }

    /// Draws nothing between frames until something changes.
    pub(super) fn end_background(&mut self, state: &mut State, engine: &mut Engine) {
        self.gallery.stop();
        self.inspector.stop();
        self.number.stop();
        if let Some(number) = self.thumbnail.take().map(|pending| pending.number) {
            cut_short(state, engine, number);
        }
    }
}
