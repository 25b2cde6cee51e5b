//! The row of the panel Output that says which values are black and white.

use egui::{DragValue, Ui};

use crate::app::widgets::rows::{choose, special};
use crate::app::widgets::spoken::named;
use crate::settings::{Settings, ViewRange};

/// Shows the rows of the range: the choice, and both ends where the user sets them.
pub(in crate::app::panels) fn show(ui: &mut Ui, settings: &mut Settings) {
    special(ui, settings, "view.range", |ui, settings| {
        let range = &mut settings.view.range;
        let name = match &*range {
            ViewRange::Fixed(..) => "set".to_owned(),
            range => range.to_string(),
        };
        choose(ui, "range", name, |ui| {
            for choice in [ViewRange::Auto, ViewRange::Mode, ViewRange::Fit] {
                ui.selectable_value(range, choice, choice.to_string());
            }
            let is_set = matches!(*range, ViewRange::Fixed(..));
            if ui.selectable_label(is_set, "set").clicked() && !is_set {
                *range = ViewRange::Fixed(0.0, 1.0);
            }
        })
    });
    let view = &mut settings.view;
    let ViewRange::Fixed(mut low, mut high) = view.range else { return };
    ui.horizontal(|ui| {
        let speed = f64::from(high - low) / 200.0;
        let first = ui.add(DragValue::new(&mut low).speed(speed).prefix("from ").max_decimals(4));
        let last = ui.add(DragValue::new(&mut high).speed(speed).prefix("to ").max_decimals(4));
        named(first, "Black").on_hover_text("The value that is black");
        named(last, "White").on_hover_text("The value that is white");
    });
    if low < high {
        view.range = ViewRange::Fixed(low, high);
    }
}
