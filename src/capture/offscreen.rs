//! Draws pictures of a window's session on another thread. It shares the window's resources, and has a view and targets of its own, so
//! that the window's picture stays as it is.
//!
//! `Resources` is `Clone`: a clone shares all that is on the device and then goes its own way. The thread has a view
//! and targets of its own, so the frame, accumulation buffer and history of the window stay as they are. A capture is
//! drawn in one piece, so its size is limited by the memory of the device.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::label::Labels;
use super::{Animation, CaptureError, Renderer, Tell, image_of, tell};
use crate::frame::{Clock, FrameState, Limits, TargetFormat};
use crate::gpu::{Gpu, GpuError, Image};
use crate::headless::{HeadlessError, OffscreenView, Search, first_not_finite};
use crate::pipeline::PipelineSet;
use crate::render::{BoundFrame, Capture, Redraw, Resources, Texel, View, read_texels, texel_places};
use crate::session::Session;
use crate::settings::Settings;
use crate::shader::not_finite::NotFinite;
use crate::shader::{Compiler, Mode, PixelValue, Source};

/// Draws pictures of a session.
pub struct OffscreenCapture {
    gpu: Arc<Gpu>,
    session: Session,
    resources: Resources,
    own: OffscreenView,
    clock: Clock,
    /// Frames that are drawn for each capture, for passes that depend on earlier frames.
    count: u32,
    /// Whether captures are for files of linear light, whose pixels are plain averages of the samples.
    is_linear: bool,
    /// Whether captures have raw values.
    has_raw: bool,
    /// Whether to end before the next frame.
    canceled: Arc<AtomicBool>,
}

/// A version of the shaders to capture.
pub(crate) struct VersionPicture {
    pub(crate) set: Arc<PipelineSet>,
    /// Label that is drawn into the picture.
    pub(crate) label: String,
    /// A frame drawn with the version, if there was one: it holds the light that the version's shaders baked.
    pub(crate) like: Option<BoundFrame>,
}

impl OffscreenCapture {
    /// Largest number of frames of a capture.
    const MOST_FRAMES: u32 = 10_000;

    /// Copies of what the window draws with. `clock` is the time of all captures. `canceled` ends them before the next frame.
    ///
    /// # Errors
    /// No memory left.
    pub fn new(
        gpu: &Arc<Gpu>,
        session: Session,
        resources: Resources,
        clock: Clock,
        canceled: &Arc<AtomicBool>,
    ) -> Result<Self, GpuError> {
        Self::with_view(None, gpu, session, resources, (clock, canceled))
    }

    /// [`Self::new`] with the view of an earlier capture, whose targets may fit.
    pub(crate) fn with_view(
        view: Option<OffscreenView>,
        gpu: &Arc<Gpu>,
        session: Session,
        resources: Resources,
        (clock, canceled): (Clock, &Arc<AtomicBool>),
    ) -> Result<Self, GpuError> {
        let own = view.map_or_else(|| OffscreenView::new(gpu, resources.layouts()), Ok)?;
        let (gpu, canceled) = (gpu.clone(), canceled.clone());
        Ok(Self { gpu, session, resources, own, clock, count: 1, is_linear: false, has_raw: true, canceled })
    }

    /// The view, for the next capture.
    pub(crate) fn into_view(self) -> OffscreenView {
        self.own
    }

    /// Sets the number of frames that each capture takes.
    ///
    /// # Errors
    /// More frames than a capture may have.
    pub fn set_count(&mut self, count: u32) -> Result<(), CaptureError> {
        if !(1..=Self::MOST_FRAMES).contains(&count) {
            return Err(CaptureError::Usage(format!("`frames` is {count}; it can be 1 to {}", Self::MOST_FRAMES)));
        }
        self.count = count;
        Ok(())
    }

    /// Sets whether captures are for files of linear light (EXR).
    pub fn set_linear(&mut self, is_linear: bool) {
        self.is_linear = is_linear;
    }

    /// Captures the display colors alone.
    ///
    /// # Errors
    /// As [`Renderer::capture`].
    pub(crate) fn capture_display(&mut self, size: (u32, u32)) -> Result<Capture, HeadlessError> {
        self.has_raw = false;
        let capture = self.capture(size);
        self.has_raw = true;
        capture
    }

