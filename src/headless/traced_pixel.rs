//! Draws a pixel with a stage that tells what it computes: the first statement that makes NaN or infinity, or all statements.

use std::sync::Arc;

use super::{Headless, HeadlessError};
use crate::frame::{FrameInputs, FrameState, TargetFormat, mode_sets};
use crate::gpu::{Buffer, Encoder, Frames, Gpu, GpuError, Memory, vk};
use crate::render::{PixelModes, Resources};
use crate::settings::Settings;
use crate::shader::not_finite;
use crate::shader::trace::{ListeningStage, LoggingStage, Trace, log};
use crate::shader::{Compiler, FirstNotFinite, Mode, PixelValue, ShaderSet, Source};

/// Where to search: a pixel of a frame.
pub struct Search<'a> {
    /// The frame. Its mode and target are ignored.
    pub picture: FrameInputs<'a>,
    /// The pixel, from the upper left corner.
    pub at: (u32, u32),
    /// The mode whose stage is searched.
    pub mode: &'a Mode,
    /// The tree, for the display names of files.
    pub source: &'a Source,
    /// Whether the result is no longer needed.
    pub is_canceled: &'a dyn Fn() -> bool,
}

impl Search<'_> {
    /// The state of the pixel with these shaders, in the mode alone.
    fn state(&self, shaders: &Arc<ShaderSet>) -> FrameState {
        let settings = Settings { mode: self.mode.slug.clone(), ..self.picture.settings.clone() };
        let inputs = FrameInputs { settings: &settings, shaders, target: TargetFormat::full(1), ..self.picture };
        FrameState::of_modes(&inputs, &[self.mode])
    }

    /// The fragment stage that draws the mode. `None` if a pass or random paths do.
    fn stage(&self) -> Option<String> {
        (!mode_sets([self.mode], 1).is_empty()).then(|| self.state(self.picture.shaders).pipelines.stage.clone())
    }

    fn check(&self) -> Result<(), String> {
        if (self.is_canceled)() { Err("canceled".to_owned()) } else { Ok(()) }
    }

    /// Draws the pixel with these shaders, which differ from the picture's in one stage at most. `more` records what follows the draw.
    fn draw(
        &self,
        gpu: &Arc<Gpu>,
        (resources, frames): (&mut Resources, &mut Frames),
        shaders: &Arc<ShaderSet>,
        more: impl FnOnce(&mut Encoder),
    ) -> Result<PixelValue, String> {
        self.check()?;
        let set = resources.pipelines().filter(|set| Arc::ptr_eq(&set.shaders, self.picture.shaders)).cloned();
        let set = set.ok_or("the shaders have changed")?;
        let state = Arc::new(self.state(shaders));
        let set = set.variant(shaders.clone(), &state.pipelines).map_err(|error| error.to_string())?;
        self.check()?;
        let bound = resources.bind_variant(&set, &state).map_err(|error| error.to_string())?;
        let frame = bound.ok_or("the light of the picture is being baked")?;
        let draw = || {
            let mut pixel = PixelModes::new(gpu, resources.layouts(), 1)?;
            let mut encoder = frames.begin()?;
            pixel.draw(&mut encoder, 0, &frame, self.at)?;
            more(&mut encoder);
            frames.submit(encoder, Default::default())?;
            // SYNC: the CPU reads the value.
            frames.wait()?;
            Ok::<_, GpuError>(pixel.values(0))
        };
        let values = draw().map_err(|error| error.to_string())?;
        Ok(values.first().copied().unwrap_or_default())
    }
}

/// Compiles the stage of a mode with a text that traces its values, draws the pixel with it, and returns the first statement that
/// computes NaN or infinity. `None` if the stage computes neither there: a pass after the model does, an earlier stage, or a
/// path-traced mode. `frames` and `resources` belong to the caller and have everything that the frame needs.
///
/// # Errors
/// A message if the stage cannot be traced or drawn.
pub fn first_not_finite(
    gpu: &Arc<Gpu>,
    compiler: &Compiler,
    device: (&mut Resources, &mut Frames),
    search: &Search<'_>,
) -> Result<Option<FirstNotFinite>, String> {
    let Some(stage) = search.stage() else { return Ok(None) };
    let listener = not_finite::listener();
    let stage = ListeningStage::new(search.picture.shaders, &stage, (compiler, search.source), &listener)?;
    let traced = stage.traced(&listener, None, Some)?;
    let value = search.draw(gpu, device, &traced.shaders, |_| ())?;
    Ok(traced.found(&value))
}

