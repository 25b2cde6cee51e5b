//! Rows of the panels: a name at the left, a control at the right. All rows of a column have names of the same width, and fit the
//! column. The name of a changed setting has another color. A double click on it resets the setting; its menu copies the option of
//! the command line.

use std::sync::LazyLock;

use egui::{Button, DragValue, Label, Layout, Response, RichText, Sense, Ui, vec2};

use super::controls::HEIGHT;
pub(in crate::app) use super::controls::{check, choose, drag, edit_number};
use super::theme::{ACCENT, QUIET, small_mono};
use super::{color, sight};
use crate::app::numbers::Number;
use crate::settings::{Setting, Settings, Valid, Value, catalog};

/// Smallest width of the names, in points. Names become narrower before the controls do.
const NAME: f32 = 84.0;
/// Largest share of a row that its name takes.
const SHARE: f32 = 0.45;
/// Points by which the name of an indented row moves.
const INDENT: f32 = 10.0;
/// Points that names leave to the controls while they can.
const CONTROL: f32 = 150.0;

/// A row without its control.
pub(in crate::app) struct Row<'a> {
    pub(in crate::app) name: &'a str,
    /// Meaning of the setting; may be empty.
    pub(in crate::app) doc: &'a str,
    /// Option of the command line that sets the present value; empty if there is none.
    pub(in crate::app) option: String,
    /// Whether the value differs from the default.
    pub(in crate::app) is_changed: bool,
    /// Whether it belongs to the row above.
    pub(in crate::app) is_indented: bool,
}

/// Leaves room for the next row if it is out of sight. Returns whether it has.
pub(in crate::app) fn skips(ui: &mut Ui) -> bool {
    sight::skips(ui)
}

impl Row<'_> {
    /// Shows the row with its control. Returns whether the user resets the setting.
    pub(in crate::app) fn show(self, ui: &mut Ui, control: impl FnOnce(&mut Ui) -> Response) -> bool {
        self.show_with(ui, control, |_| {})
    }

    /// The same with more in the menu of the name.
    pub(in crate::app) fn show_with(
        self,
        ui: &mut Ui,
        control: impl FnOnce(&mut Ui) -> Response,
        more: impl FnOnce(&mut Ui),
    ) -> bool {
        sight::show(ui, |ui| {
            let title = self.title(ui);
            // So that screen readers can read the control's name.
            let response = control(ui).labelled_by(title.id);
            response.on_hover_ui(|ui| self.about(ui));
            let mut resets = self.is_changed && title.double_clicked();
            if !self.option.is_empty() {
                title.context_menu(|ui| {
                    resets |= self.menu(ui);
                    more(ui);
                });
            }
            title.on_hover_ui(|ui| self.about(ui));
            resets
        })
    }

    fn title(&self, ui: &mut Ui) -> Response {
        let text = RichText::new(self.name);
        let text = if self.is_changed { text.color(ACCENT) } else { text };
        let size = vec2(name_width(ui.available_width(), ui.spacing().item_spacing.x), HEIGHT);
        let label = |ui: &mut Ui| {
            ui.set_min_size(size);
            if self.is_indented {
                ui.add_space(INDENT);
            }
            // The hover text begins with the whole name.
            ui.add(elided(text).selectable(false).sense(Sense::click()))
        };
        ui.allocate_ui_with_layout(size, Layout::left_to_right(egui::Align::Center), label).inner
    }

    /// The hover text.
    fn about(&self, ui: &mut Ui) {
        ui.set_max_width(320.0);
        ui.label(RichText::new(self.name).strong());
        if !self.doc.is_empty() {
            ui.label(self.doc);
        }
        if !self.option.is_empty() {
            ui.label(option_text(&self.option).color(ACCENT));
        }
        if self.is_changed {
            ui.label(RichText::new("Double-click the name to reset it").small().color(QUIET));
        }
    }

    /// The menu of the name. Returns whether the user resets the setting.
    fn menu(&self, ui: &mut Ui) -> bool {
        if ui.button(option_text(&format!("Copy {}", self.option))).clicked() {
            ui.ctx().copy_text(self.option.clone());
            ui.close();
        }
        let resets = ui.add_enabled(self.is_changed, Button::new("Reset")).clicked();
        if resets {
            ui.close();
        }
        resets
    }
}