    /// The value of a pixel in each of `modes`, with one sample per pixel. `size` is that of the frame.
    ///
    /// # Errors
    /// As [`Renderer::capture`].
    pub fn pixel(
        &mut self,
        size: (u32, u32),
        at: (u32, u32),
        modes: &[Mode],
        progress: Tell<'_>,
    ) -> Result<Vec<PixelValue>, CaptureError> {
        let mut values = Vec::new();
        self.session.settings.view.msaa = 1;
        self.own.view.probe = Some(at);
        for (index, mode) in modes.iter().enumerate() {
            tell(progress, index, modes.len())?;
            self.session.settings.mode.clone_from(&mode.slug);
            let frame = self.bind_as(size, |state| Arc::new(Arc::unwrap_or_clone(state).with_numbers()))?;
            self.own.view.restart_passes();
            self.own.view.restart_mean();
            let count = if frame.state.pipelines.accumulates { self.session.settings.view.frames } else { 1 };
            for _ in 0..count {
                self.draw(&frame, Redraw::Pixel(at.0, at.1), |_, _, _| Ok(()))?;
            }
            values.push(self.own.view.pixel(self.own.frames.current()).map(|pixel| pixel.value).unwrap_or_default());
        }
        self.own.view.probe = None;
        Ok(values)
    }

    /// The texels that the pixel `at` of a picture reads, of each texture of its material.
    ///
    /// # Errors
    /// As [`Renderer::capture`].
    pub fn texels(&mut self, size: (u32, u32), at: (u32, u32)) -> Result<Vec<Texel>, HeadlessError> {
        let places = texel_places(&self.bind(size)?.state, at);
        Ok(read_texels(&self.gpu, &self.resources, &mut self.own.frames, places)?)
    }

    /// The first statement that computes NaN or infinity at the pixel `at`, if one of the values in these modes is not finite.
    pub(crate) fn not_finite(
        &mut self,
        (size, at): ((u32, u32), (u32, u32)),
        values: &[(&Mode, PixelValue)],
        (compiler, source): (&Compiler, &Source),
    ) -> Option<NotFinite> {
        let mode = NotFinite::mode_of(values.iter().map(|(mode, value)| (*mode, value)))?;
        let scene = self.session.scene();
        let shaders = self.session.shaders.clone()?;
        let target = TargetFormat::full(1);
        let canceled = self.canceled.clone();
        let search = Search {
            picture: self.session.inputs(&shaders, scene.as_ref(), self.clock, size, target),
            at,
            mode,
            source,
            is_canceled: &|| canceled.load(Ordering::Relaxed),
        };
        let found = first_not_finite(&self.gpu, compiler, (&mut self.resources, &mut self.own.frames), &search);
        Some(NotFinite { mode: mode.slug.clone(), found })
    }

    /// Writes a picture of each version as an animation.
    ///
    /// # Errors
    /// No versions, a picture that cannot be drawn, a file that cannot be written.
    pub(crate) fn timeline(
        &mut self,
        versions: &[VersionPicture],
        size: (u32, u32),
        mut animation: Animation,
        progress: Tell<'_>,
    ) -> Result<(), CaptureError> {
        self.check_size(size)?;
        let labels = Labels::new().map_err(CaptureError::Write)?;
        for (index, version) in versions.iter().enumerate() {
            tell(progress, index, versions.len())?;
            let target = self.target()?;
            let state = self.session.frame_state_of(&version.set.shaders, self.clock, size, target);
            version.set.build_aside(&state.pipelines).map_err(HeadlessError::from)?;
            let bound = self.resources.bind_older(&version.set, &state, version.like.as_ref());
            // Its light is gone if another environment was chosen since.
            let Some(frame) = bound.map_err(HeadlessError::from)? else { continue };
            let mut picture = image_of(self.picture(&frame)?)?;
            let (x, y, width) = (12, size.1.saturating_sub(30), size.0 as f32 - 24.0);
            // Legible on any background: a light text over a dark one.
            for (at, color) in [((x + 1, y + 1), [0; 3]), ((x, y), [235; 3])] {
                labels.write(&mut picture, at, (18.0, width), color, &version.label);
            }
            animation.add(picture)?;
        }
        tell(progress, versions.len(), versions.len())?;
        animation.finish()
    }

