//! Code actions: fixes of misspelled names, sliders from numbers, and expressions over the model.

mod edit;
mod quick_fix;
mod show;
mod slider;

use lsp_types::{CodeActionOrCommand, Range as Span};

use super::view::View;
use crate::shader::Diagnostic;

pub use show::SHOW;

/// The actions for the code at a span. `diagnostics`: of the file. `has_window`: whether a window can be asked.
pub fn actions(view: &View, span: Span, diagnostics: &[Diagnostic], has_window: bool) -> Vec<CodeActionOrCommand> {
    let mut out = quick_fix::fixes(view, span, diagnostics);
    if view.file().is_too_long() {
        return out;
    }
    out.extend(slider::slider(view, span));
    out.extend(show::show(view, span).filter(|_| has_window));
    out
}
