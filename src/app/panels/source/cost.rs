//! The cost of a function, behind the first line of its code.

use egui::{Rect, Sense, Ui, WidgetInfo, WidgetType};

use crate::app::state::State;
use crate::headless::FunctionCost;
use crate::shader::TreePath;

/// The cost of the function that begins at a line, in words.
pub(super) fn text_of<'a>(state: &'a State, path: &TreePath, line: u32) -> Option<(&'a FunctionCost, String)> {
    let shaders = state.session.shaders.as_ref()?;
    let cost = state.costs.of_line(shaders, path, line)?;
    let share = cost.ms() / state.costs.frame_ms().unwrap_or(f64::INFINITY).max(1e-9);
    let text = match cost.is_significant() {
        true => format!("{} · {:.1} % of the frame", cost.text(), 100.0 * share),
        false => cost.text(),
    };
    Some((cost, text))
}

/// Shows the cost of the function that begins at a line. `place`: where its text stands.
pub(super) fn show(ui: &mut Ui, (cost, text): (&FunctionCost, &str), line: u32, place: Rect) {
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
