//! The mark before a goal or an exercise.

use egui::Ui;

use crate::app::widgets::theme::{ERROR, GOOD, QUIET};

/// A mark before a goal or an exercise: a ring, a check in green or a cross in red.
pub(super) fn mark(ui: &mut Ui, state: Option<bool>) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(16.0, 18.0), egui::Sense::hover());
    paint_mark(ui.painter(), rect.center(), state);
}

/// Draws the mark around a point.
pub(super) fn paint_mark(painter: &egui::Painter, center: egui::Pos2, state: Option<bool>) {
    let line = |points: &[(f32, f32)], color| {
        let points = points.iter().map(|(x, y)| center + egui::vec2(*x, *y)).collect();
        painter.add(egui::Shape::line(points, egui::Stroke::new(2.0, color)));
    };
    match state {
        None => _ = painter.circle_stroke(center, 4.5, egui::Stroke::new(1.5, QUIET)),
        Some(true) => line(&[(-5.0, 0.5), (-1.5, 4.0), (5.0, -4.0)], GOOD),
        Some(false) => {
            line(&[(-4.0, -4.0), (4.0, 4.0)], ERROR);
            line(&[(-4.0, 4.0), (4.0, -4.0)], ERROR);
        }
    }
}