/// The width of the names in rows of this width, with this gap before the controls.
fn name_width(row: f32, gap: f32) -> f32 {
    (row - CONTROL - gap).min(SHARE * row).max(NAME)
}

/// An option of the command line. The font of other texts renders two hyphens as one dash.
pub(in crate::app) fn option_text(option: &str) -> RichText {
    small_mono(option)
}

/// A text in one line that is truncated with an ellipsis, for a widget that has a hover text: egui's own hover text would appear
/// beside it.
pub(in crate::app) fn elided(text: impl Into<egui::WidgetText>) -> Label {
    Label::new(text).truncate().show_tooltip_when_elided(false)
}

/// A heading above rows.
pub(in crate::app) fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(4.0);
    ui.add(Label::new(RichText::new(text).small().color(QUIET)).selectable(false));
}

/// A number with at most four decimals.
pub(in crate::app) fn short(number: f64) -> String {
    ((number * 1e4).round() / 1e4).to_string()
}

/// `--set PATH=VALUE`, in the quotes that a shell needs.
pub(in crate::app) fn set_option(path: &str, value: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "._-/,:+%@=".contains(c);
    let value =
        if value.chars().all(is_plain) { value.to_owned() } else { format!("'{}'", value.replace('\'', r"'\''")) };
    format!("--set {path}={value}")
}

/// Initial settings of the window. The name of a row has another color when its setting differs from them.
pub(in crate::app) static INITIAL: LazyLock<Settings> = LazyLock::new(Settings::of_window);

