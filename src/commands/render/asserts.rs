//! Tells of the assertions of a picture's shaders that fail, and of the values that they print.

use specula::events::{Event, emit};
use specula::headless::Headless;
use specula::message::tell;
use specula::shader::Diagnostic;
use specula::shader::compile::asserts::has_calls;

use super::Args;
use crate::commands::{Failure, print_diagnostics};

/// Draws the picture again with stages that check their assertions, if there are any.
pub(super) fn check(headless: &mut Headless, args: &Args) -> Result<(), Failure> {
    if !headless.shaders().texts.values().any(|text| has_calls(text)) {
        return Ok(());
    }
    let picture = headless.check_operations(false)?;
    let diagnostics: Vec<Diagnostic> = picture.broken.iter().map(|(_, diagnostic)| diagnostic.clone()).collect();
    for diagnostic in &diagnostics {
        emit(args.common.emits(), &Event::Diagnostic(diagnostic));
    }
    print_diagnostics(&diagnostics);
    match picture.broken.iter().filter(|(broken, _)| broken.is_fault()).count() {
        0 => Ok(()),
        failed => {
            tell(format_args!("{failed} assertion{} failed", if failed == 1 { "" } else { "s" }));
            Err(Failure::Printed)
        }
    }
}
