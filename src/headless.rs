//! Rendering without a window: the same reload and the same frames as on screen, on one thread.

use std::collections::BTreeSet;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use crate::frame::{Clock, FrameInputs, FrameState, PipelineRequest, Scene, TargetFormat};
use crate::gpu::{Encoder, Frames, Gpu, GpuError, Image, PassTime, SetLayouts, Use, return_freed_memory};
use crate::pipeline::{Outcome, PipelineSet, Reload, Reloader, endless_loop};
use crate::render::{
    BakeError, BakeReport, BoundFrame, Capture, GpuModel, Output, ProvideError, Redraw, Resources, TraceError,
    UploadError, View, wrong_values,
};
use crate::scene::{self, MeasuredError, Model};
use crate::session::Session;
use crate::settings::Settings;
use crate::shader::{Change, Compiler, Diagnostic, Mode, PixelValue, ShaderSet, Source};

/// Why rendering failed.
#[derive(Debug, thiserror::Error)]
pub enum HeadlessError {
    /// The shaders do not compile, and there are no earlier ones; or one of their loops does not end.
    #[error("the shaders are wrong")]
    Shaders(Vec<Diagnostic>),
    /// A setting does not fit the shaders, the model or the device.
    #[error("{0}")]
    Settings(String),
    /// The file of a measured BRDF cannot be read.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The environment cannot be read or baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The model does not fit the device.
    #[error(transparent)]
    Upload(#[from] UploadError),
    /// A device error.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl From<ProvideError> for HeadlessError {
    fn from(error: ProvideError) -> Self {
        match error {
            ProvideError::Bake(error) => error.into(),
            ProvideError::Gpu(error) | ProvideError::Trace(TraceError::Gpu(error)) => error.into(),
            ProvideError::Trace(error) => Self::Settings(error.to_string()),
            ProvideError::Measured(error) => error.into(),
            ProvideError::Stale => Self::Settings(error.to_string()),
        }
    }
}

/// Frames at even distances in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sequence {
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Time of the first, seconds.
    pub start_s: f32,
    /// Frames a second.
    pub fps: f32,
}

impl Default for Sequence {
    fn default() -> Self {
        Self { frames: 1, start_s: 0.0, fps: 60.0 }
    }
}

impl Sequence {
    fn clock(&self, frame_index: u32) -> Clock {
        let delta_s = if frame_index == 0 { 0.0 } else { 1.0 / self.fps };
        Clock { time_s: self.start_s + frame_index as f32 / self.fps, delta_s, frame_index, ..Clock::default() }
    }
}

/// A session, a device and one view.
pub struct Headless {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    session: Session,
    reloader: Reloader,
    resources: Resources,
    frames: Frames,
    view: View,
    /// The image that [`Headless::render`] draws to and reads back.
    output: Option<Arc<Image>>,
    size: (u32, u32),
    clock: Clock,
    sequence: Sequence,
    upload_ms: f64,
}

impl Headless {
    /// Compiles the tree, uploads the model and creates everything that the first frame needs. The HDR target has full floats,
    /// so that readback returns exactly what the shader wrote.
    ///
    /// # Errors
    /// Shaders that do not compile, settings or a model that do not fit, a device error.
    pub fn new(
        gpu: &Arc<Gpu>,
        compiler: &Arc<Compiler>,
        source: Source,
        model: Model,
        settings: Settings,
        size: (u32, u32),
    ) -> Result<(Self, Reload), HeadlessError> {
        let mut this = Self::open(gpu, compiler, source, model, settings, size)?;
        let reload = this.update(Change::All);
        match &reload.outcome {
            Outcome::Ready(_) => {}
            Outcome::Failed(diagnostics) => return Err(HeadlessError::Shaders(diagnostics.clone())),
            Outcome::Unchanged { .. } => return Err(HeadlessError::Shaders(Vec::new())),
        }
        this.check_settings()?;
        this.provide()?;
        Ok((this, reload))
    }

