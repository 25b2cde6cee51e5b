//! Tells of the assertions of a picture's shaders that fail, and of the values that they print.

use specula::events::{Event, emit};
use specula::headless::Headless;
use specula::message::tell;
use specula::shader::Diagnostic;
use specula::shader::compile::asserts::has_calls;

use super::Args;
use crate::commands::common::unchecked::warn_of_unchecked;
use crate::commands::{Failure, print_diagnostics};

/// Draws the picture again with stages that check their assertions, if there are any.
pub(super) fn check(headless: &mut Headless, args: &Args) -> Result<(), Failure> {
    if !headless.shaders().texts.values().any(|text| has_calls(text)) {
        return Ok(());
    }
    // As `specula check` counts: a fragment for each pixel, and not for each sample.
    let msaa = std::mem::replace(&mut headless.settings_mut().view.msaa, 1);
    let picture = headless.check_operations(false);
    headless.settings_mut().view.msaa = msaa;
    let picture = picture?;
    print_diagnostics(&picture.baked);
    warn_of_unchecked("the device", &picture.left_out, (picture.dropped, picture.without_derivatives));
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
