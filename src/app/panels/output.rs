//! The panel Output: exposure, tone map, background, samples.

pub(super) mod range;

use clap::ValueEnum as _;
use egui::{RichText, Ui};

use super::QUIET;
use crate::app::command::Command;
use crate::app::numbers::EXPOSURE;
use crate::app::widgets::rows::{Row, check, choice_name, choose, number, setting};
use crate::settings::{Settings, Tonemap, ViewSettings};

/// Shows the panel. `shows_histogram`: whether the legend over the picture has the histogram of its values.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, shows_histogram: &mut bool, commands: &mut Vec<Command>) {
    number(ui, settings, &EXPOSURE);
    let view = &mut settings.view;
    let doc = "Curve that maps exposed light to the range of the display";
    setting(ui, ("Tone map", doc, "view.tonemap"), &mut view.tonemap, Tonemap::default(), |ui, tonemap| {
        choose(ui, "tonemap", choice_name(tonemap), |ui| {
            for choice in Tonemap::value_variants() {
                ui.selectable_value(tonemap, *choice, choice_name(choice));
            }
        })
    });
    background(ui, view);
    range::show(ui, view);
    let doc = "How often each value occurs in the picture, over its upper left corner";
    let row = Row { name: "Histogram", doc, option: String::new(), is_changed: false, is_indented: false };
    row.show(ui, |ui| check(ui, shows_histogram));
    let doc = "Multisampling: samples per pixel";
    setting(ui, ("Samples", doc, "view.msaa"), &mut view.msaa, ViewSettings::default().msaa, |ui, samples| {
        ui.selectable_value(samples, 1, "1×").union(ui.selectable_value(samples, 4, "4×"))
    });
    if ui.button("Copy as look file").on_hover_text("Copy all settings as TOML, for --look").clicked() {
        ui.ctx().copy_text(settings.to_toml());
        commands.push(Command::Say("Copied all settings as TOML".into()));
    }
}

fn background(ui: &mut Ui, view: &mut ViewSettings) {
    let doc = "Color behind the model: none (transparent), or the environment if it is visible";
    let default = Settings::of_window().view.background;
    setting(ui, ("Background", doc, "view.background"), &mut view.background, default, |ui, background| {
        if background == "env" {
            return ui.label(RichText::new("environment").color(QUIET));
        }
        let hex = u32::from_str_radix(background.trim_start_matches('#'), 16).unwrap_or(0);
        let mut srgb = [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8];
        let response = ui.color_edit_button_srgb(&mut srgb);
        if response.changed() {
            *background = format!("#{:02x}{:02x}{:02x}", srgb[0], srgb[1], srgb[2]);
        }
        response
    });
}