    /// Like [`Headless::new`], but reads the model while the shaders compile, compiles only what the picture needs, and does not
    /// create the resources of a frame. If the reload has failed, [`Headless::update_first`] may be called any number of times
    /// before the first picture.
    ///
    /// # Errors
    /// Those of `read`, settings or a model that do not fit, a device error.
    pub fn start<E: From<HeadlessError>>(
        gpu: &Arc<Gpu>,
        compiler: &Arc<Compiler>,
        source: Source,
        settings: Settings,
        size: (u32, u32),
        read: impl FnOnce() -> Result<Model, E>,
    ) -> Result<(Self, Reload), E> {
        let variant = settings.variant.clone();
        let settings = Settings { variant: String::new(), ..settings };
        let mut this = Self::open(gpu, compiler, source, Model::default(), settings, size)?;
        // Settings may name passes that are off, their modes and their parameters.
        let settings = &this.session.settings;
        let names_passes =
            !settings.passes.is_empty() || !settings.shader.is_empty() || settings.mode.starts_with("pass:");
        let reloader = &mut this.reloader;
        let (compiled, model) = std::thread::scope(|scope| {
            let compiled = scope.spawn(|| reloader.compile_first_picture(names_passes));
            let model = read();
            (compiled.join().unwrap_or_else(|panic| resume_unwind(panic)), model)
        });
        let model = model?;
        model.variant(&variant).map_err(HeadlessError::Settings)?;
        this.session.settings.variant = variant;
        this.set_model(model)?;
        let reload = this.reload(|reloader, request| reloader.build(compiled, request, || false));
        Ok((this, reload))
    }

    /// Like [`Headless::new`], but compiles nothing. Call [`Headless::update`], which may fail any number of times before the
    /// first picture.
    ///
    /// # Errors
    /// Settings or a model that do not fit, a device error.
    pub fn open(
        gpu: &Arc<Gpu>,
        compiler: &Arc<Compiler>,
        source: Source,
        model: Model,
        settings: Settings,
        size: (u32, u32),
    ) -> Result<Self, HeadlessError> {
        let most = gpu.max_image_size();
        if size.0 > most || size.1 > most {
            let message = format!("{}x{} is too large; this device draws at most {most} pixels a side", size.0, size.1);
            return Err(HeadlessError::Settings(message));
        }
        model.variant(&settings.variant).map_err(HeadlessError::Settings)?;
        let layouts = SetLayouts::new(gpu)?;
        let mut this = Self {
            gpu: gpu.clone(),
            session: Session::new(settings),
            reloader: Reloader::new(gpu, &layouts, compiler, source),
            resources: Resources::new(gpu, &layouts, [0.0; 3])?,
            frames: Frames::new(gpu, 1)?,
            view: View::new(gpu, &layouts, 1)?,
            output: None,
            layouts,
            size,
            clock: Clock::default(),
            sequence: Sequence::default(),
            upload_ms: 0.0,
        };
        this.target()?;
        this.set_model(model)?;
        Ok(this)
    }

    /// Creates everything that the next frame lacks: the environment, the measured BRDF and the pipelines. On failure those in
    /// use stay.
    ///
    /// # Errors
    /// A bad file, or a device error.
    pub fn provide(&mut self) -> Result<(), HeadlessError> {
        self.bind()?;
        // Decoding and compiling are done. Return the freed memory, which a software device needs for the frame.
        return_freed_memory();
        Ok(())
    }

    /// Bakes the environment of the settings again. `from_disk` allows a cached result.
    ///
    /// # Errors
    /// As [`Headless::provide`].
    pub fn bake(&mut self, from_disk: bool) -> Result<(), HeadlessError> {
        match self.frame_state()?.environment {
            Some(key) => self.resources.bake(key, from_disk).map_err(|error| self.explained(error.into())),
            None => Ok(()),
        }
    }

    /// Reports that the environment's file has changed. The next frame bakes it again.
    pub fn environment_changed(&mut self) {
        self.session.revisions.environment += 1;
    }

    /// Reports that the file of the measured BRDF has changed. The next frame reads it again.
    pub fn measured_changed(&mut self) {
        self.session.revisions.measured += 1;
    }

