//! Finds the statement that first makes NaN or infinity at a pixel.
//!
//! The stage that draws the pixel is compiled once more. Its module is instrumented (`spirv/trace.rs`): each value that a statement
//! stores, returns, passes, compares, converts or samples with goes to a function, which keeps the first place where a component is
//! not finite. The stage writes that place as the color, so one draw of one pixel finds the first statement in the order of
//! execution. The set of pipelines is that of the picture except for this stage (`PipelineSet::variant`), so light and tables are the
//! picture's.
//!
//! Limits: only the fragment stage of the mode is searched, not the stages before it, passes, bakes and path tracing. Infinity that a
//! shader handles on purpose counts too. A value that a single expression makes and discards, as in `min(NaN, 1.0)`, does not.

mod report;
mod statement;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;

use super::contract::Texts;
use super::glsl::{code, color_of, main_of};
use super::library::Stage;
use super::source::TreePath;
use super::source::snapshot::Snapshot;
use super::spirv::trace::{Place, trace};
use super::{Compiler, PixelValue, ShaderSet, Source, StageKind};
pub use report::{ELSEWHERE, NotFinite};
pub use statement::Site;

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

/// A stage that traces its values, in a set of shaders that is otherwise the same.
pub struct TracedShaders<'a> {
    /// The set.
    pub shaders: Arc<ShaderSet>,
    stage: Arc<Stage>,
    snapshot: Snapshot<'a>,
    places: Vec<Place>,
}

impl<'a> TracedShaders<'a> {
    /// Compiles the fragment stage `stage` of `shaders` once more and instruments its module. `source` gives files their names.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn new(shaders: &ShaderSet, stage: &str, compiler: &Compiler, source: &'a Source) -> Result<Self, String> {
        let path = TreePath::from(stage);
        let before = shaders.stages.get(stage).filter(|before| before.kind == StageKind::Fragment);
        let before = before.ok_or_else(|| format!("{stage} is no fragment stage that has compiled"))?;
        let texts = shaders.texts.iter().map(|(path, text)| (path.clone(), Ok(text.clone()))).collect();
        let snapshot = Snapshot::holding(source, texts);
        let text = snapshot.read(&path).map_err(|error| error.to_string())?;
        let text = traced(&text).map_err(|lack| format!("{stage} {lack}"))?;
        let over = snapshot.over(BTreeMap::from([(path.clone(), Ok(text.into()))]));
        let words = compiler.compile_with_lines(&over, &path);
        let found = words.and_then(|words| trace(&words, FUNCTION));
        let (words, places) = found.ok_or_else(|| format!("the values of {stage} cannot be traced"))?;
        let mut shaders = shaders.clone();
        shaders.stages.insert(stage.to_owned(), Arc::new(before.with_module(words)));
        Ok(Self { shaders: Arc::new(shaders), stage: before.clone(), snapshot, places })
    }

    /// Decodes a pixel that these shaders have drawn. `None` if every value was finite.
    pub fn found(&self, pixel: &PixelValue) -> Option<FirstNotFinite> {
        let [first, nan, classes, _] = pixel.value.map(|number| number as u32);
        let classes = classes.checked_sub(MARK).filter(|classes| *classes < CLASSES)?;
        // A place is its number from 1, times 4, and the components but one.
        let component = |at: u32| ["finite", "NaN", "Inf", "-Inf"][(classes >> (2 * at) & 3) as usize];
        Some(FirstNotFinite {
            first: self.site(first)?,
            value: if first == nan { "NaN" } else { "Inf" },
            components: (0..=first % 4).map(component).collect(),
            nan: self.site(nan).filter(|_| first != nan),
        })
    }

    fn site(&self, place: u32) -> Option<Site> {
        let place = self.places.get((place as usize / 4).checked_sub(1)?)?;
        let Self { stage, snapshot, .. } = self;
        let texts = Texts { snapshot, stage: &stage.path, dependencies: &stage.dependencies };
        Some(statement::site(place, texts))
    }
}

/// The text of a stage that writes a place as its color. No line moves.
fn traced(text: &str) -> Result<String, &'static str> {
    let main = main_of(&code(text)).ok_or("has no main()")?;
    let color = color_of(text).ok_or("has no `out vec4` color")?;
    let (before, after) = (&text[..main.start], &text[main.end..]);
    let library = TEXT.replace("SPECULA_MARK", &MARK.to_string());
    Ok(format!("{before}specula_main{after}\n{library}void main() {{ specula_main(); {color} = specula_traced(); }}\n"))
}
