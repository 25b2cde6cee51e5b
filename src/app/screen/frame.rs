//! A frame on the device: its slot and its image, its commands, and their submission.

use super::Screen;
use super::between_request::{BetweenRequest, Collected, Drawn};
use super::loops::Ended;
use super::outline::draw_outline;
use super::request::{FrameRequest, Recorded};
use super::target::{NextTarget, TargetImage};
use super::window_copy::WindowCopy;
use crate::app::state::adaptive::plan::Plan;
use crate::cpu_clock::CpuClock;
use crate::gpu::{Encoder, GpuError, Use};
use crate::render::{BoundFrame, Output, Resources, View};

/// A frame that is being recorded. Its slot was free, and there is an image for it.
pub(in crate::app) struct Begun {
    encoder: Encoder,
    target: TargetImage,
}

/// The beginning of a frame.
pub(in crate::app) enum Beginning {
    Begun(Begun),
    /// The swapchain must be created anew.
    Outdated,
    /// The screen has released no image.
    Hidden,
}

impl Screen {
    /// Begins a frame. SYNC: waits for a frame slot.
    pub(in crate::app) fn begin(&mut self) -> Result<Beginning, GpuError> {
        let encoder = self.frames.begin()?;
        self.check_loops();
        let beginning = match self.target.acquire()? {
            NextTarget::Image(target) => return Ok(Beginning::Begun(Begun { encoder, target })),
            NextTarget::Outdated => Beginning::Outdated,
            NextTarget::Hidden => Beginning::Hidden,
        };
        self.frames.submit(encoder, Default::default())?;
        Ok(beginning)
    }

    /// Records a frame. An out-of-memory error in the outline, the texture or the grid drops that part; any other error ends the frame.
    pub(in crate::app) fn record(
        &mut self,
        begun: &mut Begun,
        request: &FrameRequest<'_>,
    ) -> Result<Recorded, GpuError> {
        let Begun { encoder, target } = begun;
        let (slot, image) = (self.frames.current(), &target.image);
        let output = Output { image, before: target.before, at: self.rect.at };
        let (view, outline) = (&mut self.view, request.outline.as_ref());
        let outlined = match request.frame {
            Some(_) if request.plan == Plan::Preview => self.draw_preview(encoder, slot, outline, &output)?,
            Some(frame) => {
                view.draw(encoder, slot, frame, &output, request.redraw)?;
                self.draw_reference(encoder, slot, image, self.rect.at)?;
                let drawn = (frame, &self.view);
                draw_outline(encoder, &mut self.outline, drawn, outline, (image, self.rect.at), 1.0)
            }
            None => {
                View::clear(encoder, &output);
                Ok(())
            }
        };
        self.survive(outlined)?;
        let texture = request.texture.as_ref().map(|draw| self.texture.draw(encoder, draw, request.frame));
        let redraws = self.survive(texture.unwrap_or(Ok(false)))?;
        // Without memory for its image, the picture waits for the next attempt.
        self.redraws |= redraws == Some(true) && self.shortage.is_none();
        let cells = self.cells.draw(encoder, slot, image);
        let grid_failed = self.survive(cells)?.is_none();
        if grid_failed {
            self.cells.0.clear();
        }
        let (pixels_per_point, primitives) = (request.pixels_per_point, request.primitives);
        encoder.pass("ui", |encoder| self.draw_ui(encoder, image, pixels_per_point, primitives))?;
        let copy = request.copies_window.then(|| WindowCopy::record(&self.gpu, encoder, slot, image));
        if target.is_presented() {
            encoder.transition(image, Use::Color, Use::Present);
        }
        let (copy, copy_error) = copy.map_or((None, None), |copy| match copy {
            Ok(copy) => (Some(copy), None),
            Err(error) => (None, Some(error)),
        });
        self.window_copy = self.window_copy.take().or(copy);
        Ok(Recorded { grid_failed, copy_error })
    }

