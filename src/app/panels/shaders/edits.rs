//! The last edits: which file reached which stages, and how long each step took.

use egui::{RichText, ScrollArea, Ui};

use crate::app::state::shaders::log::{ShaderLog, lines, reached};
use crate::app::widgets::rows::elided;
use crate::app::widgets::theme::{ERROR, QUIET};
use crate::events::in_short;

/// Height of a line, in points.
const HEIGHT: f32 = 15.0;

pub(super) fn show(ui: &mut Ui, log: &ShaderLog) {
    let hint = "Times: compile + pipelines + first frame";
    ui.label(RichText::new(hint).small().color(QUIET));
    let edits: Vec<_> = log.edits().collect();
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, HEIGHT, edits.len(), |ui, range| {
        for edit in &edits[range] {
            let at = edit.at.format("%H:%M:%S");
            // A narrow column truncates the end, and the times matter most.
            let text = RichText::new(format!("{at}  {}  {}", edit.times(), reached(&edit.reload))).monospace().small();
            let text = if edit.reload.ok { text } else { text.color(ERROR) };
            let (_, _, mut hover) = lines(&edit.reload);
            if let Some(rest) = &edit.rest {
                hover +=
                    &format!("\nThen, behind the picture: {} in {:.0} ms", in_short(&rest.stages), rest.compile_ms);
            }
            ui.add(elided(text)).on_hover_text(hover);
        }
    });
}
