//! Numbers with their limits.

use std::ops::RangeInclusive;

use super::told;

/// A number of the settings with its path and limits.
pub(super) struct Range {
    pub(super) path: String,
    value: f32,
    pub(super) limits: RangeInclusive<f32>,
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

    /// Refuses a number outside of its limits, and NaN.
    pub(super) fn check(&self) -> Result<(), String> {
        let Self { path, value, limits } = self;
        if limits.contains(value) {
            return Ok(());
        }
        Err(format!("{path} is {value}; it can be {}", told(limits)))
    }
}
