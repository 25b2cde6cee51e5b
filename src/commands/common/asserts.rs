//! Tells of the assertions of a picture's shaders that fail, and of the values that they print.

use serde_json::Value;
use specula::events::{Event, emit};
use specula::headless::{CheckedPicture, Headless};
use specula::message::tell;
use specula::shader::Diagnostic;
use specula::shader::compile::asserts::has_calls;

use super::unchecked::warn_of_unchecked;
use crate::commands::{Failure, print_diagnostics};

/// Draws the picture again with stages that check their assertions, if there are any, and tells which fail. With `emits`, also as events.
///
/// # Errors
/// [`Failure::Printed`] if an assertion failed.
pub fn check(headless: &mut Headless, emits: bool) -> Result<(), Failure> {
    Asserted::draw(headless)?.tell(emits)
}

/// The assertions of a picture that failed and the values that it printed.
#[derive(Default)]
pub struct Asserted(Option<CheckedPicture>);

impl Asserted {
    /// Draws the picture again with stages that check their assertions, if there are any.
    ///
    /// # Errors
    /// As [`Headless::check_operations`].
    pub fn draw(headless: &mut Headless) -> Result<Self, Failure> {
        if !headless.shaders().texts.values().any(|text| has_calls(text)) {
            return Ok(Self::default());
        }
        // As `specula check` counts: a fragment for each pixel, and not for each sample.
        let msaa = std::mem::replace(&mut headless.settings_mut().view.msaa, 1);
        let picture = headless.check_operations(false);
        headless.settings_mut().view.msaa = msaa;
        Ok(Self(Some(picture?)))
    }

    /// All of them, as `specula check --json` lists them; `None` without assertions in the tree.
    pub fn json(&self) -> Option<Value> {
        let picture = self.0.as_ref()?;
        Some(picture.broken.iter().map(|(broken, diagnostic)| broken.json(diagnostic)).collect())
    }

    /// Prints them, and with `emits` also as events.
    ///
    /// # Errors
    /// [`Failure::Printed`] if an assertion failed.
    pub fn tell(self, emits: bool) -> Result<(), Failure> {
        let Some(picture) = self.0 else { return Ok(()) };
        print_diagnostics(&picture.baked);
        warn_of_unchecked("the device", &picture.left_out, (picture.dropped, picture.without_derivatives));
        let diagnostics: Vec<Diagnostic> = picture.broken.iter().map(|(_, diagnostic)| diagnostic.clone()).collect();
        for diagnostic in &diagnostics {
            emit(emits, &Event::Diagnostic(diagnostic));
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
}
