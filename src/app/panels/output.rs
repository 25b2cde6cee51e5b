//! The panel Output: exposure, tone map, background, samples.

pub(super) mod range;

use egui::{RichText, Ui};

use crate::app::command::layout::PANELS;
use crate::app::command::look::{CHOOSE_LOOK, SAVE_LOOK, SaveLook};
use crate::app::command::program::SAY;
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::rows::{Row, check, group, special};
use crate::app::widgets::theme::QUIET;
use crate::settings::Settings;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Output", Group::Settings, "exposure tone map range channels colors samples", || Box::new(ui));

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let shows = context.state.workspace.shows_histogram;
    let mut shows_now = shows;
    let Commands { settings, list, .. } = commands;
    show(ui, settings, &mut shows_now, list);
    if shows_now != shows {
        list.push(PANELS.with(PanelRequest::ToggleHistogram));
    }
}

/// Shows the panel. `shows_histogram`: whether the legend over the picture has the histogram of its values.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, shows_histogram: &mut bool, commands: &mut Vec<Command>) {
    group(ui, settings, "view", |ui, settings, path| {
        match path {
            "view.background" => background(ui, settings),
            "view.range" => range::show(ui, settings),
            "view.msaa" => {
                let doc = "How often each value occurs in the picture, over its upper left corner";
                let row = Row { name: "Histogram", doc, option: String::new(), is_changed: false, is_indented: false };
                row.show(ui, |ui| check(ui, shows_histogram));
                return false;
            }
            _ => return false,
        }
        true
    });
    ui.horizontal_wrapped(|ui| {
        let hint = "Write all settings to specula-look-N.toml. Open it by Ctrl+O, by a drop, or with --look";
        if ui.button("Save look").on_hover_text(hint).clicked() {
            commands.push(SAVE_LOOK.with(SaveLook::default()));
        }
        if ui.button("Open look…").on_hover_text("Take the settings of a look file or of a picture").clicked() {
            commands.push(CHOOSE_LOOK.with(()));
        }
        if ui.button("Copy as look file").on_hover_text("Copy all settings as TOML, for --look").clicked() {
            ui.ctx().copy_text(settings.to_toml());
            commands.push(SAY.with("Copied all settings as TOML".into()));
        }
    });
}

fn background(ui: &mut Ui, settings: &mut Settings) {
    special(ui, settings, "view.background", |ui, settings| {
        let background = &mut settings.view.background;
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
