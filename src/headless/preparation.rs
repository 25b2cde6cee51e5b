//! Compiles what the trace of a file needs before a pixel is known, so that the first click finds it. Some drivers compile a pipeline when it
//! first draws, so each kind of material is drawn, without a log.

use super::HeadlessError;
use super::near_pixel::NearPixel;
use super::pixel_tracer::{PixelTracer, TracePlan, TraceTools, TracedPixel, no_picture};
use super::stage_plan::{self, Extent};
use crate::frame::{FrameState, MaterialVariant};

/// The stage and the file that can be traced at once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Prepared {
    /// The path of the stage.
    pub stage: String,
    /// The file.
    pub file: String,
    /// Pipelines that were missing.
    pub built: usize,
}

impl PixelTracer {
    /// Compiles what [`PixelTracer::trace`] needs for `file` at any pixel; without a file, for that of the stage. Materials near `pixel.at` come
    /// first. `most`: how many kinds of material are prepared.
    ///
    /// # Errors
    /// The frame has no such stage, the stage has no such file or runs for no pixel, or a device error.
    pub fn prepare(
        &mut self,
        pixel: &TracedPixel<'_>,
        tools: &mut TraceTools<'_>,
        file: Option<&str>,
        most: usize,
    ) -> Result<Prepared, HeadlessError> {
        let near = NearPixel::new(pixel.whole, pixel.settings, pixel.revisions, pixel.at).ok_or_else(no_picture)?;
        let all = near.state_of(Extent::All, pixel.mode, pixel.clock, &pixel.whole.shaders);
        let stage = stage_plan::choose(&all, pixel.stage, file.as_slice())?;
        let file = file.unwrap_or(&stage).to_owned();
        let before = self.built();
        for instance in instances(&all, &near, &stage, most) {
            let of_stage = stage_plan::without_log(&all, &stage, pixel.at, instance)?;
            let plan = TracePlan::of(pixel, near.clone(), of_stage);
            self.files(&plan, tools)?;
            let shown = self.value(&plan, tools)?;
            let constants = plan.constants();
            for files in self.stage(&plan, tools)?.groups(&[&file], &constants)? {
                if (tools.is_canceled)() {
                    return Err(HeadlessError::Canceled);
                }
                self.draw(&plan, tools, &files, &shown)?;
            }
        }
        Ok(Prepared { stage, file, built: self.built() - before })
    }
}

/// An instance of each kind of material, those near the pixel first; `None` alone, if the stage needs the whole frame.
fn instances(all: &FrameState, near: &NearPixel, stage: &str, most: usize) -> Vec<Option<usize>> {
    let scene = all.scene.as_ref().filter(|_| stage_plan::draws_instances(all, stage));
    let Some(scene) = scene else { return vec![None] };
    let is_near = |material: &MaterialVariant| near.materials().contains(material);
    let (first, others): (Vec<_>, Vec<_>) = scene.materials().iter().copied().partition(is_near);
    first.into_iter().chain(others).take(most).map(|material| scene.instance_with(material)).collect()
}
