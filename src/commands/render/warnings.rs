//! Warnings: those of the shaders, each told once, and that of pixels with NaN or infinity.

use specula::headless::{Headless, NotFinitePicture};
use specula::message;
use specula::shader::Diagnostic;

use super::args::Args;
use crate::commands::print_diagnostics;

/// The warnings that the last reload had.
#[derive(Default)]
pub struct Warnings(Vec<Diagnostic>);

impl Warnings {
    /// Prints the warnings that are new.
    pub fn tell(&mut self, warnings: &[Diagnostic]) {
        let new: Vec<Diagnostic> = warnings.iter().filter(|warning| !self.0.contains(warning)).cloned().collect();
        print_diagnostics(&new);
        self.0 = warnings.to_vec();
    }
}

/// Warns of pixels with NaN or infinity in the pictures that were written since the last call.
pub fn warn_of_not_finite(headless: &mut Headless, args: &Args) {
    let found = headless.take_not_finite();
    let Some(NotFinitePicture { mode, size, count, at: (x, y) }) = found.first else { return };
    let pixels = match (found.of, count) {
        (1, 1) => "1 pixel is NaN or infinite:".to_owned(),
        (1, _) => format!("{count} pixels are NaN or infinite, such as"),
        (of, _) => format!(
            "{} of {of} pictures have pixels that are NaN or infinite. The first, of the mode {mode}, has {count}, such as",
            found.pictures
        ),
    };
    let size = if size == args.common.size() { String::new() } else { format!(" --size {}x{}", size.0, size.1) };
    message::warn(format_args!(
        "{pixels} {x}, {y}. `specula probe --at {x},{y}{size}` with the same model, shaders and settings finds the line"
    ));
}
