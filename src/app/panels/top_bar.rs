//! The bar above the picture: arrangements of the panels, the command palette and the list of keys.

use egui::{Button, RichText, Ui, vec2};

use super::theme::{EDGE, QUIET};
use super::{PanelState, theme};
use crate::app::layout::{Layout, Panel, Preset};

/// Height in points.
pub(super) const HEIGHT: f32 = 30.0;

pub(super) fn show(ui: &mut Ui, state: &mut PanelState) {
    let frame = egui::Frame::new().fill(EDGE).inner_margin(egui::Margin::symmetric(8, 3));
    let bar = egui::Panel::top("bar").frame(frame).exact_size(HEIGHT).resizable(false).show_separator_line(false);
    bar.show(ui, |ui| {
        ui.horizontal_centered(|ui| {
            ui.label(RichText::new("Specula").strong().color(theme::ACCENT));
            ui.add_space(6.0);
            panels(ui, &mut state.layout);
            for preset in Preset::ALL {
                if ui.button(preset.title()).on_hover_text(preset.doc()).clicked() {
                    state.layout.arrange(preset);
                }
            }
            if state.layout.has_own()
                && ui.button("Own").on_hover_text("The panels as you last arranged them").clicked()
            {
                state.layout.arrange_own();
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("?").on_hover_text("Keys (F1)").clicked() {
                    state.show_keys ^= true;
                }
                let width = (ui.available_width() - 8.0).min(300.0);
                if width > 120.0 {
                    let text = RichText::new("Find a mode, setting or command   Ctrl+P").color(QUIET);
                    let button = Button::new(text).min_size(vec2(width, 20.0)).truncate();
                    if ui.add(button).on_hover_text("Command palette").clicked() {
                        state.palette.open();
                    }
                }
            });
        });
    });
}

/// The menu that opens and closes panels.
fn panels(ui: &mut Ui, layout: &mut Layout) {
    ui.menu_button("Panels", |ui| {
        for (index, group) in Panel::GROUPS.into_iter().enumerate() {
            if index > 0 {
                ui.separator();
            }
            for panel in group {
                let mut is_open = layout.is_open(*panel);
                if ui.checkbox(&mut is_open, panel.title()).changed() {
                    match is_open {
                        true => layout.open(*panel),
                        false => layout.close(*panel),
                    }
                }
            }
        }
    });
}
