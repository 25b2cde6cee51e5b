//! Rows of a scrolled panel that are out of sight: they take their place, and cost nothing else.

use egui::{Id, Ui, vec2};

/// Leaves room for the next row of a panel if that is out of sight, as high as it was when it was last shown. Returns whether it has.
///
/// Rows are shown wherever they are while a control has the keyboard, something is dragged, or a screen reader listens.
pub(super) fn skips(ui: &mut Ui) -> bool {
    let Some(height) = ui.data(|data| data.get_temp::<f32>(id(ui))) else { return false };
    let top = ui.cursor().min.y;
    let in_sight = ui.clip_rect().y_range();
    if (top <= in_sight.max && top + height >= in_sight.min) || is_used(ui) {
        return false;
    }
    ui.allocate_space(vec2(ui.available_width(), height));
    true
}

/// Shows the next row, and remembers its height.
pub(super) fn show<T>(ui: &mut Ui, row: impl FnOnce(&mut Ui) -> T) -> T {
    let id = id(ui);
    let response = ui.horizontal(row);
    let height = response.response.rect.height();
    if ui.data(|data| data.get_temp::<f32>(id)) != Some(height) {
        ui.data_mut(|data| data.insert_temp(id, height));
    }
    response.inner
}

fn id(ui: &Ui) -> Id {
    ui.next_auto_id().with("height of the row")
}

/// Whether rows that nobody sees matter: for the order of the keyboard, for a drag that has left its row, for a screen reader.
fn is_used(ui: &Ui) -> bool {
    let egui = ui.ctx();
    egui.memory(|memory| memory.focused().is_some())
        || egui.input(|input| input.pointer.any_down() || input.key_pressed(egui::Key::Tab))
        || egui.accesskit_node_builder(ui.unique_id(), |_| ()).is_some()
}

#[cfg(test)]
mod tests {
    use egui::{Context, Pos2, RawInput, Rect, ScrollArea};

    use super::*;

    #[test]
    fn rows_out_of_sight_take_their_place_and_are_not_shown() {
        let egui = Context::default();
        let mut shown = Vec::new();
        let mut heights = Vec::new();
        for _ in 0..3 {
            let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(200.0, 100.0)));
            let input = RawInput { screen_rect, ..RawInput::default() };
            let mut count = 0;
            let _ = egui.run_ui(input, |ui| {
                let scrolled = ScrollArea::vertical().show(ui, |ui| {
                    for index in 0..100 {
                        if !skips(ui) {
                            count += 1;
                            show(ui, |ui| ui.label(format!("{index}\n")));
                        }
                    }
                });
                heights.push(scrolled.content_size.y);
            });
            shown.push(count);
        }
        assert_eq!(shown[0], 100, "their heights are not known yet");
        assert!((1..10).contains(&shown[2]), "{shown:?}");
        assert!(heights[0] > 1000.0 && (heights[2] - heights[0]).abs() < 1.0, "{heights:?}");
    }
}
