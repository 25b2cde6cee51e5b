//! The cost of a function, behind the first line of its code.

use egui::{Align2, Rect, Sense, Ui, WidgetInfo, WidgetType, pos2};

use crate::app::state::State;
use crate::app::widgets::theme::{QUIET, small_font};
use crate::shader::TreePath;

/// Points between the code and the cost.
const GAP: f32 = 16.0;

/// Shows the cost of the function that begins at a line. `code_end`: where the code of the line ends.
pub(super) fn show(ui: &mut Ui, state: &State, (path, line): (&TreePath, u32), rect: Rect, code_end: f32) {
    let shaders = state.session.shaders.as_ref();
    let Some(cost) = shaders.and_then(|shaders| state.costs.of_line(shaders, path, line)) else { return };
    let share = cost.ms() / state.costs.frame_ms().unwrap_or(f64::INFINITY).max(1e-9);
    let text = match cost.is_significant() {
        true => format!("{} · {:.1} % of the frame", cost.text(), 100.0 * share),
        false => cost.text(),
    };
    let at = pos2(code_end + GAP, rect.center().y);
    let place = ui.painter().text(at, Align2::LEFT_CENTER, &text, small_font(), QUIET.color());
    let response = ui.interact(place, ui.id().with(("cost", line)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, format!("costs {text}")));
    let figures = cost.figures.iter().filter(|figure| figure.change().is_some());
    let figures: Vec<String> = figures
        .map(|figure| {
            format!("{}: {} with it, {} without", figure.name, figure.before.unwrap_or_default(), figure.value)
        })
        .collect();
    response.on_hover_ui(|ui| {
        ui.set_max_width(420.0);
        let calls = f64::from(cost.calls.calls) / f64::from(cost.calls.invocations.max(1));
        ui.label(format!(
            "What the frame saves without {}: {} pairs of frames, drawn in turn with and without it. {:.2} calls where it is called",
            cost.function.signature, cost.difference.pairs, calls
        ));
        figures.iter().for_each(|figure| _ = ui.label(figure));
        ui.label("It includes all that it calls and the code that computes its arguments alone, so costs overlap");
    });
}
