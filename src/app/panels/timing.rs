//! The panel Timing: device time of each pass with its history, what the last edit has changed, the CPU's time, memory and counts. The
//! graphs go from frame to frame, and a window that rests draws none.

mod graph;
mod table;

use egui::{Grid, Label, RichText, Ui};

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::State;
use crate::app::widgets::rows::elided;
use crate::app::widgets::theme::{GOOD, QUIET, Tone, WARNING};
use crate::gpu::MemoryUse;
use crate::message::grouped;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Timing", Group::Shaders, "GPU ms frame time memory", || Box::new(ui));

/// Time that the panels may take in a frame, milliseconds.
const UI_LIMIT_MS: f64 = 2.0;

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    commands.sight.timing = true;
    let Context { state, readings, .. } = context;
    let device = &state.device;
    ui.add(elided(RichText::new(device).small().color(QUIET))).on_hover_text(device);
    let timing = &state.timing;
    let names = table::names(timing);
    graph::passes(ui, state, &names);
    table::show(ui, timing, &names);
    cost(ui, state);
    cpu(ui, state);
    counts(ui, state, readings.pipelines);
    readings.memory.into_iter().for_each(|used| memory(ui, used));
}

/// Describes the cost of the last edit in frame time, in a sentence.
fn cost(ui: &mut Ui, state: &State) {
    let Some(cost) = state.timing.cost() else {
        let text = "The cost of your next edit will appear here";
        ui.label(RichText::new(text).small().color(QUIET));
        return;
    };
    let change = cost.rows.first().and_then(|row| row.change());
    let (text, color) = match (change, cost.slower()) {
        (Some(ms), Some((row, by))) if ms > 0.0 => {
            (format!("The last edit costs {ms:+.2} ms a frame: {} {by:+.2} ms", row.name), WARNING)
        }
        (Some(ms), _) if ms < 0.0 => (format!("The last edit saves {:.2} ms a frame", -ms), GOOD),
        (_, Some((row, by))) => (format!("The last edit slows {} down by {by:.2} ms", row.name), WARNING),
        _ => ("The last edit costs no time".to_owned(), QUIET),
    };
    let [before, after] = cost.generations.map(|generation| state.version_name(generation));
    let [frames_before, frames_after] = cost.frames;
    ui.add(Label::new(RichText::new(text).small().color(color)).wrap()).on_hover_text(format!(
        "Medians of {frames_before} frames of {before} and {frames_after} of {after}, of the same mode, \
         size and model. Less than 5 % or 0.02 ms counts as noise"
    ));
}

/// The CPU time of the last frames.
fn cpu(ui: &mut Ui, state: &State) {
    graph::cpu(ui, &state.timing, UI_LIMIT_MS);
    let Some(last) = state.timing.frames().back() else { return };
    let (frames, [summary, whole]) = state.timing.recent_summary();
    Grid::new("cpu").num_columns(2).spacing([10.0, 1.0]).show(ui, |ui| {
        let hint = format!(
            "CPU time to lay out and tessellate the panels in the last frame. Over {} frames: median {:.2}, 95th percentile \
             {:.2}, maximum {:.2} ms. The budget is {UI_LIMIT_MS} ms",
            grouped(frames as f64),
            summary.median,
            summary.p95,
            summary.max
        );
        let color = if summary.p95 > UI_LIMIT_MS { WARNING } else { graph::UI };
        row(ui, ("Panels", color), &format!("{:.2} ms", last.ui_ms), &hint);
        let hint = "CPU time to record the commands of the last frame, without waiting for the device";
        row(ui, ("Recording", graph::RECORD), &format!("{:.2} ms", last.record_ms), hint);
        if let Some(ms) = state.timing.cpu_ms() {
            let hint = format!(
                "CPU time of the window's thread for all of the last frame, without the driver's time to present it. Median {:.2}, \
                 95th percentile {:.2}, maximum {:.2} ms",
                whole.median, whole.p95, whole.max
            );
            row(ui, ("Thread", QUIET), &format!("{ms:.2} ms"), &hint);
        }
    });
}

fn row(ui: &mut Ui, (name, color): (&str, Tone), value: &str, hint: &str) {
    ui.label(RichText::new(name).small().color(color)).on_hover_text(hint);
    ui.label(RichText::new(value).monospace().small()).on_hover_text(hint);
    ui.end_row();
}

/// Shows the counts of draws, triangles and pipelines.
fn counts(ui: &mut Ui, state: &State, pipelines: usize) {
    let counts = state.timing.pictures().back().map(|sample| sample.counts).unwrap_or_default();
    Grid::new("counts").num_columns(2).spacing([10.0, 1.0]).show(ui, |ui| {
        let all = [
            ("Draws", counts.draws, "Draws of the last picture in all of its passes, without the panels"),
            ("Triangles", counts.triangles, "Triangles in these draws, over all instances and passes"),
            ("Pipelines", pipelines as u64, "Pipelines kept for the newest 64 pictures, for bakes and for thumbnails"),
        ];
        for (name, value, hint) in all {
            row(ui, (name, QUIET), &grouped(value as f64), hint);
        }
    });
}

/// Memory of the device and of the process.
fn memory(ui: &mut Ui, (device, process): (&MemoryUse, Option<u64>)) {
    let mib = |bytes: u64| format!("{} MiB", grouped((bytes as f64 / f64::from(1 << 20)).round()));
    Grid::new("memory").num_columns(2).spacing([10.0, 1.0]).show(ui, |ui| {
        let hint = "Memory of images and buffers, and of the blocks that Specula's allocator has reserved for them";
        row(ui, ("Device memory", QUIET), &format!("{} of {}", mib(device.used), mib(device.reserved)), hint);
        for heap in &device.heaps {
            let name = if heap.is_device { "Device heap" } else { "Host heap" };
            let (value, hint) = match heap.used_of {
                Some([used, budget]) => (
                    format!("{} of {}", mib(used), mib(budget)),
                    "What this process uses and what it may use, as reported by the driver (VK_EXT_memory_budget)",
                ),
                None => (mib(heap.size), "Size of the heap. This driver does not report how much is in use"),
            };
            row(ui, (name, QUIET), &value, hint);
        }
        if let Some(bytes) = process {
            row(
                ui,
                ("Process", QUIET),
                &mib(bytes),
                "Resident memory of Specula. On a software device this is device memory too",
            );
        }
    });
}
