//! Values of settings, whatever their type.

use std::fmt;

/// A value of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// No value: the setting has an effect only when it is set.
    Unset,
    /// `true` or `false`.
    Switch(bool),
    /// A number.
    Number(f32),
    /// A whole number.
    Whole(u32),
    /// Three numbers.
    Numbers([f32; 3]),
    /// A text or a name.
    Text(String),
    /// A list of names.
    Names(Vec<String>),
}

/// The value as `--set` takes it.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unset => Ok(()),
            Self::Switch(on) => on.fmt(f),
            Self::Number(number) => number.fmt(f),
            Self::Whole(number) => number.fmt(f),
            Self::Numbers([x, y, z]) => write!(f, "{x},{y},{z}"),
            Self::Text(text) => f.write_str(text),
            Self::Names(names) => f.write_str(&names.join(",")),
        }
    }
}

impl Value {
    /// Whether it is this value as `--set` takes it, or a list that has this name.
    pub(super) fn is(&self, text: &str) -> bool {
        match self {
            Self::Names(names) => names.iter().any(|name| name == text),
            value => value.to_string() == text,
        }
    }
}
