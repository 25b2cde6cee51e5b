//! Values and paths in answers.

use std::path::{Path, PathBuf};

use serde_json::Value;

/// A value for an answer. Floats have the fewest digits that name them: 0.3, not 0.30000001192092896.
pub(in crate::app) fn short(value: impl serde::Serialize) -> Value {
    serde_json::to_string(&value).and_then(|text| serde_json::from_str(&text)).unwrap_or_default()
}

/// A path for an answer: absolute.
pub(in crate::app) fn path_text(path: &Path) -> String {
    std::path::absolute(path).unwrap_or_else(|_| PathBuf::from(path)).display().to_string()
}
