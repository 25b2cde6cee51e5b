//! Edits of a shader tree that change no pixel, and the compilation behind them.

use specula::headless::Headless;
use specula::pipeline::Outcome;

use crate::commands::Failure;

/// The text of a shader file with an edit that does not change the picture: a stage discards fragments with a negative x, of
/// which there are none, and a library gets a function that nothing calls.
pub(super) fn edited(text: &str, number: u32) -> String {
    const MAIN: &str = "void main() {";
    if text.contains(MAIN) {
        return text.replacen(MAIN, &format!("{MAIN}\n    if (gl_FragCoord.x < -{number}.0) discard;"), 1);
    }
    let end = text.rfind("#endif").unwrap_or(text.len());
    format!("{}float bench_edit(float x) {{ return x + {number}.0; }}\n{}", &text[..end], &text[end..])
}

/// Compiles what the frame did not need.
pub(super) fn finish(headless: &mut Headless) -> Result<(), Failure> {
    match headless.finish().map(|reload| reload.outcome) {
        Some(Outcome::Failed(diagnostics)) => Err(Failure::Shaders(diagnostics)),
        _ => Ok(()),
    }
}