/// Draws the pixel with a stage that logs what its statements do, once for each of its files that are `wanted`, and once without the log, to
/// compare the colors. Passes after the model are left out, and what lies behind transmissive surfaces is black. `frames` and `resources`
/// belong to the caller and have everything that the frame needs.
///
/// # Errors
/// A message if the stage cannot be traced or drawn, for example because a pass or random paths draw the mode.
pub fn trace_pixel(
    gpu: &Arc<Gpu>,
    compiler: &Compiler,
    (resources, frames): (&mut Resources, &mut Frames),
    search: &Search<'_>,
    wanted: &dyn Fn(&str) -> bool,
) -> Result<Trace, String> {
    let stage = search.stage().ok_or_else(|| {
        let mode = &search.mode.slug;
        format!(
            "{mode} is drawn by a pass or by random paths; only the statements of the model's own stages can be traced"
        )
    })?;
    use vk::BufferUsageFlags as Usage;
    let usage = Usage::STORAGE_BUFFER | Usage::SHADER_DEVICE_ADDRESS;
    let buffer = Buffer::new(gpu, "trace", log::SIZE, usage, Memory::Readback).map_err(|error| error.to_string())?;
    let stage = LoggingStage::new(search.picture.shaders, &stage, (compiler, search.source), buffer.address())?;
    let files = stage.files()?;
    let plain = search.draw(gpu, (resources, frames), search.picture.shaders, |_| ())?;
    let empty: Vec<u8> = log::empty(search.at_in_quad()).iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut trace: Option<Trace> = None;
    for file in files.iter().filter(|file| wanted(file)) {
        buffer.fill(0, buffer.size() as usize, |bytes| bytes.fill(0));
        buffer.write(0, &empty);
        let traced = stage.of(file)?;
        search.draw(gpu, (resources, frames), &traced.shaders, |encoder| {
            encoder.keep(&buffer);
            encoder.buffers_written();
        })?;
        let bytes = buffer.read();
        let word = |word: &[u8]| u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        let words: Vec<u32> = bytes.chunks_exact(4).map(word).collect();
        let of_file = Trace::new(&traced, &words, &plain);
        match &mut trace {
            Some(trace) => trace.add(of_file)?,
            None => trace = Some(of_file),
        }
    }
    trace.ok_or_else(|| format!("no statement of these files is in the stage; it has {}", files.join(", ")))
}

impl Search<'_> {
    /// The pixel in the target of two by two pixels, where a stage sees it.
    fn at_in_quad(&self) -> (u32, u32) {
        (self.at.0 % 2, self.at.1 % 2)
    }
}

impl Headless {
    /// The first statement that computes NaN or infinity in a mode at a pixel: see [`first_not_finite`].
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn first_not_finite(&mut self, at: (u32, u32), mode: &Mode) -> Result<Option<FirstNotFinite>, HeadlessError> {
        self.search(at, mode, first_not_finite)
    }

    /// What the statements of the `wanted` files compute that draw a mode at a pixel: see [`trace_pixel`].
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn trace(
        &mut self,
        at: (u32, u32),
        mode: &Mode,
        wanted: &dyn Fn(&str) -> bool,
    ) -> Result<Trace, HeadlessError> {
        self.search(at, mode, |gpu, compiler, device, search| trace_pixel(gpu, compiler, device, search, wanted))
    }

    fn search<R>(
        &mut self,
        at: (u32, u32),
        mode: &Mode,
        run: impl FnOnce(&Arc<Gpu>, &Compiler, (&mut Resources, &mut Frames), &Search<'_>) -> Result<R, String>,
    ) -> Result<R, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let (shaders, scene) = (self.shaders(), self.session.scene());
        let library = self.reloader.library();
        let search = Search {
            picture: self.session.inputs(&shaders, scene.as_ref(), self.clock, self.size, TargetFormat::full(1)),
            at,
            mode,
            source: library.source(),
            is_canceled: &|| false,
        };
        let device = (&mut self.resources, &mut self.frames);
        run(&self.gpu, library.compiler(), device, &search).map_err(HeadlessError::Settings)
    }
}
