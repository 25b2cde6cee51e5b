//! The panel Environment: the map, its rotation and intensity, and whether it is visible.

use egui::{RichText, Slider, Ui};

use super::{QUIET, angle, row, slide};
use crate::render::BakeReport;
use crate::scene::environment::BUILT_IN;
use crate::settings::Settings;

/// Shows the panel. `recent` are the files that were shown. `progress` is the fraction of the current bake that is done, and its next
/// pass.
pub(super) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    recent: &[String],
    progress: Option<&(f32, String)>,
    report: &BakeReport,
) {
    let environment = &mut settings.environment;
    let short = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    row(ui, "Map", "Environment map (--env). Drop an .hdr or .exr file on the window to use it", |ui| {
        let shown = short(&environment.name);
        egui::ComboBox::from_id_salt("environment").selected_text(shown).width(150.0).truncate().show_ui(ui, |ui| {
            for name in BUILT_IN.into_iter().chain(["none"]).chain(recent.iter().map(String::as_str)) {
                ui.selectable_value(&mut environment.name, name.to_owned(), short(name)).on_hover_text(name);
            }
        });
    });
    // A row of the same height in every state, so that the rows below keep their place.
    ui.allocate_ui(egui::vec2(ui.available_width(), 16.0), |ui| {
        ui.set_min_height(16.0);
        if let Some((done, next)) = progress {
            ui.add(egui::ProgressBar::new(*done).desired_height(16.0).text(RichText::new(next).small()));
        } else if environment.is_lit() && report.total_ms > 0.0 {
            let from = if report.cached { "from the disk" } else { "baked" };
            ui.label(RichText::new(format!("{from} in {:.0} ms", report.total_ms)).small().color(QUIET));
        }
    });
    angle(ui, "Rotation", "Rotation around +Y in degrees", &mut environment.rotation, -180.0..=180.0);
    row(ui, "Intensity", "Factor on the map, whose values are cd/m^2", |ui| {
        slide(ui, Slider::new(&mut environment.intensity, 0.0..=8.0).max_decimals(2));
    });
    row(ui, "Behind", "Show the map behind the model (--background env)", |ui| {
        let mut seen = settings.view.background == "env";
        if ui.add_enabled(environment.is_lit(), egui::Checkbox::without_text(&mut seen)).changed() {
            settings.view.background = if seen { "env".into() } else { "#1b1d21".into() };
        }
    });
    row(ui, "Blur", "Blur of the map behind the model: 0 is sharp", |ui| {
        let is_seen = environment.is_shown(&settings.view);
        ui.add_enabled_ui(is_seen, |ui| slide(ui, Slider::new(&mut environment.blur, 0.0..=1.0).max_decimals(2)));
    });
}
