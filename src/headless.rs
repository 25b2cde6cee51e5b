//! Rendering without a window: the same reload and the same frame as on screen, called one after the other.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use crate::gpu::{Buffer, Gpu, GpuError, Rect, SetLayouts, return_freed_memory, vk};
use crate::render::{
    BakeControl, BakeError, BakeReport, Baked, Capture, Drawn, FrameInput, GpuScene, Outcome, PipelineSet, Reload,
    Reloader, Renderer, Shot, Target, UploadError, Wanted, measured_buffer, misfits, unknown_names,
};
use crate::scene::{self, Measured, Model};
use crate::settings::Settings;
use crate::shader::{Change, Compiler, Diagnostic, Mode, Source};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum HeadlessError {
    /// The shaders do not compile, and there are no earlier ones.
    #[error("the shaders do not compile")]
    Shaders(Vec<Diagnostic>),
    /// A setting does not fit.
    #[error("{0}")]
    Settings(String),
    /// The environment cannot be read or baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The model does not fit the device.
    #[error(transparent)]
    Upload(#[from] UploadError),
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// A renderer with a shader tree, a model and settings.
pub struct Headless {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    renderer: Renderer,
    reloader: Reloader,
    pipelines: Arc<PipelineSet>,
    model: Model,
    /// The model in its own materials; `scene` is in those of the settings.
    uploaded: Arc<GpuScene>,
    scene: Arc<GpuScene>,
    baked: Baked,
    measured: (String, Arc<Buffer>),
    settings: Settings,
    samples: u32,
    size: (u32, u32),
    upload_ms: f64,
}

impl Headless {
    /// Compiles the tree, uploads the model and builds the pipelines. The HDR target has full floats, so that what is read back
    /// is what the shader wrote.
    ///
    /// # Errors
    /// Shaders that do not compile, settings or a model that do not fit, a device that fails.
    pub fn new(
        gpu: &Arc<Gpu>,
        compiler: &Arc<Compiler>,
        source: Source,
        model: Model,
        settings: Settings,
        size: (u32, u32),
    ) -> Result<(Self, Reload), HeadlessError> {
        let layouts = SetLayouts::new(gpu)?;
        let renderer = Renderer::new(gpu, &layouts, vk::Format::R32G32B32A32_SFLOAT)?;
        let most = gpu.max_image_size();
        if size.0 > most || size.1 > most {
            let message = format!("{}x{} is too large; this device draws at most {most} pixels a side", size.0, size.1);
            return Err(HeadlessError::Settings(message));
        }
        let upload = Instant::now();
        model.variant(&settings.variant).map_err(HeadlessError::Settings)?;
        let (model, uploaded) = GpuScene::upload(gpu, &layouts, model)?;
        let scene = uploaded.dressed(gpu, &layouts, &model, &settings)?;
        let upload_ms = upload.elapsed().as_secs_f64() * 1e3;
        let samples = samples(gpu, &settings).map_err(HeadlessError::Settings)?;
        let mut reloader = Reloader::new(gpu, &layouts, compiler, source);
        let mut reload = reloader.update(Change::All, |shaders| wanted(&settings, samples, shaders, &scene), || false);
        let pipelines = match std::mem::replace(&mut reload.outcome, Outcome::Unchanged { cleared: false }) {
            Outcome::Ready(pipelines) => pipelines,
            Outcome::Failed(diagnostics) => return Err(HeadlessError::Shaders(diagnostics)),
            Outcome::Unchanged { .. } => return Err(HeadlessError::Shaders(Vec::new())),
        };
        reload.outcome = Outcome::Ready(pipelines.clone());
        let misfit = misfits(&settings.shader, &pipelines.shaders).into_iter().next();
        if let Some(message) = unknown_names(&settings.shader, &pipelines.shaders).or(misfit) {
            return Err(HeadlessError::Settings(message));
        }
        let mut this = Self {
            gpu: gpu.clone(),
            layouts,
            renderer,
            reloader,
            pipelines,
            model,
            uploaded,
            scene,
            baked: Baked::uniform(gpu, [0.0; 3])?,
            measured: (String::new(), measured_buffer(gpu, None)?),
            settings,
            samples,
            size,
            upload_ms,
        };
        this.open_files()?;
        // Decoders and the compiler are done: what they have freed is there for the frame.
        return_freed_memory();
        Ok((this, reload))
    }

    /// Bakes the environment and reads the measured BRDF that the settings name, if those in use are others. On failure these
    /// stay.
    ///
    /// # Errors
    /// A file that is bad, a device that fails.
    pub fn open_files(&mut self) -> Result<(), HeadlessError> {
        let environment = &self.settings.environment;
        if environment.is_lit() && !self.baked.is_for(&environment.name, &self.pipelines) {
            self.bake(true)?;
        }
        if self.measured.0 != self.settings.measured {
            let name = self.settings.measured.clone();
            let measured = match name.as_str() {
                "" => None,
                path => Some(Measured::open(path.as_ref()).map_err(|e| HeadlessError::Settings(e.to_string()))?),
            };
            self.measured = (name, measured_buffer(&self.gpu, measured.as_ref())?);
        }
        Ok(())
    }

    /// Bakes the environment again, whatever is known of it: its file may have changed. `from_disk`: a result that was kept on
    /// disk will do.
    ///
    /// # Errors
    /// As [`Headless::open_files`].
    pub fn bake(&mut self, from_disk: bool) -> Result<(), HeadlessError> {
        let control = BakeControl { progress: &|_, _| {}, superseded: &|| false, from_disk };
        self.baked = Baked::bake(&self.pipelines, &self.settings.environment.name, &control)?;
        Ok(())
    }

    /// What the last bake took.
    pub fn bake_report(&self) -> &BakeReport {
        &self.baked.environment.report
    }

    /// The files of the environment.
    pub fn environment_files(&self) -> &[std::path::PathBuf] {
        &self.baked.files
    }

    /// The pipelines on screen, with their shaders.
    pub fn pipelines(&self) -> &Arc<PipelineSet> {
        &self.pipelines
    }

    /// The tree.
    pub fn reloader(&self) -> &Reloader {
        &self.reloader
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The settings of the next [`Headless::render`].
    pub fn settings_mut(&mut self) -> &mut Settings {
        &mut self.settings
    }

    /// What the upload of the first model took, milliseconds.
    pub fn upload_ms(&self) -> f64 {
        self.upload_ms
    }

    /// Device time of the last frame in milliseconds, where the device can tell.
    pub fn device_ms(&self) -> Option<f64> {
        self.renderer.device_ms()
    }

    /// Takes changed shaders in, and bakes the environment anew when they say how. On failure the last good ones stay.
    pub fn update(&mut self, change: Change) -> Reload {
        let (settings, samples, scene) = (&self.settings, self.samples, &self.scene);
        let reload = self.reloader.update(change, |shaders| wanted(settings, samples, shaders, scene), || false);
        if let Outcome::Ready(pipelines) = &reload.outcome {
            self.pipelines = pipelines.clone();
        }
        reload
    }

    /// Replaces the model. On failure the old one stays.
    ///
    /// # Errors
    /// A model that does not fit the device.
    pub fn set_model(&mut self, model: Model) -> Result<(), HeadlessError> {
        (self.model, self.uploaded) = GpuScene::upload(&self.gpu, &self.layouts, model)?;
        Ok(())
    }

    /// Renders one frame, building the pipelines that a changed mode or constant needs, and reads it back.
    ///
    /// # Errors
    /// Settings that do not fit, a device that fails.
    pub fn render(&mut self) -> Result<Capture, HeadlessError> {
        self.open_files()?;
        if self.wanted().accumulates {
            for _ in 1..self.settings.view.frames {
                self.frame(Target::Nowhere)?;
            }
        }
        match self.frame(Target::Memory)? {
            Drawn::Captured(capture) => Ok(capture),
            Drawn::Finished | Drawn::Shown { .. } | Drawn::NoImage => unreachable!("a frame to memory is captured"),
        }
    }

    /// Renders one frame and waits for it, without reading it back: what a window would take.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn draw(&mut self) -> Result<(), HeadlessError> {
        self.open_files()?;
        self.frame(Target::Nowhere).map(|_| ())
    }

    /// The raw values of one pixel, counted from the upper left corner, in some modes; premultiplied, as in [`Capture::raw`],
    /// and zero where nothing is. The last mode is the one of the settings then.
    ///
    /// Only what is near to the pixel is drawn, so that only its pipelines are made; all, where light passes through a surface
    /// and what lies behind it is seen from around the pixel.
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn pixel(&mut self, (x, y): (u32, u32), modes: &[Mode]) -> Result<Vec<[f32; 4]>, HeadlessError> {
        self.open_files()?;
        self.dress()?;
        let near = scene::near_pixel(&self.model, self.shot().view.clip_from_world(), self.size, (x, y));
        let part = self.scene.only(&near);
        let part = if part.is_transmissive() { self.scene.clone() } else { part };
        let (settings, samples, pipelines) = (&self.settings, self.samples, &self.pipelines);
        let wanted = |mode: &Mode| {
            let settings = Settings { mode: mode.slug.clone(), ..settings.clone() };
            wanted(&settings, samples, &pipelines.shaders, &part)
        };
        let wanted: Vec<Wanted> = modes.iter().map(wanted).collect();
        // Drivers make a pipeline on the thread that asks for it.
        wanted.par_iter().try_for_each(|wanted| pipelines.build(wanted))?;
        let mut values = Vec::new();
        for (mode, wanted) in modes.iter().zip(wanted) {
            self.settings.mode.clone_from(&mode.slug);
            for _ in 0..if wanted.accumulates { self.settings.view.frames } else { 1 } {
                self.frame_of(&part, Target::Pixel(x, y))?;
            }
            values.push(self.renderer.raw_at(x, y)?.unwrap_or_default());
        }
        Ok(values)
    }

    /// Camera, lights and values of the next frame.
    pub fn shot(&self) -> Shot {
        let (width, height) = self.size;
        let aspect = width as f32 / height as f32;
        let view = scene::frame(&self.model.bounds, &self.model.outline, &self.settings.camera, aspect);
        Shot::new(&self.settings, Some(&self.pipelines.shaders), &self.model, view, 0.0)
    }

    fn wanted(&self) -> Wanted {
        wanted(&self.settings, self.samples, &self.pipelines.shaders, &self.scene)
    }

    /// Puts on what the settings say.
    fn dress(&mut self) -> Result<(), HeadlessError> {
        self.model.variant(&self.settings.variant).map_err(HeadlessError::Settings)?;
        self.scene = self.uploaded.dressed(&self.gpu, &self.layouts, &self.model, &self.settings)?;
        Ok(())
    }

    fn frame(&mut self, target: Target<'_>) -> Result<Drawn, HeadlessError> {
        self.dress()?;
        self.frame_of(&self.scene.clone(), target)
    }

    /// A frame of the scene or of a part of it.
    fn frame_of(&mut self, scene: &Arc<GpuScene>, target: Target<'_>) -> Result<Drawn, HeadlessError> {
        if let Some(misfit) = misfits(&self.settings.shader, &self.pipelines.shaders).into_iter().next() {
            return Err(HeadlessError::Settings(misfit));
        }
        let wanted = wanted(&self.settings, self.samples, &self.pipelines.shaders, scene);
        self.pipelines.build(&wanted)?;
        let (width, height) = self.size;
        let shot = self.shot();
        let input = FrameInput {
            shot: &shot,
            pipelines: Some((&self.pipelines, &wanted)),
            scene: Some(scene),
            environment: &self.baked.environment,
            measured: &self.measured.1,
            rect: Rect { x: 0, y: 0, width, height },
        };
        Ok(self.renderer.frame(input, target)?)
    }
}

/// What the settings ask of these shaders for this scene, when the HDR target has full floats.
fn wanted(settings: &Settings, samples: u32, shaders: &crate::shader::ShaderSet, scene: &GpuScene) -> Wanted {
    let format = vk::Format::R32G32B32A32_SFLOAT;
    Wanted::new(settings, shaders, scene.variants(), scene.own_lights(), samples, format, Renderer::OUTPUT_FORMAT)
}

/// Samples a pixel as the settings ask, checked against the device.
///
/// # Errors
/// A count that is neither 1 nor 4, or that the device lacks, in words.
pub fn samples(gpu: &Gpu, settings: &Settings) -> Result<u32, String> {
    match settings.view.msaa {
        samples @ (1 | 4) if gpu.supports_samples(samples) => Ok(samples),
        4 => Err("this device has no 4x multisampling; use --set view.msaa=1".into()),
        other => Err(format!("view.msaa is {other}; it can be 1 or 4")),
    }
}
