//! Commands about the program as a whole.

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::{Spec, Until};
use crate::app::actions::exercises::learn;
use crate::app::state::exercise::LearnCommand;

/// Runs a command of the exercises.
pub(in crate::app) static LEARN: Spec<LearnCommand> = Spec::act("learn", learn).of_window();

/// Shows a message for a few seconds.
pub(in crate::app) static SAY: Spec<String> = Spec::act("say", |state, _, text: String| state.say(text));

/// Hides the kept messages and the warnings of the model.
pub(in crate::app) static HIDE_WARNINGS: Spec<()> = Spec::plain("hide-warnings", |state, _, ()| {
    state.notices.dismiss();
    state.model.shows_warnings = false;
});

/// Never shows the hint of the first start again.
pub(in crate::app) static DISMISS_HINT: Spec<()> =
    Spec::plain("dismiss-hint", |state, _, ()| state.hint.dismiss()).of_window();

pub(in crate::app) static QUIT: Spec<()> = Spec::fallible("quit", |state, _, ()| {
    state.quit = true;
    Ok(Until::Closed)
})
.line("Closes the window, or ends the session")
.label("Quit", "close")
.shortcuts(Group::Program, &[Shortcut::key('q').ctrl()], "quit");
