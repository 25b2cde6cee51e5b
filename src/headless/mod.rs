//! Rendering without a window: the same reload and the same frames as on screen, on one thread.

mod checks;
mod cost_meter;
mod draw;
mod error;
mod hints;
mod inspect;
mod kept_stages;
mod near_pixel;
mod neighborhood;
mod not_finite;
mod not_finite_pictures;
mod offscreen_view;
mod picture_checker;
mod pixel;
mod pixel_tracer;
mod preparation;
mod reload;
mod sequence;
mod stage_costs;
mod stage_plan;
mod stages;
mod stopwatch;
mod thumbnails;
mod trace;
mod traced_lights;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

use crate::frame::{Clock, FrameState, TargetFormat};
use crate::gpu::{DrawCounts, Gpu, PassTime, SetLayouts, return_freed_memory};
use crate::pipeline::{Outcome, Reload, Reloader};
use crate::render::{BakeReport, BoundFrame, GpuModel, Resources, View, beyond_memory, wrong_values};
use crate::scene::Model;
use crate::session::Session;
use crate::settings::Settings;
use crate::shader::{Compiler, Diagnostic, ShaderSet, Source, expression};

pub use cost_meter::{CostMeter, CostRequest};
pub use draw::Step;
pub use error::HeadlessError;
pub use not_finite::{Search, first_not_finite};
pub use not_finite_pictures::{NotFinitePicture, NotFinitePictures};
pub use offscreen_view::OffscreenView;
pub use picture_checker::{CheckRequest, CheckedPicture, PictureChecker};
pub use pixel_tracer::{PixelTracer, TracePlan, TraceTools, TracedPixel};
pub use preparation::Prepared;
pub use sequence::Sequence;
pub use stage_costs::{FunctionCost, StageCosts};
pub use stopwatch::{Contest, Stopwatch};
pub use thumbnails::Thumbnail;
pub use trace::TraceRequest;

/// A session, a device and one view.
pub struct Headless {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    session: Session,
    reloader: Reloader,
    resources: Resources,
    /// The view, and the image that [`Headless::render`] draws to and reads back.
    offscreen: OffscreenView,
    /// Draws traced pixels. It keeps what it has compiled for the next ones, and is dropped after an error.
    tracer: Option<PixelTracer>,
    size: (u32, u32),
    clock: Clock,
    sequence: Sequence,
    is_linear: bool,
    is_last_picture: bool,
    upload_ms: f64,
    /// See [`Headless::take_cut_short`].
    cut_short: Vec<Diagnostic>,
    /// See [`Headless::take_not_finite`].
    not_finite: NotFinitePictures,
}

