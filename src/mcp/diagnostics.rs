//! Messages of the compiler as text, with the line and its caret.

use serde_json::Value;

use crate::shader::{Diagnostic, Severity};

/// All diagnostics as text.
pub fn text_of(diagnostics: &[Value]) -> String {
    diagnostics.iter().map(|fields| diagnostic(fields).full()).collect::<Vec<_>>().join("\n")
}

/// Whether one of them is an error.
pub fn has_errors(diagnostics: &[Value]) -> bool {
    diagnostics.iter().any(|fields| diagnostic(fields).severity == Severity::Error)
}

/// The diagnostic that an answer describes.
fn diagnostic(fields: &Value) -> Diagnostic {
    let text = |field: &str| fields[field].as_str().map(str::to_owned);
    let number = |field: &str| fields[field].as_u64().and_then(|number| u32::try_from(number).ok());
    let notes = fields["notes"].as_array().into_iter().flatten().filter_map(Value::as_str);
    Diagnostic {
        severity: if fields["severity"] == "warning" { Severity::Warning } else { Severity::Error },
        file: text("file").unwrap_or_default(),
        line: number("line"),
        // Positions count from 1.
        column: number("column").filter(|column| *column > 0),
        length: number("length").unwrap_or(0),
        message: text("message").unwrap_or_default(),
        excerpt: text("excerpt"),
        help: text("help"),
        notes: notes.map(str::to_owned).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagnostic_survives_its_way_as_json() {
        let found = Diagnostic::error("brdf/ndf.glsl", "'aplha' : undeclared identifier")
            .on_line(20, Some("    float a2 = aplha * alpha;"))
            .under(15..20)
            .with_help("did you mean `alpha`?")
            .with_note("included by pbr.frag");
        let json = serde_json::to_value(&found).unwrap();
        assert_eq!(diagnostic(&json), found);
        assert!(has_errors(std::slice::from_ref(&json)));
        let text = text_of(&[json]);
        assert!(text.starts_with("brdf/ndf.glsl:20:16: error: ") && text.contains("^^^^^"), "{text}");
    }
}
