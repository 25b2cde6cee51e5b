//! `specula brdf`: measures the BRDF of a shader tree, checks its claims, and plots it.

mod canvas;
mod furnace;
mod furnace_page;
mod normalization;
mod options;
mod plot;
mod plot_axes;
mod reciprocity;
mod split_sum;

use clap::Subcommand;

use super::Failure;
use super::progress::Progress;

/// Options of `brdf`.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Measure the directional albedo by roughness and angle; fails if a surface reflects more light than arrives
    Furnace(furnace::Args),
    /// Check Helmholtz reciprocity, f(l, v) = f(v, l)
    Reciprocity(reciprocity::Args),
    /// Check that the microfacet distribution is normalized (the integral of D NoH is 1)
    Normalization(normalization::Args),
    /// Measure the error of image-based lighting against random paths, by roughness
    SplitSum(split_sum::Args),
    /// Plot the lobes and the albedo over the angle to a PNG
    Plot(plot::Args),
}

/// Runs the command.
pub fn run(args: Args) -> Result<(), Failure> {
    let progress = Progress::new(true);
    progress.say("compiling the shaders and measuring");
    match args.what {
        What::Furnace(args) => furnace::run(&args),
        What::Reciprocity(args) => reciprocity::run(&args),
        What::Normalization(args) => normalization::run(&args),
        What::SplitSum(args) => split_sum::run(&args, &progress),
        What::Plot(args) => plot::run(&args),
    }
}
