//! Options of `specula bench`.

use std::path::PathBuf;

use clap::ValueEnum;

use crate::commands::common::{Common, Models};

/// The process to measure.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum What {
    /// Time from a save to the end of the first frame with the new shader
    Reload,
    /// Time of a frame, and of the first frame in each debug mode but those of random paths; with --mode, of that mode alone
    Frame,
    /// Time from opening the model's file to its first frame
    Load,
    /// Time to bake an environment, pass by pass, and to read it from the disk cache
    Bake,
    /// Time to draw a thumbnail of every debug mode: the first time, with building pipelines, and again
    Thumbnails,
    /// Time of a frame with hard shadows, ambient occlusion and bloom, and with 100 passes of one pixel, in turn with one without
    Passes,
    /// CPU time of a frame of 10 to 100,000 primitives, of 10 to 10,000 materials, and of 10 to 10,000 joints; device time of 1 to 1,000 lights;
    /// upload time and memory of textures up to 4 GiB
    Scale,
    /// Time from a click to the values of --file beside its code: the first click (cold), the compilation that the panel Source does before it
    /// (prepare), the click after that (prepared), and the next one (warm)
    Trace,
    /// Cost of each function of a stage: the frame with and without it, drawn in turn until the difference is significant
    Cost,
}

/// Options of `bench`.
#[derive(clap::Args)]
#[command(
    after_help = "cost draws the picture with and without each function that it calls, in turn, until their difference is significant or --samples \
    pairs are drawn. Without a function means that it returns, everywhere, what it returned at the pixel with a call that is nearest to the \
    middle; `out` parameters get what they got there, and `inout` parameters stay. The difference is what the picture would save: the \
    function with those that it calls, and all code that computes its arguments for it alone. So the numbers overlap, and do not add up. They \
    mislead where the result decides about other work (a loop's end, a branch), where a memory access hides the work of others, and where \
    the stage is slow by its registers: the driver's figures show those. A software device is a CPU: its costs say nothing of a GPU. \
    Functions that discard, write memory or variables of the stage, or whose result is a constant, are listed with the reason."
)]
pub struct Args {
    /// The measurement
    #[arg(value_enum)]
    pub(super) what: What,
    #[command(flatten)]
    pub(super) models: Models,
    /// Number of samples, 1 to 1000
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) samples: u32,
    /// File to edit for reload, relative to the root of the tree. The edit changes no pixel
    #[arg(long, value_name = "FILE", default_value = "pbr.frag")]
    pub(super) edit: String,
    /// Replay the edits of this file for reload, with and without compiling only edited functions
    #[arg(long, value_name = "FILE", hide = true)]
    pub(super) edits: Option<PathBuf>,
    /// Largest total of the textures of scale, MiB; 0 leaves them out
    #[arg(long, value_name = "MIB", default_value_t = 4096)]
    pub(super) texture_mib: u64,
    /// Stage of the picture for cost, as tonemap.frag [default: the one that draws the picture]
    #[arg(long, value_name = "STAGE")]
    pub(super) stage: Option<String>,
    /// File of the tree whose values trace shows, as brdf/ndf.glsl [default: the stage that draws the mode]
    #[arg(long, value_name = "FILE")]
    pub(super) file: Option<String>,
    /// Measure this function alone for cost, as d_ggx or 'd_ggx(float, float, float)'; may be repeated
    #[arg(long, value_name = "NAME")]
    pub(super) function: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) common: Common,
}
