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
    /// CPU time of a frame of 10 to 100,000 primitives, and of 10 to 10,000 materials
    Scale,
}

/// Options of `bench`.
#[derive(clap::Args)]
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
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) common: Common,
}
