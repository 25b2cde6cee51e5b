//! The commands of the window. A command is an entry ([`spec::Spec`]) in the file of its family and a line in [`registry::REGISTRY`]: its
//! names, its keys, its arguments, when it is enabled, what it does, and when it is done. Keys, panels, the palette, dropped files, stdin
//! and the socket carry it out here.

pub(super) mod about;
mod assignments;
pub(super) mod camera;
pub(super) mod capture;
pub(super) mod checks;
pub(super) mod compare;
pub(super) mod costs;
mod fields;
pub(super) mod file;
mod history;
pub(super) mod layout;
pub(super) mod look;
mod measure;
pub(super) mod models;
pub(super) mod modes;
mod numbers;
pub(super) mod playback;
pub(super) mod program;
pub(super) mod registry;
pub(super) mod scene;
pub(super) mod settings;
pub(super) mod shaders;
mod shortcut;
pub(super) mod source;
pub(super) mod spec;
mod texts;

use winit::event::KeyEvent;
use winit::keyboard::ModifiersState;

use super::control::{answer_when, tell_when};
use crate::app::actions::watch::watch_files;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::control::Asked;
use crate::message::did_you_mean;
use registry::{REGISTRY, described};
use shortcut::Shortcut;
use spec::{Command, Outcome};

/// Carries out a command of keys, panels or the palette. The user is told if it is refused.
pub(super) fn execute(state: &mut State, engine: &mut Engine, command: Command) {
    let quits = state.quit;
    let outcome = command.run(state, engine);
    if state.quit && !quits {
        (state.quit, state.quits_by_hand) = (false, true);
    }
    tell_when(state, engine, outcome);
    watch_files(state, engine);
}

/// Carries out a command from outside, and answers it when it is done.
pub(super) fn on_asked(state: &mut State, engine: &mut Engine, Asked { command, fields, reply }: Asked) {
    let known = REGISTRY.iter().find(|known| known.about().id == command);
    if let Some(refusal) = known.and_then(|known| known.about().refusal(state)) {
        return reply.error(refusal);
    }
    let parsed = known.and_then(|known| known.parse(fields)).unwrap_or_else(|| {
        let hint = did_you_mean(&command, described().map(|known| known.command));
        Err(format!("there is no command `{command}`.{hint} `commands` lists them all"))
    });
    state.asking = reply.key().0;
    let outcome: Outcome = parsed.and_then(|command| command.run(state, engine));
    answer_when(state, engine, reply, outcome);
    watch_files(state, engine);
}

/// The enabled command whose shortcut a key is; of several, the one that names most of the modifiers that are held.
pub(super) fn of_key(state: &State, event: &KeyEvent, held: ModifiersState) -> Option<(Command, Shortcut)> {
    let reads_keys = state.reads_keys();
    let enabled = REGISTRY.iter().filter(|command| command.is_enabled(state));
    let shortcuts =
        enabled.flat_map(|command| command.about().shortcuts.iter().enumerate().map(move |at| (command, at)));
    let matching = shortcuts.filter_map(|(command, (index, shortcut))| {
        shortcut.matches(event, held, reads_keys).map(|modifiers| (modifiers, command, index, *shortcut))
    });
    // The first of those that fit equally well.
    let best = matching.reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.and_then(|(_, command, index, shortcut)| Some((command.at(index)?, shortcut)))
}