    /// Warnings about functions whose values the last bakes could not use.
    pub fn bake_warnings(&self) -> Vec<String> {
        let tables = self.resources.tables().map(|tables| tables.wrong.clone()).unwrap_or_default();
        let mut functions: BTreeSet<&str> = tables.into_iter().collect();
        functions.extend(self.resources.environment().wrong());
        functions.into_iter().map(wrong_values).collect()
    }

    /// How long the last bake took.
    pub fn bake_report(&self) -> &BakeReport {
        &self.resources.environment().report
    }

    /// The settings, the model and the shaders.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The shaders in use; empty before the first good ones.
    pub fn shaders(&self) -> Arc<ShaderSet> {
        self.session.shaders.clone().unwrap_or_default()
    }

    /// The reloader, with the shader tree.
    pub fn reloader(&self) -> &Reloader {
        &self.reloader
    }

    /// The model, without the pixels of its images.
    pub fn model(&self) -> Arc<Model> {
        self.session.model().cloned().unwrap_or_default()
    }

    /// The settings of the next [`Headless::render`].
    pub fn settings_mut(&mut self) -> &mut Settings {
        &mut self.session.settings
    }

    /// Sets the times of the frames that [`Headless::render`] draws.
    pub fn set_sequence(&mut self, sequence: Sequence) {
        self.sequence = sequence;
        self.clock = sequence.clock(sequence.frames.saturating_sub(1));
    }

    /// Duration of the last model upload, milliseconds.
    pub fn upload_ms(&self) -> f64 {
        self.upload_ms
    }

    /// Device time of the last frame in milliseconds, if the device supports timestamps.
    pub fn device_ms(&self) -> Option<f64> {
        self.frames.last_device_ms()
    }

    /// Device time of each pass of the last frame, if the device supports timestamps.
    pub fn pass_times(&self) -> &[PassTime] {
        self.frames.pass_times()
    }

    /// Reloads changed shaders. On failure the last good shaders stay.
    pub fn update(&mut self, change: Change) -> Reload {
        self.reload(|reloader, request| reloader.update(change, request))
    }

    /// Reloads what the next frame needs of the changed shaders. [`Headless::finish`] compiles the rest.
    pub fn update_first(&mut self, change: Change) -> Reload {
        self.reload(|reloader, request| reloader.update_first(change, true, request, || false))
    }

    /// Compiles the stages that [`Headless::update_first`] has left; `None` if there are none.
    pub fn finish(&mut self) -> Option<Reload> {
        let is_pending = self.session.shaders.as_ref().is_some_and(|shaders| !shaders.pending.is_empty());
        is_pending.then(|| self.reload(|reloader, request| reloader.finish(request, || false)))
    }

    fn reload(
        &mut self,
        reload: impl FnOnce(&mut Reloader, &dyn Fn(&Arc<ShaderSet>) -> PipelineRequest) -> Reload,
    ) -> Reload {
        // `open` has checked that the target exists, so the fallback is never used unless the settings change.
        let target = self.target().unwrap_or(TargetFormat::full(1));
        let session = &self.session;
        let reload = reload(&mut self.reloader, &|shaders| session.pipelines(shaders, target));
        match &reload.outcome {
            Outcome::Ready(set) => {
                self.resources.set_pipelines(set);
                self.session.shaders = Some(set.shaders.clone());
                self.session.diagnostics.clone_from(&set.shaders.warnings);
            }
            Outcome::Failed(diagnostics) => self.session.diagnostics.clone_from(diagnostics),
            Outcome::Unchanged { .. } => {}
        }
        reload
    }

    /// Replaces the model. On failure the old model stays.
    ///
    /// # Errors
    /// A model that does not fit the device.
    pub fn set_model(&mut self, model: Model) -> Result<(), HeadlessError> {
        let start = Instant::now();
        let uploaded = GpuModel::upload(&self.gpu, &self.layouts, model)?;
        self.session.set_model(uploaded.model());
        self.resources.set_model(&uploaded);
        self.upload_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(())
    }

