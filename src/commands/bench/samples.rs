//! Times in milliseconds, and what is reported of many.

use std::time::Instant;

use serde_json::{Value, json};

pub(super) fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

pub(super) fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// Minimum, median and 95th percentile; null without samples. On a shared machine, compare the minimum, since other work can
/// only add time.
pub(super) fn summary(mut values: Vec<f64>) -> Value {
    values.sort_by(f64::total_cmp);
    let at = |part: f64| values.get(((values.len() as f64 - 1.0).max(0.0) * part).round() as usize).copied();
    match (at(0.0), at(0.5), at(0.95)) {
        (Some(min), Some(median), Some(p95)) => {
            json!({ "min": round(min), "median": round(median), "p95": round(p95) })
        }
        _ => Value::Null,
    }
}
