//! The panel Environment: the map, its rotation and intensity, and whether it is visible.

use std::path::PathBuf;

use egui::{RichText, Ui};

use super::QUIET;
use crate::app::numbers::{BLUR, INTENSITY, ROTATION};
use crate::app::widgets::rows::{Row, check, choose, number, set_option, setting};
use crate::render::BakeReport;
use crate::scene::environment::BUILT_IN;
use crate::settings::{EnvironmentSettings, Settings, ViewSettings};

/// Shows the panel. `recent`: files that were shown, the newest first. `progress` is the fraction of the current bake that is
/// done, and its next pass.
pub(super) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    recent: &[PathBuf],
    progress: Option<&(f32, String)>,
    report: &BakeReport,
) {
    map(ui, &mut settings.environment, recent);
    let is_lit = settings.environment.is_lit();
    // A row of the same height in every state, so that the rows below keep their place.
    ui.allocate_ui(egui::vec2(ui.available_width(), 16.0), |ui| {
        ui.set_min_height(16.0);
        if let Some((done, next)) = progress {
            ui.add(egui::ProgressBar::new(*done).desired_height(16.0).text(RichText::new(next).small()));
        } else if is_lit && report.total_ms > 0.0 {
            let from = if report.cached { "Light loaded from cache" } else { "Light baked" };
            ui.label(RichText::new(format!("{from} in {:.0} ms", report.total_ms)).small().color(QUIET));
        }
    });
    number(ui, settings, &ROTATION);
    number(ui, settings, &INTENSITY);
    suns(ui, &mut settings.environment);
    visible(ui, &mut settings.view, is_lit);
    number(ui, settings, &BLUR);
}

/// The list of maps.
fn map(ui: &mut Ui, environment: &mut EnvironmentSettings, recent: &[PathBuf]) {
    let short = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    let doc = "Environment map. Drop an .hdr or .exr file on the window to use it";
    let default = EnvironmentSettings::default().name;
    setting(ui, ("Map", doc, "environment.name"), &mut environment.name, default, |ui, name| {
        choose(ui, "environment", short(name), |ui| {
            for choice in BUILT_IN.into_iter().chain(["none"]) {
                ui.selectable_value(name, choice.to_owned(), choice);
            }
            for path in recent {
                let choice = path.display().to_string();
                // The command line may name the same file by a relative path.
                let is_shown = std::path::absolute(&*name).is_ok_and(|shown| shown == *path);
                let label = ui.selectable_label(is_shown, short(&choice)).on_hover_text(&choice);
                if label.clicked() && !is_shown {
                    *name = choice;
                }
            }
        })
    });
}

/// Whether suns of the map are lamps.
fn suns(ui: &mut Ui, environment: &mut EnvironmentSettings) {
    let is_lit = environment.is_lit();
    let doc = "Suns of the map light the model as lamps do. Off: they are a part of the prefiltered light, which blurs their highlights";
    let default = EnvironmentSettings::default().suns;
    setting(ui, ("Suns", doc, "environment.suns"), &mut environment.suns, default, |ui, on| {
        ui.add_enabled_ui(is_lit, |ui| check(ui, on)).inner
    });
}

/// Whether the map is the background.
fn visible(ui: &mut Ui, view: &mut ViewSettings, is_lit: bool) {
    let mut is_visible = view.background == "env";
    let row = Row {
        name: "Visible",
        doc: "Show the map behind the model",
        option: set_option("view.background", &view.background),
        is_changed: !is_visible,
        is_indented: false,
    };
    let resets = row.show(ui, |ui| ui.add_enabled_ui(is_lit, |ui| check(ui, &mut is_visible)).inner);
    if (is_visible || (resets && is_lit)) != (view.background == "env") {
        view.background = if is_visible || resets { "env".into() } else { ViewSettings::default().background };
    }
}
