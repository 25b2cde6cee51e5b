//! Warnings of the shaders, each told once.

use specula::shader::Diagnostic;

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
