//! The controls of rows: numbers with their sliders, lists of choices, check boxes and colors.

use std::cell::RefCell;

use egui::{Checkbox, ComboBox, DragValue, Response, Slider, SliderClamping, Ui, vec2};

use super::check_box;
use super::spoken::named;
use super::theme::ACCENT;
use crate::app::numbers::Scale;
use crate::settings::Curve;

/// Height of a row, in points.
pub(super) const HEIGHT: f32 = 18.0;
/// Width of the number at the right of a slider, with its unit.
const VALUE: f32 = 72.0;
/// Seconds for which a row shows why a text was rejected.
const REFUSAL_S: f64 = 4.0;
/// A slider shorter than this is left out: the number is dragged instead.
const SHORTEST: f32 = 36.0;

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
