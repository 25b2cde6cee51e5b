//! A setting as the list of all settings has it.

use super::entry::Entry;
use super::value::Value;

/// A setting: its path, its entry, and what follows from its type.
#[derive(Debug)]
pub struct Setting {
    /// Path for `--set`, as `lights.orbit.0.strength`.
    pub path: String,
    /// The entry that was declared with its field.
    pub entry: &'static Entry,
    /// Kind of value: a number, three numbers, a name, ...
    pub takes: &'static str,
    /// The names that it takes, if these are all that it takes.
    pub names: Vec<String>,
    /// Value without any option.
    pub default: Value,
}

impl Setting {
    /// Path of its group; empty at the top.
    pub fn group(&self) -> &str {
        self.path.rsplit_once('.').map_or("", |(group, _)| group)
    }

    /// Its meaning with the names that it takes.
    pub fn doc(&self) -> String {
        let doc = self.entry.doc();
        if self.names.is_empty() { doc.to_owned() } else { format!("{doc}. One of {}", self.names.join(", ")) }
    }
}
