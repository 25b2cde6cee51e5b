//! The description of a command, which does not depend on its arguments.

use super::shortcut::Shortcut;
use crate::app::state::State;

/// The lists of keys, in the order in which they are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::app) enum Group {
    Mouse,
    Picture,
    Camera,
    Program,
}

/// The facts of a command that do not depend on the type of its arguments.
pub(in crate::app) struct About {
    /// Name in a line of the socket and of stdin.
    pub(in crate::app) id: &'static str,
    /// Title in the command palette; empty for a command that the palette does not list by itself.
    pub(in crate::app) label: &'static str,
    /// More words by which the palette finds it.
    pub(in crate::app) words: &'static str,
    pub(in crate::app) shortcuts: &'static [Shortcut],
    /// Replaces the names of the shortcuts in lists of keys, for example for a range.
    pub(super) keys: &'static str,
    /// Which list of keys they are in.
    pub(in crate::app) group: Group,
    /// The effect of the shortcuts, for lists of keys.
    pub(in crate::app) keys_doc: &'static str,
    /// Whether a held key repeats the command.
    pub(in crate::app) repeats: bool,
    /// The fields of a line, as JSON that could be sent; `?` marks those that may be left out. `None` for a command that no line can name.
    pub(in crate::app) takes: Option<&'static str>,
    /// Fields that a line must have.
    pub(in crate::app) required: &'static [&'static str],
    /// Description of the command and of its result.
    pub(in crate::app) doc: &'static str,
    /// Whether it is about the window, so that a session without one refuses it.
    pub(in crate::app) needs_window: bool,
    /// Whether the palette and the keys offer the command now.
    pub(in crate::app) is_enabled: fn(&State) -> bool,
}

impl About {
    /// Why a session without a window refuses the command; `None` if it does not.
    pub(in crate::app) fn refusal(&self, state: &State) -> Option<String> {
        let refuses = self.needs_window && !state.has_window;
        refuses.then(|| format!("`{}` is about the window, and this session has none", self.id))
    }

    /// Names of the shortcuts, as lists of keys show them.
    pub(in crate::app) fn key_names(&self) -> String {
        match self.keys {
            "" => self.shortcuts.iter().map(Shortcut::text).collect::<Vec<_>>().join(", "),
            keys => keys.to_owned(),
        }
    }

    /// Name of the shortcut that the palette shows.
    pub(in crate::app) fn key(&self) -> String {
        self.shortcuts.first().map_or_else(|| self.keys.to_owned(), Shortcut::text)
    }
}
