//! Check boxes of the panels: squares with an outline in both themes. Those of egui have the shape of its buttons, which in a small box
//! looks like a radio button.

use egui::{Checkbox, CornerRadius, Response, Stroke, Ui};

use super::theme::{ACCENT, CARD, QUIET};

/// Radius of the corners, and width of the check mark, in points.
const RADIUS: u8 = 2;
const MARK: f32 = 1.6;

/// Shows a check box.
pub(in crate::app) fn show(ui: &mut Ui, check_box: Checkbox<'_>) -> Response {
    ui.scope(|ui| {
        let widgets = &mut ui.visuals_mut().widgets;
        let [inactive, hovered, active] = [&mut widgets.inactive, &mut widgets.hovered, &mut widgets.active];
        for (widget, line) in [(inactive, QUIET), (hovered, ACCENT), (active, ACCENT)] {
            widget.corner_radius = CornerRadius::same(RADIUS);
            widget.bg_fill = CARD.color();
            widget.bg_stroke = Stroke::new(1.0, line);
            widget.fg_stroke.width = MARK;
        }
        ui.add(check_box)
    })
    .inner
}
