//! `specula view`: opens the window.

use std::path::{Path, PathBuf};
use std::time::Instant;

use specula::app::{self, AppError, AppOptions};

use super::Failure;
use super::common::names::check_model_path;
use super::common::{Common, compiler};

/// Largest width and height of a window in pixels: larger than any screen, and within the limits of window systems.
const LARGEST_WINDOW: u32 = 16384;

/// Options of `view`.
#[derive(clap::Args)]
pub struct Args {
    /// glTF model, .gltf or .glb, or the name of a built-in one [default: shader-ball]
    model: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

impl Args {
    /// The model as given on the command line.
    pub fn model(&self) -> Option<&Path> {
        self.model.as_deref()
    }
}

/// Runs the command.
pub fn run(args: Args, start: Instant) -> Result<(), Failure> {
    let events = args.common.emits();
    check_model_path(args.model.as_deref())?;
    let (width, height) = args.common.size;
    if width.max(height) > LARGEST_WINDOW {
        let message =
            format!("--size {width}x{height} is too large for a window; at most {LARGEST_WINDOW} pixels a side");
        return Err(Failure::Usage(message));
    }
    let options = AppOptions {
        source: args.common.source()?,
        compiler: compiler()?,
        model: args.model,
        settings: args.common.settings()?,
        size: args.common.size,
        allow_outside: args.common.allow_outside,
        validation: args.common.validate,
        device: args.common.device,
        events,
        start,
    };
    app::run(options).map_err(|error| match error {
        AppError::Validation(_) => Failure::Input(error.to_string()),
        AppError::NoDisplay(_) | AppError::Gpu(_) => Failure::Device(error.to_string()),
    })
}
