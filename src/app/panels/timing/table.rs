//! The passes with their last time, their history, and the change by the last edit.

use egui::{Grid, RichText, Sense, Ui, vec2};

use super::graph;
use crate::app::state::timing::Timing;
use crate::app::widgets::theme::{GOOD, QUIET, TEXT, WARNING};

/// Size of the history of a pass, in points.
const HISTORY: egui::Vec2 = vec2(60.0, 12.0);
/// A narrower panel hides the history beside the numbers, in points.
const ROOM_FOR_HISTORY: f32 = 250.0;

/// The names of the passes of the last picture, in the order in which they began.
pub(super) fn names(timing: &Timing) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for pass in timing.pictures().back().iter().flat_map(|sample| &sample.passes) {
        if !names.contains(&pass.name) {
            names.push(pass.name.clone());
        }
    }
    names
}

pub(super) fn show(ui: &mut Ui, timing: &Timing, names: &[String]) {
    let Some(last) = timing.pictures().back() else { return };
    let cost = timing.cost();
    let has_history = ui.available_width() >= ROOM_FOR_HISTORY;
    Grid::new("passes").num_columns(4).spacing([8.0, 1.0]).show(ui, |ui| {
        let whole =
            std::iter::once(("Whole frame", None)).chain(names.iter().enumerate().map(|(i, n)| (n.as_str(), Some(i))));
        for (name, place) in whole {
            let color = place.map_or(TEXT.color(), graph::color);
            ui.horizontal(|ui| {
                let (rect, _) = ui.allocate_exact_size(vec2(8.0, 8.0), Sense::hover());
                ui.painter().rect_filled(rect, 1.0, color);
                let hint = match place {
                    Some(_) => "Device time from the end of all earlier commands to the end of the pass",
                    None => "Device time of the last frame in which the picture was drawn, with the panels",
                };
                ui.label(RichText::new(name).small()).on_hover_text(hint);
            });
            let is_kept = last.passes.iter().any(|pass| pass.name == name && pass.kept);
            let ms = if place.is_some() { last.pass_ms(name).unwrap_or_default() } else { last.device_ms };
            match is_kept {
                true => ui
                    .label(RichText::new(format!("{:>9}", "kept")).monospace().small().color(QUIET))
                    .on_hover_text("Not drawn, because nothing that it reads has changed"),
                false => ui.label(RichText::new(format!("{ms:6.2} ms")).monospace().small()),
            };
            if has_history {
                let of = |sample: &crate::app::state::timing::Sample| match place {
                    Some(_) => sample.pass_ms(name).unwrap_or_default(),
                    None => sample.device_ms,
                };
                let values: Vec<f64> = timing.pictures().iter().map(of).collect();
                let most = values.iter().copied().fold(0.0, f64::max);
                graph::sparkline(ui, &values, color, HISTORY)
                    .on_hover_text(format!("The last {} frames; at most {most:.2} ms", values.len()));
            }
            let row = cost.as_ref().and_then(|cost| cost.rows.iter().find(|row| row.name == name));
            if let Some((row, change)) = row.and_then(|row| Some((row, row.change()?))) {
                let color = if change > 0.0 { WARNING } else { GOOD };
                let text = |ms: Option<f64>| ms.map_or("none".to_owned(), |ms| format!("{ms:.2} ms"));
                ui.label(RichText::new(format!("{change:+.2}")).monospace().small().color(color)).on_hover_text(
                    format!("Change by the last edit: {} before, {} after", text(row.before), text(row.after)),
                );
            }
            ui.end_row();
        }
    });
}