impl Headless {
    /// Compiles the tree, uploads the model and creates everything that the first frame needs. The HDR target has full
    /// floats, so that readback returns exactly what the shader wrote.
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
        this.watch()?;
        let reload = this.compile_all()?;
        this.check_settings()?;
        this.provide()?;
        Ok((this, reload))
    }

    /// Like [`Headless::new`], with the stages that [`crate::measure::BrdfMeter`] needs. Unknown names in the settings are accepted, and
    /// the resources of a frame are created when it is rendered.
    ///
    /// # Errors
    /// As [`Headless::new`].
    pub fn measuring(
        gpu: &Arc<Gpu>,
        compiler: &Arc<Compiler>,
        source: Source,
        model: Model,
        settings: Settings,
        size: (u32, u32),
    ) -> Result<Self, HeadlessError> {
        let mut this = Self::open(gpu, compiler, source.clone(), model, settings, size)?;
        this.reloader = Reloader::measuring(gpu, &this.layouts, compiler, source);
        this.compile_all()?;
        Ok(this)
    }

    /// Like [`Headless::new`], but reads the model while the shaders compile, compiles only what the frame needs, and does not
    /// create the resources of a frame. If the reload has failed, [`Headless::update_first`] may be called any number of times
    /// before the first frame. `read` may change the settings so that they fit the model.
    ///
    /// # Errors
    /// Those of `read`, settings or a model that do not fit, a device error.
    pub fn start<E: From<HeadlessError>>(
        gpu: &Arc<Gpu>,
        compiler: &Arc<Compiler>,
        source: Source,
        settings: Settings,
        size: (u32, u32),
        read: impl FnOnce(&mut Settings) -> Result<Model, E>,
    ) -> Result<(Self, Reload), E> {
        let variant = settings.variant.clone();
        let settings = Settings { variant: String::new(), ..settings };
        let mut this = Self::open(gpu, compiler, source, Model::default(), settings, size)?;
        // Settings may name passes that are off, their modes and their parameters.
        let settings = &this.session.settings;
        let names_passes =
            !settings.passes.is_empty() || !settings.shader.is_empty() || settings.mode.starts_with("pass:");
        this.watch()?;
        let reloader = &mut this.reloader;
        let mut compiled = None;
        this.session.settings.variant = variant;
        let settings = &mut this.session.settings;
        let model = rayon::in_place_scope(|scope| {
            scope.spawn(|_| compiled = Some(reloader.compile_first_picture(names_passes)));
            read(settings)
        });
        // The scope ends with it.
        let compiled = compiled.unwrap_or_else(|| this.reloader.compile_first_picture(names_passes));
        let model = model?;
        model.variant(&this.session.settings.variant).map_err(HeadlessError::Settings)?;
        this.set_model(model)?;
        let reload = this.reload(|reloader, request| reloader.build(compiled, request, || false));
        Ok((this, reload))
    }

    /// Like [`Headless::new`], but compiles nothing. Call [`Headless::update`], which may fail any number of times before the
    /// first frame.
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
        check_size(gpu, size)?;
        model.variant(&settings.variant).map_err(HeadlessError::Settings)?;
        let layouts = SetLayouts::new(gpu)?;
        let mut this = Self {
            gpu: gpu.clone(),
            session: Session::new(settings),
            reloader: Reloader::new(gpu, &layouts, compiler, source),
            resources: Resources::new(gpu, &layouts, [0.0; 3])?,
            offscreen: OffscreenView::new(gpu, &layouts)?,
            tracer: None,
            layouts,
            size,
            clock: Clock::default(),
            sequence: Sequence::default(),
            is_linear: false,
            is_last_picture: false,
            upload_ms: 0.0,
            cut_short: Vec::new(),
            not_finite: NotFinitePictures::default(),
        };
        this.target()?;
        this.set_model(model)?;
        Ok(this)
    }

    /// Creates the environment, the measured BRDF and the pipelines that the next frame lacks. On failure the current ones stay.
    ///
    /// # Errors
    /// A bad file, or a device error.
    pub fn provide(&mut self) -> Result<(), HeadlessError> {
        self.bind()?;
        // Decoding and compiling are done. Return the freed memory, which a software device needs for rendering.
        return_freed_memory();
        Ok(())
    }

    /// Bakes the environment of the settings again. `from_disk` allows a cached result.
    ///
    /// # Errors
    /// As [`Headless::provide`].
    pub fn bake(&mut self, from_disk: bool) -> Result<(), HeadlessError> {
        match &self.frame_state()?.environment {
            Some(key) => self.resources.bake(key.clone(), from_disk).map_err(|error| self.explained(error.into())),
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

    /// Warnings about the environment's file, and about functions that returned invalid values in the last bakes.
    pub fn bake_warnings(&self) -> Vec<String> {
        let tables = self.resources.tables().map(|tables| tables.wrong.clone()).unwrap_or_default();
        let mut functions: BTreeSet<&str> = tables.into_iter().collect();
        functions.extend(self.resources.environment().wrong());
        let of_file = self.bake_report().warnings.iter().cloned();
        of_file.chain(functions.into_iter().map(wrong_values)).collect()
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

    /// Sets the size of the next picture, pixels.
    ///
    /// # Errors
    /// The device cannot draw it.
    pub fn set_size(&mut self, size: (u32, u32)) -> Result<(), HeadlessError> {
        check_size(&self.gpu, size)?;
        if self.size != size {
            self.size = size;
        }
        Ok(())
    }

    /// Sets whether captures are for files of linear light (EXR): their pixels are then plain averages of the samples.
    pub fn set_linear(&mut self, is_linear: bool) {
        self.is_linear = is_linear;
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
        self.offscreen.frames.last_device_ms()
    }

    /// Device time of each pass of the last frame, if the device supports timestamps.
    pub fn pass_times(&self) -> &[PassTime] {
        self.offscreen.frames.pass_times()
    }

    /// Numbers of draws and of commands of the last frame.
    pub fn draw_counts(&self) -> DrawCounts {
        self.offscreen.frames.draw_counts()
    }

    /// Replaces the model. On failure the old model stays.
    ///
    /// # Errors
    /// A model that does not fit the device.
    pub fn set_model(&mut self, model: Model) -> Result<(), HeadlessError> {
        let start = Instant::now();
        let uploaded = GpuModel::upload(&self.gpu, &self.layouts, model)?;
        return_freed_memory();
        self.session.set_model(uploaded.model());
        self.resources.set_model(&uploaded);
        self.upload_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(())
    }

    /// The frame that the settings describe.
    ///
    /// # Errors
    /// Settings that do not fit, or no shaders yet.
    pub fn frame_state(&self) -> Result<Arc<FrameState>, HeadlessError> {
        let target = self.target()?;
        let state = self.session.frame_state(self.clock, self.size, target);
        state.ok_or_else(|| HeadlessError::Shaders(self.session.diagnostics.clone()))
    }

    fn target(&self) -> Result<TargetFormat, HeadlessError> {
        let format = View::target_format(&self.gpu, self.session.settings.view.msaa, true);
        format.map(|format| TargetFormat { weighs: !self.is_linear, ..format }).map_err(HeadlessError::Settings)
    }

    /// Checks that the shaders and the model know every setting, and that each value fits.
    ///
    /// # Errors
    /// A message about the first setting that does not fit.
    pub fn check_settings(&self) -> Result<(), HeadlessError> {
        self.session.problems(true).into_iter().next().map_or(Ok(()), |problem| Err(HeadlessError::Settings(problem)))
    }

    /// Whether the frame changes as time passes.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn is_animated(&mut self) -> Result<bool, HeadlessError> {
        Ok(self.bind()?.is_animated())
    }

    fn bind(&mut self) -> Result<BoundFrame, HeadlessError> {
        if let Some(problem) = self.session.problems(false).into_iter().next() {
            return Err(HeadlessError::Settings(problem));
        }
        if let Some(change) = self.watch()?
            && let Outcome::Failed(diagnostics) = self.update(change).outcome
        {
            return Err(HeadlessError::Shaders(diagnostics));
        }
        let mut state = self.frame_state()?;
        let watches = self.session.settings.mode == expression::MODE;
        // A pass that shows an expression has no mode before it is compiled.
        let is_unseen = watches && state.shaders.pending.contains(expression::STAGE);
        if is_unseen || state.pipelines.needs_pending(&state.shaders) {
            self.finish_or_fail()?;
            state = self.frame_state()?;
        }
        if let Some(error) = state.shaders.expression_error().filter(|_| watches) {
            return Err(HeadlessError::Shaders(vec![error.clone()]));
        }
        if let Some(error) = beyond_memory(&state.pipelines, state.size, state.pass_memory) {
            return Err(HeadlessError::Shaders(vec![error]));
        }
        let bound = self.resources.provide(&state);
        // The number of suns is known only after the bake.
        let suns = self.resources.environment().sun_count();
        if suns == self.session.revisions.suns {
            return bound.map_err(|error| self.explained(error.into()));
        }
        self.session.revisions.suns = suns;
        let state = self.frame_state()?;
        self.resources.provide(&state).map_err(|error| self.explained(error.into()))
    }
}

fn check_size(gpu: &Gpu, (width, height): (u32, u32)) -> Result<(), HeadlessError> {
    let most = gpu.max_image_size();
    if width > most || height > most {
        let message = format!("{width}x{height} is too large; this device draws at most {most} pixels a side");
        return Err(HeadlessError::Settings(message));
    }
    Ok(())
}