    /// Random paths that [`Headless::render`] spends on each pixel; `None` if the mode does not accumulate.
    ///
    /// # Errors
    /// As [`Headless::frame_state`].
    pub fn paths_per_pixel(&self) -> Result<Option<u64>, HeadlessError> {
        let request = self.frame_state()?.pipelines;
        let paths = u64::from(request.paths_per_frame()) * u64::from(self.session.settings.view.frames);
        Ok(request.accumulates.then_some(paths))
    }

    /// Renders the frames of the sequence from the beginning, and reads the last one back. In an accumulating mode that is the mean
    /// of `view.frames` frames.
    ///
    /// # Errors
    /// Settings that do not fit, a bad file, a device error.
    pub fn render(&mut self) -> Result<Capture, HeadlessError> {
        self.view.restart_passes();
        let last = self.sequence.frames.saturating_sub(1);
        for index in 0..last {
            self.clock = self.sequence.clock(index);
            let frame = self.bind()?;
            self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))?;
        }
        self.clock = self.sequence.clock(last);
        let frame = self.bind()?;
        if frame.state.pipelines.accumulates {
            for _ in 1..self.session.settings.view.frames {
                self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))?;
            }
        }
        let readback = self.draw_frame(&frame, Redraw::Always, View::read_back)?;
        readback.map(|readback| readback.finish()).ok_or_else(|| HeadlessError::Settings("nothing was drawn".into()))
    }

    /// Renders one frame and waits for it without reading it back, which is the work of a frame in a window.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn draw(&mut self) -> Result<(), HeadlessError> {
        let frame = self.bind()?;
        self.draw_frame(&frame, Redraw::Always, |_, _, _| Ok(()))
    }

    /// The values of one pixel, counted from the upper left corner, in each of `modes`; zero where nothing covers the pixel.
    ///
    /// Only the instances near the pixel are drawn, and only their pipelines are created. If one of them is transmissive, all
    /// instances are drawn, since a transmissive surface refracts light from around the pixel.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn pixel(&mut self, at: (u32, u32), modes: &[Mode]) -> Result<Vec<PixelValue>, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let whole = self.frame_state()?;
        let Some(all) = whole.scene.clone() else { return Ok(Vec::new()) };
        let near = scene::near_pixel(all.model(), whole.camera.clip_from_world(), self.size, at);
        let part = all.only(near);
        let part = if part.is_transmissive() { all.clone() } else { part };
        let state_in = |mode: &Mode, scene: &Scene| {
            let settings = Settings { mode: mode.slug.clone(), ..self.session.settings.clone() };
            let scene = Some(scene);
            let (shaders, revisions, target) = (&whole.shaders, self.session.revisions, whole.pipelines.target);
            FrameState::new(&FrameInputs {
                settings: &settings,
                shaders,
                scene,
                revisions,
                clock: self.clock,
                size: self.size,
                target,
            })
        };
        let state_of = |mode: &Mode| {
            let state = state_in(mode, &part);
            // A declared pass may read the picture anywhere.
            if state.pipelines.passes.is_empty() { state } else { state_in(mode, &all) }
        };
        let states: Vec<Arc<FrameState>> = modes.iter().map(|mode| Arc::new(state_of(mode))).collect();
        self.view.probe = Some(at);
        let mut values = Vec::new();
        // A set keeps the pipelines of its newest requests only.
        for states in states.chunks(PipelineSet::REQUESTS_KEPT as usize / 2) {
            if let Some(set) = self.resources.pipelines() {
                // A driver compiles a pipeline on the calling thread.
                states.par_iter().try_for_each(|state| set.build(&state.pipelines).map(|_| ()))?;
            }
            for state in states {
                let frame = self.resources.provide(state).map_err(|error| self.explained(error.into()))?;
                self.view.restart_passes();
                let frames = if state.pipelines.accumulates { self.session.settings.view.frames } else { 1 };
                for _ in 0..frames {
                    self.draw_frame(&frame, Redraw::Pixel(at.0, at.1), |_, _, _| Ok(()))?;
                }
                values.push(self.view.pixel(self.frames.current()).map(|pixel| pixel.value).unwrap_or_default());
            }
        }
        self.view.probe = None;
        Ok(values)
    }

    /// The picture that the settings describe.
    ///
    /// # Errors
    /// Settings that do not fit, or no shaders yet.
    pub fn frame_state(&self) -> Result<FrameState, HeadlessError> {
        let target = self.target()?;
        let state = self.session.frame_state(self.clock, self.size, target);
        state.ok_or_else(|| HeadlessError::Shaders(self.session.diagnostics.clone()))
    }

    fn target(&self) -> Result<TargetFormat, HeadlessError> {
        View::target_format(&self.gpu, self.session.settings.view.msaa, true).map_err(HeadlessError::Settings)
    }

    /// Checks that the shaders and the model know every setting, and that each value fits.
    ///
    /// # Errors
    /// A message about the first setting that does not fit.
    pub fn check_settings(&self) -> Result<(), HeadlessError> {
        self.session.problems(true).into_iter().next().map_or(Ok(()), |problem| Err(HeadlessError::Settings(problem)))
    }

    fn bind(&mut self) -> Result<BoundFrame, HeadlessError> {
        if let Some(problem) = self.session.problems(false).into_iter().next() {
            return Err(HeadlessError::Settings(problem));
        }
        let mut state = self.frame_state()?;
        if state.pipelines.needs_pending(&state.shaders) {
            self.finish_or_fail()?;
            state = self.frame_state()?;
        }
        self.resources.provide(&Arc::new(state)).map_err(|error| self.explained(error.into()))
    }

    fn finish_or_fail(&mut self) -> Result<(), HeadlessError> {
        match self.finish().map(|reload| reload.outcome) {
            Some(Outcome::Failed(diagnostics)) => Err(HeadlessError::Shaders(diagnostics)),
            _ => Ok(()),
        }
    }

    /// Draws a frame to the output image, records `more`, and waits for both.
    fn draw_frame<T>(
        &mut self,
        frame: &BoundFrame,
        redraw: Redraw,
        more: impl FnOnce(&View, &mut Encoder, &Arc<Image>) -> Result<T, GpuError>,
    ) -> Result<T, HeadlessError> {
        self.view.prepare(frame)?;
        let output = self.output_image()?;
        let mut encoder = self.frames.begin()?;
        let slot = self.frames.current();
        let drawn = self.view.draw(&mut encoder, slot, frame, &to(&output), redraw);
        let recorded = drawn.and_then(|()| more(&self.view, &mut encoder, &output));
        let submitted = recorded.and_then(|result| self.frames.submit(encoder, Default::default()).map(|()| result));
        if submitted.is_err() {
            self.view.forget();
        }
        let result = submitted?;
        self.frames.wait()?;
        match self.frames.endless_loop(self.frames.current()) {
            Some(words) => Err(self.explained(HeadlessError::Gpu(GpuError::EndlessLoop(words)))),
            None => Ok(result),
        }
    }

    /// Replaces the error of a loop that did not end by a diagnostic with the loop's line.
    fn explained(&self, error: HeadlessError) -> HeadlessError {
        let words = match &error {
            HeadlessError::Gpu(GpuError::EndlessLoop(words))
            | HeadlessError::Bake(BakeError::Gpu(GpuError::EndlessLoop(words))) => *words,
            _ => return error,
        };
        let library = self.reloader.library();
        let diagnostic = endless_loop(&self.gpu, words, &self.shaders(), library.compiler(), library.source());
        diagnostic.map_or(error, |diagnostic| HeadlessError::Shaders(vec![diagnostic]))
    }

    fn output_image(&mut self) -> Result<Arc<Image>, HeadlessError> {
        if let Some(output) = &self.output {
            return Ok(output.clone());
        }
        let output = self.view.output_image(self.size)?;
        self.output = Some(output.clone());
        Ok(output)
    }
}

fn to(image: &Arc<Image>) -> Output<'_> {
    Output { image, before: Use::Undefined, at: (0, 0) }
}
