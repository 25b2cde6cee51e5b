//! `specula view`: the window.

use std::path::PathBuf;
use std::time::Instant;

use specula::app::{self, AppError, AppOptions};

use super::Failure;
use super::common::{Common, check_model_path, compiler};

/// Beyond any screen, and within what window systems can count.
const LARGEST_WINDOW: u32 = 16384;

/// Options of `view`.
#[derive(clap::Args)]
pub struct Args {
    /// glTF model, .gltf or .glb, or the name of a built-in one [default: shader-ball]
    model: Option<PathBuf>,
    #[command(flatten)]
    common: Common,
}

/// Runs the command.
pub fn run(args: Args, start: Instant) -> Result<(), Failure> {
    let events = args.common.emits();
    check_model_path(args.model.as_deref())?;
    let (width, height) = args.common.size;
    if width.max(height) > LARGEST_WINDOW {
        let message = format!("a window of {width}x{height} is too large; at most {LARGEST_WINDOW} pixels a side");
        return Err(Failure::Input(message));
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
