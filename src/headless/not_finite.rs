//! Finds the first statement that makes NaN or infinity at a pixel.

use std::sync::Arc;

use super::{Headless, HeadlessError};
use crate::frame::{FrameInputs, FrameState, TargetFormat, mode_sets};
use crate::gpu::{Frames, Gpu};
use crate::render::{PixelModes, Resources};
use crate::settings::Settings;
use crate::shader::trace::ListeningStage;
use crate::shader::{Compiler, FirstNotFinite, Mode, Source, not_finite};

/// Where to search: a pixel of a frame.
pub struct Search<'a> {
    /// The frame. Its mode and target are ignored.
    pub picture: FrameInputs<'a>,
    /// The pixel, from the upper left corner.
    pub at: (u32, u32),
    /// The mode whose value is not finite.
    pub mode: &'a Mode,
    /// The tree, for the display names of files.
    pub source: &'a Source,
    /// Whether the result is no longer needed.
    pub is_canceled: &'a dyn Fn() -> bool,
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
    (resources, frames): (&mut Resources, &mut Frames),
    search: &Search<'_>,
) -> Result<Option<FirstNotFinite>, String> {
    let Search { picture, mode, .. } = *search;
    let shaders = picture.shaders;
    if mode_sets([mode], 1).is_empty() {
        return Ok(None);
    }
    let set = resources.pipelines().filter(|set| Arc::ptr_eq(&set.shaders, shaders)).cloned();
    let set = set.ok_or("the shaders have changed")?;
    let settings = Settings { mode: mode.slug.clone(), ..picture.settings.clone() };
    let target = TargetFormat::full(1);
    let inputs = |shaders| FrameInputs { settings: &settings, shaders, target, ..picture };
    let plain = FrameState::of_modes(&inputs(shaders), &[mode]);
    let listener = not_finite::listener();
    let stage = ListeningStage::new(shaders, &plain.pipelines.stage, (compiler, search.source), &listener)?;
    let traced = stage.traced(&listener, None, |words, _| Some(words))?;
    let check = || if (search.is_canceled)() { Err("canceled") } else { Ok(()) };
    check()?;
    let state = Arc::new(FrameState::of_modes(&inputs(&traced.shaders), &[mode]));
    let (set, _) = set.variant(traced.shaders.clone(), &state.pipelines).map_err(|error| error.to_string())?;
    check()?;
    let bound = resources.bind_variant(&set, &state).map_err(|error| error.to_string())?;
    let frame = bound.ok_or("the light of the picture is being baked")?;
    let mut draw = || {
        let mut pixel = PixelModes::new(gpu, resources.layouts(), 1)?;
        let mut encoder = frames.begin()?;
        pixel.draw(&mut encoder, 0, &frame, search.at)?;
        frames.submit(encoder, Default::default())?;
        // SYNC: the CPU reads the number.
        frames.wait()?;
        Ok::<_, crate::gpu::GpuError>(pixel.values(0))
    };
    let values = draw().map_err(|error| error.to_string())?;
    Ok(values.first().and_then(|value| traced.found(value)))
}

impl Headless {
    /// The first statement that computes NaN or infinity in a mode at a pixel: see [`first_not_finite`].
    ///
    /// # Errors
    /// As [`Headless::render`].
    pub fn first_not_finite(&mut self, at: (u32, u32), mode: &Mode) -> Result<Option<FirstNotFinite>, HeadlessError> {
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
        let compiler = library.compiler();
        first_not_finite(&self.gpu, compiler, (&mut self.resources, &mut self.offscreen.frames), &search)
            .map_err(HeadlessError::Settings)
    }
}
