//! Limits of numbers in the settings.

use std::ops::RangeInclusive;

/// A number in the settings with its path and limits.
pub(super) struct Range {
    path: String,
    value: f32,
    limits: RangeInclusive<f32>,
}

impl Range {
    /// One number.
    pub(super) fn new(path: impl Into<String>, value: f32, limits: RangeInclusive<f32>) -> Self {
        Self { path: path.into(), value, limits }
    }

    /// One entry per element of a list.
    pub(super) fn all(path: &str, values: &[f32], limits: RangeInclusive<f32>) -> Vec<Self> {
        let entry = |(i, value): (usize, &f32)| Self::new(format!("{path}.{i}"), *value, limits.clone());
        values.iter().enumerate().map(entry).collect()
    }

    /// Returns a message if the number is out of range or NaN.
    pub(super) fn check(&self) -> Result<(), String> {
        let Self { path, value, limits } = self;
        if limits.contains(value) {
            return Ok(());
        }
        Err(format!("{path} is {value}; it can be {} to {}", limits.start(), limits.end()))
    }
}