    fn check_size(&self, (width, height): (u32, u32)) -> Result<(), HeadlessError> {
        let most = self.gpu.max_image_size();
        if (1..=most).contains(&width) && (1..=most).contains(&height) {
            return Ok(());
        }
        Err(HeadlessError::Settings(format!(
            "a picture of {width}x{height}: this device draws 1 to {most} pixels a side"
        )))
    }

    /// Full floats, so that what is read back is what the shaders wrote.
    fn target(&self) -> Result<TargetFormat, HeadlessError> {
        let format = View::target_format(&self.gpu, self.session.settings.view.msaa, true);
        format.map(|format| TargetFormat { weighs: !self.is_linear, ..format }).map_err(HeadlessError::Settings)
    }

    fn bind(&mut self, size: (u32, u32)) -> Result<BoundFrame, HeadlessError> {
        self.bind_as(size, |state| state)
    }

    /// Binds the state of the session after `adapt` has changed it.
    fn bind_as(
        &mut self,
        size: (u32, u32),
        adapt: impl FnOnce(Arc<FrameState>) -> Arc<FrameState>,
    ) -> Result<BoundFrame, HeadlessError> {
        self.check_size(size)?;
        let target = self.target()?;
        let state = self.session.frame_state(self.clock, size, target);
        let state = adapt(state.ok_or_else(|| HeadlessError::Shaders(Vec::new()))?);
        if state.pipelines.needs_pending(&state.shaders) {
            let mode = &self.session.settings.mode;
            return Err(HeadlessError::Settings(format!("the shaders of the mode `{mode}` have errors")));
        }
        if let Some(set) = self.resources.pipelines() {
            // Built without counting as a request, so that the window's pipelines stay.
            set.build_aside(&state.pipelines)?;
        }
        Ok(self.resources.provide(&state)?)
    }

    /// Draws as many frames as the settings ask for, and reads the last one back.
    fn picture(&mut self, frame: &BoundFrame) -> Result<Capture, HeadlessError> {
        self.own.view.restart_passes();
        self.own.view.restart_mean();
        self.own.view.forget_limits();
        let accumulates = frame.state.pipelines.accumulates;
        let count = if accumulates { self.session.settings.view.frames } else { self.count };
        for _ in 1..count {
            self.draw(frame, Redraw::Always, |_, _, _| Ok(()))?;
        }
        let mut readback = self.draw(frame, Redraw::Always, View::read_back)?;
        if frame.state.display.is_measured() {
            // An automatic range uses the values that have just been drawn.
            readback = self.draw(frame, Redraw::ToneMap, View::read_back)?;
        }
        let readback = readback.ok_or_else(|| HeadlessError::Settings("nothing was drawn".into()))?;
        Ok(if self.has_raw { readback.finish() } else { readback.finish_picture() })
    }

    fn draw<T>(
        &mut self,
        frame: &BoundFrame,
        redraw: Redraw,
        more: impl FnOnce(&View, &mut crate::gpu::Encoder, &Arc<Image>) -> Result<T, GpuError>,
    ) -> Result<T, HeadlessError> {
        let go_on = || if self.canceled.load(Ordering::Relaxed) { Err(HeadlessError::Canceled) } else { Ok(()) };
        let mut rest = redraw;
        if let Some(rows) = self.own.rows_at_once(frame, redraw) {
            loop {
                go_on()?;
                if !self.own.draw_part(frame, rows)? {
                    break;
                }
            }
            rest = Redraw::IfChanged;
        }
        go_on()?;
        let result = self.own.draw(frame, rest, more)?;
        match self.own.endless_loop() {
            Some(words) => Err(HeadlessError::Gpu(GpuError::EndlessLoop(words))),
            None => Ok(result),
        }
    }
}

impl Renderer for OffscreenCapture {
    fn settings(&mut self) -> &mut Settings {
        &mut self.session.settings
    }

    fn session(&self) -> &Session {
        &self.session
    }

    fn capture(&mut self, size: (u32, u32)) -> Result<Capture, HeadlessError> {
        let frame = self.bind(size)?;
        self.picture(&frame)
    }

    fn measured_limits(&self) -> Option<Limits> {
        self.own.view.measured_limits()
    }
}
