//! Values from the engine and the screen that panels show.

use std::sync::Arc;

use super::gallery::Thumbnails;
use super::panels::overlay::swatches::Swatch;
use crate::frame::Limits;
use crate::gpu::MemoryUse;
use crate::render::{BakeReport, RangeSample};
use crate::settings::Colormap;
use crate::shader::Mode;

/// Values that the engine and the screen have at the start of a frame.
pub(in crate::app) struct Readings<'a> {
    /// The fraction of the current bake that is done, and its next pass.
    pub(in crate::app) baking: Option<&'a (f32, String)>,
    /// The times of the bake whose light is shown.
    pub(in crate::app) baked: &'a BakeReport,
    /// Memory of the device, and of the process where the system reports it; `None` while nobody sees it.
    pub(in crate::app) memory: Option<(&'a MemoryUse, Option<u64>)>,
    /// The thumbnails of modes.
    pub(in crate::app) thumbnails: &'a Thumbnails,
    /// The texture that was asked for, and the part of it that shows the texture of the model.
    pub(in crate::app) texture: Option<(egui::TextureId, egui::Rect)>,
    /// How many pipelines are kept.
    pub(in crate::app) pipelines: usize,
    /// The value under the mouse.
    pub(in crate::app) value: Option<Readout>,
    /// Title over the picture.
    pub(in crate::app) title: Option<String>,
    /// Contents of the legend; `None` before the first frame.
    pub(in crate::app) legend: Option<LegendOf>,
}

/// The text of a value in the picture.
pub(in crate::app) struct Readout {
    /// Name of the side of a comparison that has the pixel; `None` without a comparison.
    pub(in crate::app) side: Option<String>,
    /// Its numbers, or what they mean.
    pub(in crate::app) value: String,
    /// Unit, and whether the value is before exposure.
    pub(in crate::app) unit: String,
    /// Pixels from the upper left corner of the picture.
    pub(in crate::app) at: (u32, u32),
}

/// The picture of which the legend speaks.
pub(in crate::app) struct LegendOf {
    pub(in crate::app) mode: Mode,
    /// The values that the display shows as black and white; `None` for those of the mode.
    pub(in crate::app) limits: Option<Limits>,
    /// Samples of the picture's values.
    pub(in crate::app) range_sample: Option<Arc<RangeSample>>,
    pub(in crate::app) colormap: Colormap,
    /// Factor from luminance to the display's 0..1.
    pub(in crate::app) exposure: f32,
    /// The colors that stand for single numbers.
    pub(in crate::app) swatches: Vec<Swatch>,
}