    /// Submits a recorded frame and presents it. `attempt`: the number under which it was recorded for a loss of the device. Returns the
    /// CPU time of presenting it, milliseconds: a software device copies the pixels then, which is no work of the window's.
    pub(in crate::app) fn submit(
        &mut self,
        begun: Begun,
        frame: Option<&BoundFrame>,
        attempt: Option<u64>,
    ) -> Result<f64, GpuError> {
        let Begun { encoder, target } = begun;
        let slot = self.frames.current();
        self.frames.submit(encoder, target.submission())?;
        let has_others = self.reference.is_some() || !self.cells.0.is_empty();
        self.loops.add(slot, frame.map(|frame| frame.state.clone()), attempt, has_others);
        let clock = CpuClock::start();
        self.target.present(&target)?;
        Ok(clock.map_or(0.0, CpuClock::ms))
    }

    /// Device time of the last frame, milliseconds, unless it has drawn another picture beside the newest one. SYNC: waits for all frames.
    pub(in crate::app) fn finish(&mut self) -> Result<Option<f64>, GpuError> {
        self.frames.wait_all()?;
        Ok(self.frames.last_device_ms().filter(|_| self.reference.is_none() && self.cells.0.is_empty()))
    }

    /// Whether another frame must follow at once: for the swapchain, for loops, for something that could not be drawn yet, for a picture
    /// that improves or is animated, or for a result in flight.
    /// Whether the picture improves is the caller's to decide if it is drawn in parts (`plan`), and a preview awaits nothing of it. A picture
    /// that nobody sees improves where it is written.
    pub(in crate::app) fn has_more(&mut self, frame: Option<&BoundFrame>, plan: Plan) -> bool {
        let frame = frame.filter(|_| plan != Plan::Preview);
        // Both change with every frame.
        let (redraws, awaits_loops) = (std::mem::take(&mut self.redraws), self.loops.awaits(&self.frames));
        let moving = self.reference.as_ref().filter(|reference| !reference.is_still());
        let reference = moving.map(|reference| (&reference.view, &reference.frame));
        let cells = self.cells.0.iter().filter_map(|cell| Some((&cell.view, &cell.shown.as_ref()?.frame)));
        let mut views = frame.map(|frame| (&self.view, frame)).into_iter().chain(reference).chain(cells);
        let improves_by_itself = plan == Plan::Whole && self.target.is_window();
        let is_unfinished = |(view, frame): (&View, &BoundFrame)| {
            let gets_better = improves_by_itself && view.improves(frame);
            gets_better || view.is_moving(frame) || view.awaits_range_sample()
        };
        redraws
            || awaits_loops
            || self.target.is_outdated()
            || (plan != Plan::Preview && self.awaits_pixel())
            || self.window_copy.is_some()
            || self.error_map.awaits_copies()
            || views.any(is_unfinished)
    }

    /// Checks the loops of the finished frames. `begin` has waited for the oldest.
    pub(super) fn check_loops(&mut self) {
        if self.loops.check(&self.frames) {
            self.end_between();
            self.cells.0.clear();
            self.view.forget();
            self.redraws = true;
        }
    }

    /// The results of loops since the last call.
    pub(in crate::app) fn take_ended(&mut self) -> Vec<Ended> {
        self.loops.take()
    }

    /// Collects the results of what was drawn between frames.
    pub(in crate::app) fn collect_between(&mut self) -> Collected {
        let collected = self.between.collect();
        if collected.is_endless {
            self.end_between();
        }
        collected
    }

    /// Draws what is out of date between frames, once the last submission is finished.
    ///
    /// # Errors
    /// A device error other than out of memory.
    pub(in crate::app) fn draw_between(
        &mut self,
        request: &BetweenRequest<'_>,
        resources: &mut Resources,
    ) -> Result<Drawn, GpuError> {
        self.between.draw(request, resources, &mut self.ui)
    }

    /// Draws nothing between frames until something changes.
    fn end_between(&mut self) {
        if let Some(version) = self.between.end() {
            self.loops.thumbnail_is_endless(version);
        }
    }
}
