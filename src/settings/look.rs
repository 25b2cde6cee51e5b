//! Look files: settings as TOML.

use std::fmt;

use super::Settings;
use crate::message::did_you_mean;

/// Why a look file was not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LookError {
    /// Line and column, counted from 1; `None` when the parser names no place.
    pub place: Option<(usize, usize)>,
    /// The fault, the expected value, and the nearest name.
    pub message: String,
    /// The line of the file.
    pub excerpt: Option<String>,
    /// Whether the file is TOML, but has a name or a value that no setting has.
    pub is_value: bool,
}

impl fmt::Display for LookError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((line, column)) = self.place {
            write!(f, "{line}:{column}: ")?;
        }
        f.write_str(&self.message)?;
        match &self.excerpt {
            Some(excerpt) => write!(f, "\n    {}", excerpt.trim()),
            None => Ok(()),
        }
    }
}

impl std::error::Error for LookError {}

impl Settings {
    /// Reads a look file. The values are not checked against their ranges; see [`Settings::check`].
    ///
    /// # Errors
    /// TOML that does not parse, a name that does not exist, or a value of the wrong kind.
    pub fn from_toml(text: &str) -> Result<Self, LookError> {
        toml::from_str(text).map_err(|error| {
            let is_value = toml::from_str::<toml::Table>(text).is_ok();
            let before = error.span().and_then(|span| text.get(..span.start));
            let line_of = |before: &str| before.bytes().filter(|byte| *byte == b'\n').count();
            let column_of = |before: &str| before.rsplit('\n').next().unwrap_or_default().chars().count();
            LookError {
                place: before.map(|before| (line_of(before) + 1, column_of(before) + 1)),
                message: explain(error.message()),
                excerpt: before.and_then(|before| text.lines().nth(line_of(before))).map(str::to_owned),
                is_value,
            }
        })
    }

    /// Whether a text may be meant as a look file: it names a setting, or is no TOML, as a look with a mistake.
    pub fn may_be_toml(text: &str) -> bool {
        let own = toml::Table::try_from(Self::default()).unwrap_or_default();
        let table = toml::from_str::<toml::Table>(text);
        // Lists that are empty are not in the table of defaults.
        let is_own = |key: &String| own.contains_key(key) || ["added", "bookmarks"].contains(&key.as_str());
        table.map_or(true, |table| table.keys().any(is_own))
    }

    /// The settings as a look file.
    pub fn to_toml(&self) -> String {
        toml::to_string_pretty(self).unwrap_or_default()
    }
}

/// serde's message in the words of this program: settings instead of fields, kinds of values instead of Rust's types.
fn explain(message: &str) -> String {
    let quoted = |text: &str| text.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    for (prefix, what) in [("unknown field", "unknown setting"), ("unknown variant", "unknown name")] {
        let Some(rest) = message.strip_prefix(prefix) else { continue };
        let names = quoted(rest);
        let Some((typed, known)) = names.split_first() else { continue };
        let hint = did_you_mean(typed, known.iter().map(String::as_str));
        return format!("{what} `{typed}`.{hint} It can be {}", known.join(", "));
    }
    let kinds = [("expected f32", "expected a number"), ("expected u32", "expected a whole number, 0 or more")];
    kinds.iter().fold(message.to_owned(), |message, (rust, plain)| message.replace(rust, plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_file_that_is_wrong_is_explained_with_its_place() {
        for (text, is_value, told) in [
            ("[view]\nevv = 1\n", true, "2:1: unknown setting `evv`. Did you mean `ev`? It can be ev, tonemap, "),
            ("[view]\nev = 'x'", true, "2:6: invalid type: string \"x\", expected a number\n    ev = 'x'"),
            ("[view]\ntonemap = 'acess'", true, "2:11: unknown name `acess`. Did you mean `aces`? It can be none, "),
            ("[view\nev = 1", false, "1:6: "),
        ] {
            let error = Settings::from_toml(text).unwrap_err();
            assert_eq!(error.is_value, is_value, "{error}");
            assert!(error.to_string().starts_with(told), "{error}");
        }
    }
}
