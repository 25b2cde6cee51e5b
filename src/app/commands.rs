//! The result of the panels in a frame: commands and changed settings.

use super::command::settings::change;
use super::command::spec::Command;
use super::state::workspace::Sight;
use crate::settings::Settings;

/// The commands of the panels, and what they show.
pub(super) struct Commands {
    /// A copy of the settings, which panels change. The change is one command at the end of the frame.
    pub(super) settings: Settings,
    pub(super) list: Vec<Command>,
    pub(super) sight: Sight,
}

impl Commands {
    pub(super) fn new(settings: &Settings) -> Self {
        Self { settings: settings.clone(), list: Vec::new(), sight: Sight::default() }
    }

    pub(super) fn push(&mut self, command: Command) {
        self.list.push(command);
    }

    /// The commands, that of changed settings first, and what the panels show.
    pub(super) fn finish(mut self, before: &Settings) -> (Vec<Command>, Sight) {
        if self.settings != *before {
            let settings = self.settings;
            self.list.insert(0, change("settings", move |old| old.clone_from(&settings)));
        }
        (self.list, self.sight)
    }
}
