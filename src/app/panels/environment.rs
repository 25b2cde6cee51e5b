//! The panel Environment: the map, its rotation and intensity, and whether it is visible.

use std::path::PathBuf;

use egui::{RichText, Ui};

use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec};
use crate::app::state::recent::Kind;
use crate::app::widgets::rows::{Row, check, choose, group, set_option, special};
use crate::app::widgets::theme::QUIET;
use crate::render::BakeReport;
use crate::scene::environment::{BUILT_IN, MODEL};
use crate::settings::{Settings, ViewSettings};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Environment", Group::Settings, "HDR map rotation background blur suns", || Box::new(ui));

/// The panel.
pub(super) fn ui(ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
    let recent = context.state.recent.of(Kind::Environment);
    let has_own = context.state.session.model().is_some_and(|model| model.environment.is_some());
    show(ui, &mut commands.settings, (recent, has_own), context.readings.baking, context.readings.baked);
}

/// Shows the panel. `recent`: files that were shown, the newest first, and whether the model brings a map along. `progress` is the fraction of the current bake that is
/// done, and its next pass.
fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    recent: (&[PathBuf], bool),
    progress: Option<&(f32, String)>,
    report: &BakeReport,
) {
    group(ui, settings, "environment", |ui, settings, path| {
        match path {
            "environment.name" => {
                map(ui, settings, recent);
                baked(ui, settings.environment.is_lit(), progress, report);
                return true;
            }
            "environment.blur" => visible(ui, settings),
            _ => {}
        }
        false
    });
}

/// The progress of the bake, or how long it took.
fn baked(ui: &mut Ui, is_lit: bool, progress: Option<&(f32, String)>, report: &BakeReport) {
    // A row of constant height, so that the rows below keep their place.
    ui.allocate_ui(egui::vec2(ui.available_width(), 16.0), |ui| {
        ui.set_min_height(16.0);
        if let Some((done, next)) = progress {
            ui.add(egui::ProgressBar::new(*done).desired_height(16.0).text(RichText::new(next).small()));
        } else if is_lit && report.total_ms > 0.0 {
            let from = if report.cached { "Light loaded from cache" } else { "Light baked" };
            ui.label(RichText::new(format!("{from} in {:.0} ms", report.total_ms)).small().color(QUIET));
        }
    });
}

/// The list of maps.
fn map(ui: &mut Ui, settings: &mut Settings, (recent, has_own): (&[PathBuf], bool)) {
    let short = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    special(ui, settings, "environment.name", |ui, settings| {
        let name = &mut settings.environment.name;
        choose(ui, "environment", short(name), |ui| {
            for choice in BUILT_IN.into_iter().chain(has_own.then_some(MODEL)).chain(["none"]) {
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

/// Whether the map is the background.
fn visible(ui: &mut Ui, settings: &mut Settings) {
    let (is_lit, view) = (settings.environment.is_lit(), &mut settings.view);
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
