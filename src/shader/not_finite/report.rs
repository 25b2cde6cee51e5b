//! The result of a search as text and JSON.

use serde_json::{Value, json};

use super::FirstNotFinite;
use crate::shader::{Mode, PixelValue, expression};

/// The result of a search for the first statement that computes NaN or infinity in a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct NotFinite {
    /// Slug of the mode.
    pub mode: String,
    /// The statement; `None` if the stage of the mode computes neither, or a message.
    pub found: Result<Option<FirstNotFinite>, String>,
}

/// Why a search has no result.
pub const ELSEWHERE: &str =
    "no statement of the stage makes it at this pixel: look at passes after the model and random paths";

impl NotFinite {
    /// The mode to search in, if one of these values is not finite: the final picture, or else the first. The stage of a watched
    /// expression is not searched.
    pub fn mode_of<'a, 'b>(values: impl Iterator<Item = (&'a Mode, &'b PixelValue)>) -> Option<&'a Mode> {
        let is_broken = |(mode, value): &(&Mode, &PixelValue)| value.not_finite && mode.slug != expression::MODE;
        let mut broken = values.filter(is_broken).map(|(mode, _)| mode).peekable();
        let first = broken.peek().copied();
        broken.find(|mode| mode.id == crate::interface::MODE_FINAL).or(first)
    }

    /// One line, or two if infinity came before NaN.
    pub fn text(&self) -> String {
        let mode = &self.mode;
        match &self.found {
            Ok(Some(found @ FirstNotFinite { first, value, nan, .. })) => {
                let components = found.components();
                let mut text =
                    format!("first {value} in {mode}: {}:{}: {}{components}", first.file, first.line, first.code);
                if let Some(nan) = nan {
                    text += &format!("\nfirst NaN in {mode}: {}:{}: {}", nan.file, nan.line, nan.code);
                }
                text
            }
            Ok(None) => format!("NaN or Inf in {mode}: {ELSEWHERE}"),
            Err(message) => format!("NaN or Inf in {mode}: {message}"),
        }
    }

    /// The mode and the place, code and value of the statement; or a message.
    pub fn json(&self) -> Value {
        let mut out = match &self.found {
            Ok(Some(found)) => serde_json::to_value(found).unwrap_or_default(),
            Ok(None) => json!({ "message": ELSEWHERE }),
            Err(message) => json!({ "message": message }),
        };
        out["mode"] = json!(self.mode);
        out
    }
}
