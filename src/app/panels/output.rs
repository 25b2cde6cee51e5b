//! The panel Output: exposure, tone map, background, samples.

use clap::ValueEnum as _;
use egui::{RichText, Slider, Ui};

use super::{QUIET, row, slide};
use crate::app::command::Command;
use crate::settings::{Settings, Tonemap};

pub(super) fn show(ui: &mut Ui, settings: &mut Settings, commands: &mut Vec<Command>) {
    let view = &mut settings.view;
    let doc =
        "Exposure compensation in stops: +1 is twice as bright. Light in cd/m^2 is multiplied by 1 / (1.2 * 2^EV100)";
    row(ui, "Exposure", doc, |ui| {
        // Compensation and EV100 have opposite signs. 0.0 - 0.0 is 0, and -0.0 would show its sign.
        let mut stops = 0.0 - view.ev;
        let slider = Slider::new(&mut stops, -10.0..=10.0).suffix(" EV").max_decimals(1);
        let slider = slider.custom_formatter(|stops, _| format!("{stops:+.1}"));
        let response = slide(ui, slider).on_hover_text(format!("{doc}\n\n--ev {}", view.ev));
        if response.changed() {
            view.ev = 0.0 - stops;
        }
    });
    row(ui, "Tone map", "Curve from exposed light to display range (--tonemap)", |ui| {
        let name =
            |tonemap: Tonemap| tonemap.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
        egui::ComboBox::from_id_salt("tonemap").selected_text(name(view.tonemap)).show_ui(ui, |ui| {
            for tonemap in Tonemap::value_variants() {
                ui.selectable_value(&mut view.tonemap, *tonemap, name(*tonemap));
            }
        });
    });
    row(ui, "Background", "Color behind the model (--background)", |ui| {
        if view.background == "env" {
            ui.label(RichText::new("the environment").color(QUIET));
            return;
        }
        let hex = u32::from_str_radix(view.background.trim_start_matches('#'), 16).unwrap_or(0);
        let mut srgb = [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8];
        if ui.color_edit_button_srgb(&mut srgb).changed() {
            view.background = format!("#{:02x}{:02x}{:02x}", srgb[0], srgb[1], srgb[2]);
        }
    });
    row(ui, "Samples", "Multisampling: samples per pixel", |ui| {
        ui.selectable_value(&mut view.msaa, 1, "1x");
        ui.selectable_value(&mut view.msaa, 4, "4x");
    });
    if ui.button("Copy as look file").on_hover_text("Copy all settings as TOML, for --look").clicked() {
        ui.ctx().copy_text(settings.to_toml());
        commands.push(Command::Say("copied: all settings as TOML".into()));
    }
}