/// Shows the rows of the settings in a group, in the order of their declaration. `special` shows those that need more than the control of
/// their type; it returns whether it has.
pub(in crate::app) fn group(
    ui: &mut Ui,
    settings: &mut Settings,
    group: &str,
    mut special: impl FnMut(&mut Ui, &mut Settings, &'static str) -> bool,
) {
    let in_group = |setting: &&Setting| !setting.entry.label.is_empty() && setting.group() == group;
    for setting in catalog().iter().filter(in_group) {
        if !special(ui, settings, &setting.path) {
            self::setting(ui, settings, setting);
        }
    }
}

/// Shows the rows of a setting with the control of its type.
pub(in crate::app) fn setting(ui: &mut Ui, settings: &mut Settings, setting: &'static Setting) {
    if Number::of(setting).next().is_some() {
        return Number::of(setting).for_each(|each| number(ui, settings, &each));
    }
    special(ui, settings, &setting.path, |ui, settings| {
        let before = settings.value(&setting.path).unwrap_or(Value::Unset);
        let mut value = before.clone();
        let response = match (&mut value, setting.entry.valid) {
            (Value::Switch(on), _) => check(ui, on),
            (Value::Numbers(linear), _) => color::edit(ui, linear),
            (Value::Text(name), _) => choose(ui, &setting.path, name.clone(), |ui| {
                for choice in &setting.names {
                    ui.selectable_value(name, choice.clone(), choice.as_str());
                }
            }),
            (Value::Whole(number), Valid::OneOf(values)) => {
                let suffix = setting.entry.unit.suffix;
                let choice = |value: &u32| ui.selectable_value(number, *value, format!("{value}{suffix}"));
                values.iter().map(choice).reduce(|all, next| all.union(next)).unwrap_or_else(|| ui.label(""))
            }
            (Value::Whole(number), Valid::Whole(low, high)) => ui.add(DragValue::new(number).range(low..=high)),
            (other, _) => ui.label(other.to_string()),
        };
        if value != before {
            settings.set_value(&setting.path, &value);
        }
        response
    });
}

/// Shows the row of the setting at a path with another control.
pub(in crate::app) fn special(
    ui: &mut Ui,
    settings: &mut Settings,
    path: &str,
    control: impl FnOnce(&mut Ui, &mut Settings) -> Response,
) {
    let Some(setting) = crate::settings::setting(path).filter(|_| !skips(ui)) else { return };
    let (value, initial) =
        (settings.value(path).unwrap_or(Value::Unset), INITIAL.value(path).unwrap_or_else(|| setting.default.clone()));
    let row = Row {
        name: setting.entry.label,
        doc: setting.entry.doc(),
        option: set_option(path, &option_value(&value)),
        is_changed: value != initial,
        is_indented: false,
    };
    let is_used = settings.uses(setting.entry);
    if row.show(ui, |ui| ui.add_enabled_ui(is_used, |ui| control(ui, settings)).inner) {
        settings.set_value(path, &initial);
    }
}

/// The value as `--set` takes it. Numbers of colors and places are rounded.
pub(in crate::app) fn option_value(value: &Value) -> String {
    match value {
        Value::Numbers(numbers) => numbers.map(|number| short(f64::from(number))).join(","),
        value => value.to_string(),
    }
}

/// Shows the row of a number of the settings.
fn number(ui: &mut Ui, settings: &mut Settings, number: &Number) {
    if skips(ui) {
        return;
    }
    let (before, initial) = (number.get(settings), number.get(&INITIAL));
    let (name, scale) = (number.name(), number.scale());
    let row = Row {
        name: &name,
        doc: number.doc(),
        option: set_option(&number.path(), &number.option_value(settings)),
        is_changed: before != initial,
        is_indented: false,
    };
    let is_used = number.is_used(settings);
    let mut now = before;
    if row.show(ui, |ui| ui.add_enabled_ui(is_used, |ui| edit_number(ui, &name, &mut now, &scale)).inner) {
        now = initial;
    }
    if now != before {
        number.set(settings, now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_what_a_shell_takes() {
        assert_eq!(set_option("view.ev", "-1.5"), "--set view.ev=-1.5");
        assert_eq!(set_option("environment.name", "my sky's.hdr"), r"--set environment.name='my sky'\''s.hdr'");
        assert_eq!(option_value(&Value::Numbers([0.45, 1.0, 0.0])), "0.45,1,0");
    }

    #[test]
    fn names_grow_with_the_panel() {
        assert_eq!([184.0, 302.0, 600.0].map(|width| name_width(width, 6.0).round()), [84.0, 136.0, 270.0]);
    }

    /// Shows rows in a column of this width, and returns how far they reach.
    fn reach(width: f32) -> f32 {
        let egui = egui::Context::default();
        super::super::theme::apply(&egui);
        let mut reach = 0.0;
        let mut settings = Settings::of_window();
        let size = vec2(800.0, 600.0);
        // The second frame has the sizes of the first.
        for _ in 0..2 {
            let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size));
            let input = egui::RawInput { screen_rect, ..Default::default() };
            let _ = egui.run_ui(input, |ui| {
                let column = egui::Rect::from_min_size(egui::Pos2::ZERO, vec2(width, 600.0));
                ui.scope_builder(egui::UiBuilder::new().max_rect(column), |ui| {
                    for path in ["view.ev", "environment.blur"] {
                        setting(ui, &mut settings, crate::settings::setting(path).unwrap());
                    }
                    special(ui, &mut settings, "variant", |ui, _| {
                        choose(ui, "long", "a name that is longer than any column", |_| {})
                    });
                    reach = ui.min_rect().max.x;
                });
            });
        }
        reach
    }

    #[test]
    fn rows_fit_narrow_and_wide_columns() {
        for width in [184.0, 220.0, 302.0, 600.0] {
            let reach = reach(width);
            assert!(reach <= width + 0.5 && reach > width - 3.0, "{reach} in a column of {width}");
        }
    }
}
