//! A color of linear RGB: a picker with linear numbers, and a field with its code `#rrggbb`, which is sRGB.

use egui::{Response, Rgba, TextEdit, Ui};

use super::spoken::named;
use super::theme::small_mono_font;

/// Width of the field, points.
const FIELD: f32 = 62.0;
/// Least width of the picker, points.
const LEAST_PICKER: f32 = 14.0;

/// Shows and edits a color.
pub(in crate::app) fn edit(ui: &mut Ui, linear: &mut [f32; 3]) -> Response {
    // The picker rounds its color even while it is not used.
    let mut edited = *linear;
    // The field needs its width; the picker takes what a narrow panel leaves.
    let width = ui.spacing().interact_size.x;
    let left = ui.available_width() - FIELD - ui.spacing().item_spacing.x;
    ui.spacing_mut().interact_size.x = left.clamp(LEAST_PICKER, width.max(LEAST_PICKER));
    let picker = egui::widgets::color_picker::color_edit_button_rgb(ui, &mut edited);
    ui.spacing_mut().interact_size.x = width;
    if picker.changed() {
        *linear = edited;
    }
    let id = picker.id.with("code");
    let typed = ui.data(|data| data.get_temp::<String>(id));
    let mut text = typed.unwrap_or_else(|| code(*linear));
    let field = TextEdit::singleline(&mut text).id(id).desired_width(FIELD).font(small_mono_font());
    let field = named(ui.add(field), "Color code").on_hover_text("The color as #rrggbb, in sRGB");
    if let Some(color) = parse(&text).filter(|_| field.changed()) {
        *linear = color;
    }
    let is_typed = field.has_focus();
    ui.data_mut(|data| match is_typed {
        true => _ = data.insert_temp(id, text),
        false => data.remove::<String>(id),
    });
    picker.union(field)
}

/// The code of a color; parts outside of 0 to 1 are clamped.
fn code([r, g, b]: [f32; 3]) -> String {
    let [r, g, b, _] = egui::Color32::from(Rgba::from_rgb(r, g, b)).to_array();
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The color of a code, with or without `#`.
fn parse(text: &str) -> Option<[f32; 3]> {
    let digits = text.trim().trim_start_matches('#');
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6)?;
    let [_, r, g, b] = number.to_be_bytes();
    let [r, g, b, _] = Rgba::from(egui::Color32::from_rgb(r, g, b)).to_array();
    Some([r, g, b])
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    #[test]
    fn a_color_that_nobody_edits_stays_as_it_is() {
        let egui = egui::Context::default();
        let before = [1.0, 0.93, 0.82];
        let mut linear = before;
        for _ in 0..2 {
            let _ = egui.run_ui(egui::RawInput::default(), |ui| drop(edit(ui, &mut linear)));
        }
        assert_eq!(linear, before);
    }

    #[test]
    fn a_code_is_typed() {
        assert_eq!((code([1.0, 0.0, 0.5]), code([2.0, -1.0, 1.0])), ("#ff00bc".into(), "#ff00ff".into()));
        assert_eq!((parse("#ff0000"), parse("00ff00")), (Some([1.0, 0.0, 0.0]), Some([0.0, 1.0, 0.0])));
        assert!(["", "#ff", "#ggg000", "red", "#ff00000"].iter().all(|text| parse(text).is_none()));
        let mut harness = Harness::new_ui_state(|ui, linear| drop(edit(ui, linear)), [0.0; 3]);
        harness.run();
        harness.get_by_role(Role::TextInput).focus();
        harness.run();
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.get_by_role(Role::TextInput).type_text("#0000ff");
        harness.run();
        assert_eq!(*harness.state(), [0.0, 0.0, 1.0]);
    }
}
