//! How commands print results and errors.

use specula::message::{print_error, print_output, tell};
use specula::shader::Diagnostic;

/// Says how many modes of random paths a command has left out.
pub fn tell_left_out(count: usize) {
    match count {
        0 => {}
        1 => tell("left out 1 mode of random paths; add --paths, or name it with --mode"),
        _ => tell(format_args!("left out {count} modes of random paths; add --paths, or name them with --mode")),
    }
}

/// Prints a value as indented JSON. serde escapes ASCII control characters; the others, which some terminals obey too, are escaped
/// here.
pub fn print_json(value: &impl serde::Serialize) {
    let text = serde_json::to_string_pretty(value).unwrap_or_default();
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\u{7f}'..='\u{9f}' => out.push_str(&format!("\\u{:04x}", u32::from(c))),
            c => out.push(c),
        }
    }
    print_output(&out);
}

/// Prints diagnostics to stderr: `file:line: error: message`, which editors parse, then the source line with its caret.
pub fn print_diagnostics(diagnostics: &[Diagnostic]) {
    for diagnostic in diagnostics {
        print_error(diagnostic.full());
    }
}
