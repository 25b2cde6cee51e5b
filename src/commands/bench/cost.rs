//! `specula bench cost`: what each function of a stage costs.

use serde_json::{Value, json};
use specula::message::grouped;

use super::context::Bench;
use crate::commands::Failure;
use crate::commands::common::check_mode;

/// Columns of a function's name.
const NAME: usize = 44;

/// Draws the picture with and without each function of a stage.
pub(super) fn cost(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let (source, settings) = (args.common.source()?, args.common.settings()?);
    let slug = settings.mode.clone();
    let mut headless = bench.renderer(source, settings, bench.model()?)?;
    check_mode(&headless.shaders(), &slug)?;
    bench.progress.say("recording what functions return");
    let mut begin = |at: usize, of: usize, name: &str| bench.progress.begin("function", (at, of), name);
    let wanted = (args.stage.as_deref(), args.function.as_slice());
    let mut result = headless.costs(wanted, args.samples as usize, &mut begin)?.json();
    let name = result["stage"].as_str().map(|stage| headless.shaders().name_of(stage).to_owned());
    result["name"] = json!(name);
    (result["size"], result["mode"]) = (json!([args.common.size().0, args.common.size().1]), json!(slug));
    Ok(result)
}

/// Prints the costs as a table.
pub(super) fn print(result: &Value) {
    let number = |value: &Value| value.as_f64().unwrap_or_default();
    out!(
        "{}: {:.3} ms of {:.3} ms a frame on {}, {} invocations\n",
        result["name"].as_str().unwrap_or_default(),
        number(&result["stage_ms"]),
        number(&result["frame_ms"]),
        result["device"].as_str().unwrap_or_default(),
        grouped(number(&result["invocations"]))
    );
    let place = |of: &Value| format!("{}:{}", of["file"].as_str().unwrap_or_default(), of["line"]);
    let name = |of: &Value| of["name"].as_str().unwrap_or_default().to_owned();
    out!("{:<NAME$}  {:>9}  {:>9}  {:>7}  {:>9}  figures", "function", "ms", "± ms", "frame", "calls");
    for of in result["functions"].as_array().into_iter().flatten() {
        let (ms, margin) = (number(&of["ms"]), number(&of["margin_ms"]));
        // A difference that is not significant is told by its bound.
        let [ms, share] = match of["significant"].as_bool().unwrap_or_default() {
            true => [format!("{ms:.3}"), format!("{:.1} %", 100.0 * number(&of["share"]))],
            false => [format!("< {:.3}", ms.max(0.0) + margin), "0 %".to_owned()],
        };
        let calls = number(&of["calls_per_invocation"]);
        out!(
            "{:<NAME$}  {ms:>9}  {margin:>9.3}  {share:>7}  {calls:>9.2}  {}\n  {}",
            name(of),
            figures(&of["figures"]),
            place(of)
        );
    }
    let left_out: Vec<&Value> = result["not_measured"].as_array().into_iter().flatten().collect();
    if !left_out.is_empty() {
        out!("\nnot measured");
        left_out
            .iter()
            .for_each(|of| out!("  {}, {}: {}", name(of), place(of), of["reason"].as_str().unwrap_or_default()));
    }
}

/// The figures of the stage that change without the function, as `registers 96 -> 104`: with it, and without it.
fn figures(figures: &Value) -> String {
    let changed = figures.as_object().into_iter().flatten().filter_map(|(name, of)| {
        let (with, without) = (of["with"].as_f64()?, of["without"].as_f64()?);
        (with != without).then(|| format!("{name} {} -> {}", grouped(with), grouped(without)))
    });
    changed.collect::<Vec<_>>().join(", ")
}
