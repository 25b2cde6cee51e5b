//! Finds the statement that first makes NaN or infinity at a pixel.
//!
//! The stage that draws the pixel is compiled once more. Its module is instrumented (`spirv/trace/`): each value that a statement
//! stores, returns, passes, compares, converts or samples with goes to a function, which keeps the first place where a component is
//! not finite. The stage writes that place as the color, so one draw of one pixel finds the first statement in the order of
//! execution. The set of pipelines is that of the picture except for this stage (`PipelineSet::variant`), so light and tables are the
//! picture's.
//!
//! Limits: only the fragment stage of the mode is searched, not the stages before it, passes, bakes and path tracing. Infinity that a
//! shader handles on purpose counts too. A value that a single expression makes and discards, as in `min(NaN, 1.0)`, does not.

mod report;

use serde::Serialize;

use super::PixelValue;
use super::spirv::trace::Logged;
use super::trace::{Listener, Site, TracedStage};
pub use report::{ELSEWHERE, NotFinite};

/// The text that is appended to the stage.
const TEXT: &str = include_str!("first.glsl");
/// The function of [`TEXT`] that gets the values.
const FUNCTION: &str = "specula_trace";
/// The blue channel of a pixel with places, and more by the classes of the components, in steps of 1.
const MARK: u32 = 4242 * CLASSES;
/// More than the classes of four components.
const CLASSES: u32 = 1 << 8;

/// The first statements at a pixel whose values are not finite.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FirstNotFinite {
    /// The first statement with NaN or infinity.
    #[serde(flatten)]
    pub first: Site,
    /// `NaN` or `Inf`: what it made.
    pub value: &'static str,
    /// Each component of the value: `finite`, `NaN`, `Inf` or `-Inf`.
    pub components: Vec<&'static str>,
    /// The first statement with NaN, if the first of all made infinity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nan: Option<Site>,
}

impl FirstNotFinite {
    /// The components of a vector as ` (NaN, finite)`; empty for a single number.
    pub fn components(&self) -> String {
        if self.components.len() > 1 { format!(" ({})", self.components.join(", ")) } else { String::new() }
    }
}

/// The text with which a stage writes its first log point with NaN or infinity as its color.
pub fn listener() -> Listener {
    let end = "void main() { specula_main(); SPECULA_COLOR = specula_traced(); }\n";
    let text = TEXT.replace("SPECULA_MARK", &MARK.to_string()) + end;
    Listener { text, extensions: "", function: FUNCTION, logged: Logged::Floats }
}

impl TracedStage {
    /// Decodes a pixel that these shaders have drawn. `None` if every value was finite.
    pub fn found(&self, pixel: &PixelValue) -> Option<FirstNotFinite> {
        let [first, nan, classes, _] = pixel.value.map(|number| number as u32);
        let classes = classes.checked_sub(MARK).filter(|classes| *classes < CLASSES)?;
        let component = |at: u32| ["finite", "NaN", "Inf", "-Inf"][(classes >> (2 * at) & 3) as usize];
        Some(FirstNotFinite {
            first: self.site_of(first)?,
            value: if first == nan { "NaN" } else { "Inf" },
            components: (0..self.point(first)?.count).map(component).collect(),
            nan: self.site_of(nan).filter(|_| first != nan),
        })
    }
}
