//! The card about a watched expression that cannot be shown. It is no error of the shaders.

use egui::{Align2, Id, Rect, RichText};

use super::card::{area, card};
use super::diagnostics::{Files, one};
use crate::app::commands::Commands;
use crate::app::source_line::stop;
use crate::app::widgets::theme::{QUIET, WARNING};
use crate::shader::{Diagnostic, Severity};

/// Shows the card over the final picture. Returns its rectangle.
pub(super) fn show(
    egui: &egui::Context,
    error: &Diagnostic,
    picture: Rect,
    files: &mut Files,
    commands: &mut Commands,
) -> Rect {
    let about = Diagnostic { severity: Severity::Warning, ..error.clone() };
    files.update(std::slice::from_ref(&about));
    // An area keeps its first size, so another message or another picture is another area.
    let id = Id::new(("watched", &about, picture.width() as u32, picture.height() as u32));
    let area = area(id, Align2::LEFT_BOTTOM, picture).default_size(picture.size()).fade_in(false);
    let response = area.show(egui, |ui| {
        card(WARNING).show(ui, |ui| {
            ui.set_max_width((picture.width() - 60.0).max(200.0));
            one(ui, &about, files.is_file(&about.file), &mut commands.list);
            ui.horizontal(|ui| {
                ui.label(RichText::new("The picture is the final one.").small().color(QUIET));
                if ui.small_button("Stop").on_hover_text("Watch the expression no longer").clicked() {
                    stop(&mut commands.settings);
                }
            });
        });
    });
    response.response.rect
}

#[cfg(test)]
mod tests {
    use egui::accesskit::Role;
    use egui::{pos2, vec2};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use crate::settings::Settings;

    #[test]
    fn the_card_says_why_and_stops() {
        let mut settings = Settings::default();
        settings.expression.at = "a.glsl:1:x".to_owned();
        let error = Diagnostic::error("a.glsl", "cannot watch `x` here");
        let mut files = Files::default();
        let mut harness = Harness::new_ui_state(
            move |ui, settings: &mut Settings| {
                let mut commands = Commands::new(settings);
                let picture = Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, 400.0));
                show(ui.ctx(), &error, picture, &mut files, &mut commands);
                *settings = commands.settings;
            },
            settings,
        );
        harness.run();
        harness.get_by_label("cannot watch `x` here");
        harness.get_by_role_and_label(Role::Button, "Stop").click();
        harness.run();
        assert_eq!(harness.state().expression.at, "");
    }
}
