//! The bar above the picture: arrangements of the panels, the command palette and the list of keys.

use egui::{Button, Checkbox, Label, RichText, ScrollArea, Ui, vec2};

use crate::app::command::file::{CHOOSE, OPEN, OPEN_BUILT_IN, Open, RESTORE_ALWAYS, RESTORE_SESSION, SHOW_GALLERY};
use crate::app::command::spec::Command;
use crate::app::layout::Layout;
use crate::app::palette::Palette;
use crate::app::state::State;
use crate::app::state::arrangement::{Panel, Preset};
use crate::app::state::dialog::Dialog;
use crate::app::state::last_session::LastSessions;
use crate::app::state::notices::{Notice, Notices};
use crate::app::state::recent::{Kind, Recent};
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{BAR, QUIET, icon, small_mono};
use crate::app::widgets::{check_box, theme};

/// Height in points.
pub(super) const HEIGHT: f32 = 30.0;

pub(super) fn show(
    ui: &mut Ui,
    (layout, palette, show_keys): (&mut Layout, &mut Palette, &mut bool),
    state: &State,
    commands: &mut Vec<Command>,
) {
    let frame = egui::Frame::new().fill(BAR.color()).inner_margin(egui::Margin::symmetric(8, 3));
    let bar = egui::Panel::top("bar").frame(frame).exact_size(HEIGHT).resizable(false).show_separator_line(false);
    bar.show(ui, |ui| {
        ui.horizontal_centered(|ui| {
            ui.label(RichText::new("Specula").strong().color(theme::ACCENT));
            ui.add_space(6.0);
            open(ui, &state.recent, &state.last_sessions, commands);
            panels(ui, layout);
            for preset in Preset::ALL {
                if ui.button(preset.title()).on_hover_text(preset.doc()).clicked() {
                    layout.arrange(preset);
                }
            }
            if layout.has_own() && ui.button("Own").on_hover_text("The panels as you last arranged them").clicked() {
                layout.arrange_own();
            }
            if let Some(side) = layout.hidden_side() {
                let hint = format!("The window is too narrow for the panels on both sides: shows those on the {side}");
                let button = named(ui.button(icon::ARROWS_LEFT_RIGHT), "Panels of the other side");
                if button.on_hover_text(hint).clicked() {
                    layout.swap_sides();
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if named(ui.button(icon::QUESTION), "Keys").on_hover_text("Keys (F1, ?)").clicked() {
                    *show_keys ^= true;
                }
                let is_light = layout.is_light();
                let (symbol, hint) = if is_light { (icon::MOON, "Dark theme") } else { (icon::SUN, "Light theme") };
                if named(ui.button(symbol), hint).on_hover_text(hint).clicked() {
                    layout.set_light(!is_light);
                }
                messages(ui, &state.notices);
                let width = (ui.available_width() - 8.0).min(300.0);
                if width > 120.0 {
                    let text = RichText::new(format!("{}  Find a mode, setting or command", icon::MAGNIFYING_GLASS))
                        .color(QUIET);
                    let keys = small_mono("Ctrl+P").color(QUIET);
                    let button = Button::new(text).right_text(keys).min_size(vec2(width, 20.0)).truncate();
                    if named(ui.add(button), "Command palette").on_hover_text("Command palette").clicked() {
                        palette.open();
                    }
                }
            });
        });
    });
}

/// The menu that opens files: by a dialog, or those that were open.
fn open(ui: &mut Ui, recent: &Recent, last_sessions: &LastSessions, commands: &mut Vec<Command>) {
    let menu = ui.menu_button(format!("{}  Open", icon::FOLDER_OPEN), |ui| {
        ui.set_min_width(180.0);
        let hint = "Built-in models and environments, with pictures";
        if ui.button("Gallery…").on_hover_text(hint).clicked() {
            commands.push(SHOW_GALLERY.with(()));
        }
        if ui.add(Button::new("File…").right_text(RichText::new("Ctrl+O").small().color(QUIET))).clicked() {
            commands.push(CHOOSE.with(Dialog::File));
        }
        if ui.button("Shader tree…").clicked() {
            commands.push(CHOOSE.with(Dialog::Tree));
        }
        if ui.button("Built-in shaders").on_hover_text("The shader tree of the program").clicked() {
            commands.push(OPEN_BUILT_IN.with(()));
        }
        ui.separator();
        if let Some(session) = &last_sessions.here
            && ui.button("Last session").on_hover_text(session.words()).clicked()
        {
            commands.push(RESTORE_SESSION.with(()));
        }
        let mut always = last_sessions.is_always();
        let hint = "When Specula starts in this folder without arguments, continue its last session";
        if check_box::show(ui, Checkbox::new(&mut always, "Restore at start")).on_hover_text(hint).changed() {
            commands.push(RESTORE_ALWAYS.with(always));
        }
        for (kind, title) in
            [(Kind::Model, "Models"), (Kind::Environment, "Environments"), (Kind::Tree, "Shader trees")]
        {
            if recent.of(kind).is_empty() {
                continue;
            }
            ui.separator();
            ui.label(RichText::new(title).small().color(QUIET));
            for path in recent.of(kind) {
                if ui.button(kind.name_of(path)).on_hover_text(path.display().to_string()).clicked() {
                    let path = path.clone();
                    commands.push(match kind {
                        Kind::Model => OPEN.with(Open::Model(path)),
                        Kind::Environment => OPEN.with(Open::Environment(path)),
                        Kind::Tree => OPEN.with(Open::Tree(path)),
                    });
                }
            }
        }
    });
    named(menu.response, "Open").on_hover_text("Open a model, an environment or shaders");
}

/// The list of the messages so far.
fn messages(ui: &mut Ui, notices: &Notices) {
    let menu = ui.menu_button(icon::BELL, |ui| {
        ui.set_width(420.0);
        if notices.past().len() == 0 {
            ui.label(RichText::new("No messages yet").color(QUIET));
        }
        ScrollArea::vertical().max_height(360.0).show(ui, |ui| {
            for Notice { text, at, .. } in notices.past() {
                ui.label(small_mono(at.format("%H:%M:%S").to_string()).color(QUIET));
                // Menus justify their texts.
                ui.with_layout(egui::Layout::top_down(egui::Align::LEFT), |ui| ui.add(Label::new(text).wrap()));
            }
        });
    });
    named(menu.response, "Messages").on_hover_text("The messages so far");
}

/// The menu that opens and closes panels, and resets their arrangement.
fn panels(ui: &mut Ui, layout: &mut Layout) {
    ui.menu_button(format!("{}  Panels", icon::LAYOUT), |ui| {
        for (index, group) in Panel::groups().into_iter().enumerate() {
            if index > 0 {
                ui.separator();
            }
            for panel in group {
                let mut is_open = layout.is_in_sight(panel);
                if check_box::show(ui, Checkbox::new(&mut is_open, panel.0)).changed() {
                    match is_open {
                        true => layout.open(panel),
                        false => layout.close(panel),
                    }
                }
            }
        }
        ui.separator();
        let hint = "Show the panels as the chosen arrangement has them. \"Own\" returns to yours";
        if ui.button("Reset this arrangement").on_hover_text(hint).clicked() {
            layout.reset();
            ui.close();
        }
    });
}
