//! The stages that a shader tree must have besides those of its passes, as paths from its root.

use crate::shader::graph::FULL_SCREEN;

pub(crate) const CUBE: &str = "ibl/cube.comp";
pub(crate) const DOWNSAMPLE: &str = "ibl/downsample.comp";
pub(crate) const IRRADIANCE: &str = "ibl/irradiance.comp";
pub(crate) const PREFILTER: &str = "ibl/prefilter.comp";
pub(crate) const PREFILTER_SHEEN: &str = "ibl/prefilter_sheen.comp";
pub(crate) const LOBE: &str = "ibl/lobe.comp";
/// The stages of each part of an environment's bake. If one of them changes, the part is baked again.
pub(crate) const RADIANCE_STAGES: [&str; 3] = [CUBE, DOWNSAMPLE, IRRADIANCE];
pub(crate) const PREFILTER_STAGES: [&str; 2] = [LOBE, PREFILTER];
pub(crate) const SHEEN_STAGES: [&str; 1] = [PREFILTER_SHEEN];
/// The stages of the BRDF lookup tables.
pub(crate) const TABLE_STAGES: [&str; 3] = ["ibl/dfg.comp", "ibl/diffuse_albedo.comp", "ibl/sheen_albedo.comp"];

/// The stage that moves the vertices of a model with joints or morph targets.
pub(crate) const DEFORM: &str = "deform.comp";

/// The stages that measure the BRDF, for `specula brdf`.
pub const MEASURE_STAGES: [&str; 4] =
    ["measure/furnace.comp", "measure/reciprocity.comp", "measure/normalization.comp", "measure/lobe.comp"];

/// The stage that measures the BRDF over the hemisphere, for the window. A tree may lack it.
pub const HEMISPHERE_STAGE: &str = "measure/hemisphere.comp";

/// The stages that a shader tree must have besides those of its passes.
pub fn stages() -> Vec<&'static str> {
    [FULL_SCREEN, DEFORM].into_iter().chain(bake_stages()).collect()
}

/// The stages that bake light.
pub(crate) fn bake_stages() -> impl Iterator<Item = &'static str> {
    TABLE_STAGES.into_iter().chain(RADIANCE_STAGES).chain(PREFILTER_STAGES).chain(SHEEN_STAGES)
}

/// [`stages`] and [`MEASURE_STAGES`].
pub fn all_stages() -> Vec<&'static str> {
    stages().into_iter().chain(MEASURE_STAGES).collect()
}
