//! The text of a stage that writes the number of a statement in place of a color, and the functions that its statements call.

use std::fmt::Write as _;

use super::types::{FLOATS, OTHERS};
use crate::shader::contract;
use crate::shader::glsl::StageMain;
use crate::shader::source::TreePath;
use crate::shader::source::snapshot::Snapshot;

/// The function that values pass through.
pub(super) const FUNCTION: &str = "trace_finite";
/// Path that replaces the first include of the stage.
pub(super) const LIBRARY: &str = ".not_finite.glsl";
/// The blue channel of a pixel with numbers of statements.
pub(super) const MARK: f32 = 4242.0;

/// The text of the stage, and of the file that it includes first. `text` already calls the functions.
pub(super) fn texts(text: &str, host: &TreePath, snapshot: &Snapshot<'_>) -> Result<(String, String), String> {
    let StageMain { main, color, include } = StageMain::of(text).map_err(|lack| format!("{host} {lack}"))?;
    let found = host.sibling(include.name).filter(|path| snapshot.read(path).is_ok());
    let name = found.map_or(include.name.to_owned(), |path| path.to_string());

    let mut stage = text.to_owned();
    let mut edits = [(main, "traced_main"), (include.bytes, LIBRARY)];
    edits.sort_by_key(|(bytes, _)| std::cmp::Reverse(bytes.start));
    edits.into_iter().for_each(|(bytes, new)| stage.replace_range(bytes, new));
    let _ = write!(
        stage,
        "\nvoid main() {{ traced_main(); {color} = trace_first != 0u ? vec4(trace_first, trace_first_nan, {MARK:?}, 1.0) : vec4(0.0); }}\n"
    );
    let mut library = String::new();
    let interface = TreePath::from(contract::INTERFACE_FILE);
    if snapshot.read(&interface).is_ok() {
        let _ = writeln!(library, "#include \"{interface}\"");
    }
    library += &tracing_functions();
    if name != interface.as_str() {
        let _ = writeln!(library, "#include \"{name}\"");
    }
    Ok((stage, library))
}

/// For each type, a function that returns its value and remembers the first statements that made NaN or infinity.
fn tracing_functions() -> String {
    let mut out = "uint trace_first = 0u;\nuint trace_first_nan = 0u;\n\
        float trace_finite(uint site, float value) {\n    \
        uint bits = floatBitsToUint(value) & 0x7fffffffu;\n    \
        if (bits >= 0x7f800000u && trace_first == 0u) trace_first = site;\n    \
        if (bits > 0x7f800000u && trace_first_nan == 0u) trace_first_nan = site;\n    return value;\n}\n"
        .to_owned();
    for kind in FLOATS.iter().skip(1) {
        let columns = kind.trim_start_matches(|c: char| c.is_ascii_alphabetic()).split('x').next().unwrap_or("1");
        let columns: usize = columns.parse().unwrap_or(1);
        let calls: String = (0..columns).map(|at| format!("{FUNCTION}(site, value[{at}]); ")).collect();
        let _ = writeln!(out, "{kind} {FUNCTION}(uint site, {kind} value) {{ {calls}return value; }}");
    }
    for kind in OTHERS {
        let _ = writeln!(out, "{kind} {FUNCTION}(uint site, {kind} value) {{ return value; }}");
    }
    out
}
