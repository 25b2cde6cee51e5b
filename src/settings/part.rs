//! Settings and groups of settings as values that are found by their path.

use std::collections::BTreeMap;

use clap::ValueEnum;

use super::entry::Entry;
use super::setting::Setting;
use super::value::Value;

/// The type of a setting.
pub(super) trait SettingType {
    /// The values that it takes, in words.
    const TAKES: &'static str;

    /// The names that it takes if it takes nothing else.
    fn names() -> Vec<String> {
        Vec::new()
    }

    fn value(&self) -> Value;

    /// Takes a value; one of another type changes nothing.
    fn set(&mut self, value: &Value);
}

/// A part of the settings: one setting, or a group of them.
pub(super) trait Part {
    /// Adds its settings to `list`. `path` and `entry` are those of the part itself.
    fn list(&self, path: &str, entry: &'static Entry, list: &mut Vec<Setting>);

    /// The value at a path below this part; an empty path is the part itself.
    fn at(&self, path: &str) -> Option<Value>;

    /// Sets the value at a path below this part.
    fn set_at(&mut self, path: &str, value: &Value);
}

impl<T: SettingType> Part for T {
    fn list(&self, path: &str, entry: &'static Entry, list: &mut Vec<Setting>) {
        let (path, default) = (path.to_owned(), self.value());
        list.push(Setting { path, entry, takes: T::TAKES, names: T::names(), default });
    }

    fn at(&self, path: &str) -> Option<Value> {
        match self.value() {
            value if path.is_empty() => Some(value),
            Value::Numbers(numbers) => numbers.get(path.parse::<usize>().ok()?).copied().map(Value::Number),
            _ => None,
        }
    }

    fn set_at(&mut self, path: &str, value: &Value) {
        match (self.value(), path.parse::<usize>(), value) {
            (Value::Numbers(mut numbers), Ok(index), Value::Number(number)) if index < numbers.len() => {
                numbers[index] = *number;
                self.set(&Value::Numbers(numbers));
            }
            _ if path.is_empty() => self.set(value),
            _ => {}
        }
    }
}

/// Values by names that the user gives: no settings of their own.
impl<V> Part for BTreeMap<String, V> {
    fn list(&self, _: &str, _: &'static Entry, _: &mut Vec<Setting>) {}

    fn at(&self, _: &str) -> Option<Value> {
        None
    }

    fn set_at(&mut self, _: &str, _: &Value) {}
}

/// Implements [`SettingType`] for a type that a variant of [`Value`] holds.
macro_rules! kinds {
    ($($kind:ty, $takes:literal, $variant:ident;)+) => {
        $(impl SettingType for $kind {
            const TAKES: &'static str = $takes;

            fn value(&self) -> Value {
                Value::$variant(self.clone())
            }

            fn set(&mut self, value: &Value) {
                if let Value::$variant(value) = value {
                    self.clone_from(value);
                }
            }
        })+
    };
}

kinds! {
    bool, "true or false", Switch;
    f32, "number", Number;
    u32, "whole number", Whole;
    [f32; 3], "3 numbers", Numbers;
    String, "text", Text;
    Vec<String>, "names", Names;
}

impl SettingType for Option<[f32; 3]> {
    const TAKES: &'static str = <[f32; 3]>::TAKES;

    fn value(&self) -> Value {
        self.map_or(Value::Unset, Value::Numbers)
    }

    fn set(&mut self, value: &Value) {
        match value {
            Value::Unset => *self = None,
            Value::Numbers(numbers) => *self = Some(*numbers),
            _ => {}
        }
    }
}

/// A type with a fixed list of names.
pub(super) trait Choice: ValueEnum {}

impl<T: Choice> SettingType for T {
    const TAKES: &'static str = "name";

    fn names() -> Vec<String> {
        T::value_variants().iter().map(choice_name).collect()
    }

    fn value(&self) -> Value {
        Value::Text(choice_name(self))
    }

    fn set(&mut self, value: &Value) {
        if let Value::Text(name) = value
            && let Ok(choice) = T::from_str(name, false)
        {
            *self = choice;
        }
    }
}

/// The name of a choice on the command line.
pub fn choice_name(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}
