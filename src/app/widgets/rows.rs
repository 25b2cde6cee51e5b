//! Rows of the panels: a name at the left, a control at the right. All rows of a column have names of the same width, and fit the
//! column. The name of a changed setting has another color. A double click on it resets the setting; its menu copies the option of
//! the command line.

use std::cell::RefCell;
use std::sync::LazyLock;

use egui::{
    Button, Checkbox, ComboBox, DragValue, Label, Layout, Response, RichText, Sense, Slider, SliderClamping, Ui, vec2,
};

use super::check_box;
use super::spoken::named;
use super::theme::{ACCENT, QUIET, small_mono};
use crate::app::numbers::{Number, Scale};
use crate::settings::{Curve, Setting, Settings, Valid, Value, catalog};

/// Height of a row, in points.
const HEIGHT: f32 = 18.0;
/// Smallest width of the names, in points. Names become narrower before the controls do.
const NAME: f32 = 84.0;
/// Largest share of a row that its name takes.
const SHARE: f32 = 0.45;
/// Points by which the name of an indented row moves.
const INDENT: f32 = 10.0;
/// Points that names leave to the controls while they can.
const CONTROL: f32 = 150.0;
/// Width of the number at the right of a slider, with its unit.
const VALUE: f32 = 72.0;
/// Seconds for which a row shows why a text was rejected.
const REFUSAL_S: f64 = 4.0;
/// A slider shorter than this is left out: the number is dragged instead.
const SHORTEST: f32 = 36.0;

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
        ui.horizontal(|ui| {
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
        .inner
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
static INITIAL: LazyLock<Settings> = LazyLock::new(Settings::of_window);

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
            (Value::Numbers(linear), _) => color(ui, linear),
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
    let Some(setting) = crate::settings::setting(path) else { return };
    let (value, initial) = (settings.value(path).unwrap_or(Value::Unset), INITIAL.value(path).unwrap_or(Value::Unset));
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

/// A slider with its number, or the number alone where there is no room or no range.
pub(in crate::app) fn edit_number(ui: &mut Ui, name: &str, number: &mut f64, scale: &Scale) -> Response {
    let gap = ui.spacing().item_spacing.x;
    let rail = ui.available_width() - VALUE - gap;
    let Some((low, high)) = scale.slider.filter(|_| rail >= SHORTEST) else {
        let width = ui.available_width();
        return drag(ui, number, scale, width);
    };
    ui.spacing_mut().slider_width = rail;
    let is_squared = scale.curve == Curve::Squared;
    let (mut place, ends) = match is_squared {
        true => (number.max(0.0).sqrt(), low.max(0.0).sqrt()..=high.max(0.0).sqrt()),
        false => (*number, low..=high),
    };
    let slider = Slider::new(&mut place, ends).show_value(false).clamping(SliderClamping::Edits);
    let slider = slider.logarithmic(scale.curve == Curve::Logarithmic);
    let slider = if is_squared { slider } else { slider.fixed_decimals(scale.decimals) };
    let response = ui.scope(|ui| {
        // The fill of the rail has no color of its own.
        ui.visuals_mut().selection.bg_fill = ACCENT.color();
        ui.add(slider.trailing_fill(true))
    });
    let response = response.inner;
    if response.changed() {
        let digits = 10_f64.powi(scale.decimals as i32);
        *number = if is_squared { (place * place * digits).round() / digits } else { place };
    }
    response.union(named(drag(ui, number, scale, VALUE), &format!("{name}, value")))
}

/// A number that is dragged or typed, of this width in points.
pub(in crate::app) fn drag(ui: &mut Ui, number: &mut f64, scale: &Scale, width: f32) -> Response {
    let (low, high) = scale.limits;
    // A drag over 200 points covers the range of the slider.
    let speed = scale.slider.map_or(0.01, |(low, high)| (high - low) / 200.0);
    let value = DragValue::new(number).range(low..=high).clamp_existing_to_range(false).speed(speed);
    let value = value.fixed_decimals(scale.decimals);
    let refused = RefCell::new(None);
    let parse = |text: &str| scale.parse(text).map_err(|message| refused.replace(Some(message))).ok();
    let value = value.custom_formatter(|number, _| scale.text(number)).custom_parser(parse);
    let response = ui.add_sized(vec2(width, HEIGHT), value);
    refusal(&response, refused.take());
    response
}

/// Shows beside the number, for a while, why a text was rejected.
fn refusal(response: &Response, refused: Option<String>) {
    let (egui, id) = (&response.ctx, response.id.with("refused"));
    let now = egui.input(|input| input.time);
    if let Some(message) = refused {
        egui.data_mut(|data| data.insert_temp(id, (message, now + REFUSAL_S)));
    }
    let Some((message, end)) = egui.data(|data| data.get_temp::<(String, f64)>(id)) else { return };
    if now < end {
        response.show_tooltip_text(message);
        egui.request_repaint_after(std::time::Duration::from_secs_f64(end - now));
    } else {
        egui.data_mut(|data| data.remove::<(String, f64)>(id));
    }
}

/// A list of choices as wide as the rest of the row.
pub(in crate::app) fn choose(
    ui: &mut Ui,
    id: &str,
    shown: impl Into<egui::WidgetText>,
    list: impl FnOnce(&mut Ui),
) -> Response {
    let list_of = ComboBox::from_id_salt(id).selected_text(shown).width(ui.available_width()).truncate();
    list_of.show_ui(ui, list).response
}

/// A check box.
pub(in crate::app) fn check(ui: &mut Ui, on: &mut bool) -> Response {
    let response = check_box::show(ui, Checkbox::without_text(on));
    // egui gives a box without text an empty name, which would hide that of the row.
    ui.ctx().accesskit_node_builder(response.id, |node| node.clear_label());
    response
}

/// A color picker for linear RGB.
pub(in crate::app) fn color(ui: &mut Ui, linear: &mut [f32; 3]) -> Response {
    // The picker rounds its color even while it is not used.
    let mut edited = *linear;
    let response = egui::widgets::color_picker::color_edit_button_rgb(ui, &mut edited);
    if response.changed() {
        *linear = edited;
    }
    response
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
    fn a_color_that_nobody_edits_stays_as_it_is() {
        let egui = egui::Context::default();
        let before = [1.0, 0.93, 0.82];
        let mut linear = before;
        for _ in 0..2 {
            let _ = egui.run_ui(egui::RawInput::default(), |ui| drop(color(ui, &mut linear)));
        }
        assert_eq!(linear, before);
    }

    #[test]
    fn rows_fit_narrow_and_wide_columns() {
        for width in [184.0, 220.0, 302.0, 600.0] {
            let reach = reach(width);
            assert!(reach <= width + 0.5 && reach > width - 3.0, "{reach} in a column of {width}");
        }
    }
}
