//! The options of `specula check`.

use crate::commands::common::frames::Frames;
use crate::commands::common::{Common, Models};

/// Options of `check`.
#[derive(clap::Args)]
#[command(
    after_help = "Without a model, every file is compiled, and the pipelines of every mode and choice are built.\n\n\
    With a model, it is drawn in the modes of --mode instead, and each assert(condition) and assert(condition, \"message\") in the shaders that \
    fails is an error, with how many fragments, vertices or invocations failed, the first of them, and what it compares there. \
    print(\"name\", value) tells a value in the same way. They cost nothing otherwise.\n\n\
    --undefined also finds operations whose result GLSL leaves open: division by 0, pow() of a negative base, normalize() of a vector of \
    length 0, sqrt(), log(), asin() and the like beyond their range, clamp() and smoothstep() with swapped limits, an index beyond the end, a \
    float that its integer cannot hold, a shift by too much. Such a result may be right on this device and wrong on another one.\n\n\
    All stages that draw the picture are checked: the model, the passes, joints and morph targets. Those that bake light are not."
)]
pub struct Args {
    #[command(flatten)]
    pub models: Models,
    /// Draw the model, and find operations whose result GLSL leaves open
    #[arg(long)]
    pub undefined: bool,
    /// With a model and `--mode all`: include the modes of random paths
    #[arg(long)]
    pub paths: bool,
    /// Print JSON: an array of diagnostics
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub frames: Frames,
    #[command(flatten)]
    pub common: Common,
}
