//! Checks numbers: one that is not finite is an error, and one outside its range is clamped with a warning.
//! Also reads the raw JSON of extensions that the parser does not know.

use std::ops::RangeInclusive;

use gltf::json;

use super::super::error::Problem;

/// Extensions that the parser does not know, by name.
pub type Extensions = serde_json::Map<String, json::Value>;

/// Maximum length of JSON in a message, in characters.
const LONGEST_QUOTE: usize = 40;

/// Refuses infinity and NaN.
pub fn finite(value: f32, place: &str) -> Result<f32, Problem> {
    if value.is_finite() { Ok(value) } else { Err(Problem::invalid(place, "a finite number", value.to_string())) }
}

/// Clamps a number to its range, with a warning. JSON has no NaN.
pub fn clamp(value: f32, range: RangeInclusive<f32>, place: &str, warnings: &mut Vec<String>) -> f32 {
    let clamped = value.clamp(*range.start(), *range.end());
    if clamped != value {
        warnings.push(format!("{place} is {value}, outside of its range: {clamped} is used."));
    }
    clamped
}

/// An object of raw JSON with its path.
pub struct Fields<'a> {
    object: &'a Extensions,
    /// Path of the object in the file, for messages.
    pub place: String,
}

impl<'a> Fields<'a> {
    /// The member `name` of `parent`, if present. It must be an object.
    pub fn open(parent: &'a Extensions, name: &str, place: &str) -> Result<Option<Self>, Problem> {
        parent.get(name).map(|value| Self::new(value, format!("{place}.{name}"))).transpose()
    }

    /// A value that must be an object.
    pub fn new(value: &'a json::Value, place: String) -> Result<Self, Problem> {
        match value.as_object() {
            Some(object) => Ok(Self { object, place }),
            None => Err(Problem::invalid(place, "an object", quote(value))),
        }
    }

    /// The path of a member, for messages.
    pub fn at(&self, key: &str) -> String {
        format!("{}.{key}", self.place)
    }

    /// A member, if present. It must be an object.
    pub fn open_member(&self, key: &str) -> Result<Option<Self>, Problem> {
        Self::open(self.object, key, &self.place)
    }

    /// The JSON of a member.
    pub fn get(&self, key: &str) -> Option<&'a json::Value> {
        self.object.get(key)
    }

    /// A finite number.
    pub fn number(&self, key: &str, default: f32) -> Result<f32, Problem> {
        match self.get(key) {
            None => Ok(default),
            Some(value) => number(value, &self.at(key)),
        }
    }

    /// Finite numbers.
    pub fn numbers<const N: usize>(&self, key: &str, default: [f32; N]) -> Result<[f32; N], Problem> {
        let Some(value) = self.get(key) else { return Ok(default) };
        let place = self.at(key);
        let Some(values) = value.as_array().filter(|values| values.len() == N) else {
            return Err(Problem::invalid(place, format!("{N} numbers"), quote(value)));
        };
        let mut numbers = default;
        for (to, from) in numbers.iter_mut().zip(values) {
            *to = number(from, &place)?;
        }
        Ok(numbers)
    }

    /// A number in a range, as [`clamp`].
    pub fn clamped(
        &self,
        key: &str,
        default: f32,
        range: RangeInclusive<f32>,
        warnings: &mut Vec<String>,
    ) -> Result<f32, Problem> {
        Ok(clamp(self.number(key, default)?, range, &self.at(key), warnings))
    }

    /// Numbers in a range, as [`clamp`].
    pub fn clamped_all<const N: usize>(
        &self,
        key: &str,
        default: [f32; N],
        range: RangeInclusive<f32>,
        warnings: &mut Vec<String>,
    ) -> Result<[f32; N], Problem> {
        let mut numbers = self.numbers(key, default)?;
        for number in &mut numbers {
            *number = clamp(*number, range.clone(), &self.at(key), warnings);
        }
        Ok(numbers)
    }

    /// A required index.
    pub fn index(&self, key: &str, kind: &str) -> Result<usize, Problem> {
        index(self.get(key), &self.at(key), kind)
    }
}

/// A required index into a list of the file.
pub fn index(value: Option<&json::Value>, place: &str, kind: &str) -> Result<usize, Problem> {
    let found = || value.map_or_else(|| "none".to_owned(), quote);
    value.and_then(whole).ok_or_else(|| Problem::invalid(place, format!("an index into {kind}"), found()))
}

/// A whole number of a type.
pub fn whole<T: TryFrom<u64>>(value: &json::Value) -> Option<T> {
    value.as_u64().and_then(|value| T::try_from(value).ok())
}

fn number(value: &json::Value, place: &str) -> Result<f32, Problem> {
    match value.as_f64() {
        Some(number) => finite(number as f32, place),
        None => Err(Problem::invalid(place, "a number", quote(value))),
    }
}

/// JSON, shortened for a message.
pub fn quote(value: &json::Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
