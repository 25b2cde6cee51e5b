//! Values of the picture under the mouse, for panels.

use std::sync::Arc;

use super::overlay::swatches::Swatch;
use crate::frame::Limits;
use crate::render::RangeSample;
use crate::settings::Colormap;
use crate::shader::Mode;

/// Readings of the picture under the mouse.
pub(in crate::app) struct Readings {
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
