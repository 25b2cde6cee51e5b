//! The values of a pixel: a row for each mode, in groups. A click on a row shows its mode in the picture.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, Rect, Response, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::app::panels::modes::text_of;
use crate::app::state::inspection::{Reading, text};
use crate::app::widgets::rows::option_text;
use crate::app::widgets::search::Words;
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{ACCENT, EDGE, ERROR, QUIET, small_font, small_mono_font};
use crate::app::widgets::with_powers;
use crate::shader::{Mode, PixelValue};

/// The mode of the picture.
const FINAL: &str = "final";
/// Height of a row, points.
pub(super) const HEIGHT: f32 = 18.0;
/// Width and height of a swatch, points.
pub(super) const SWATCH: f32 = 12.0;
/// Points before a name, and between it and its numbers.
const NAME: f32 = SWATCH + 7.0;
const GAP: f32 = 6.0;
/// Width of the column of units, points.
const UNIT: f32 = 34.0;

/// Shows the rows, and `more` rows after those of the material. Modes for which the model (`features`) or the pixel has no data are
/// folded away.
pub(super) fn show(
    ui: &mut Ui,
    reading: &Reading,
    words: &Words,
    modes: &[Mode],
    features: Option<u32>,
    current: &mut String,
    more: impl FnOnce(&mut Ui),
) {
    let is_found = |mode: &Mode| words.is_empty() || words.are_in(&text_of(mode));
    let has_feature = |mode: &Mode| mode.needs == 0 || features.is_none_or(|features| features & mode.needs != 0);
    let (read, unread): (Vec<&Mode>, Vec<&Mode>) =
        modes.iter().partition(|mode| reading.value(&mode.slug).is_some() || !has_feature(mode));
    let found: Vec<&Mode> = read.into_iter().filter(|mode| is_found(mode)).collect();
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if modes.iter().all(|mode| reading.value(&mode.slug).is_none()) {
            ui.label(RichText::new("Reading the pixel…").small().color(QUIET));
            return;
        }
        if found.is_empty() {
            words.no_match(ui, "value");
        }
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut more = Some(more);
        let is_background = reading.is_complete && !reading.is_hit();
        for modes in found.chunk_by(|a, b| a.group == b.group) {
            // Where there is no surface, modes of light show the background, of which the picture has the color. Alpha of a pass is a number
            // as the others.
            let has_data = |mode: &&Mode| {
                let is_seen = !is_background || mode.slug == FINAL;
                reading.value(&mode.slug).is_some_and(|value| reading.is_of_toy || is_seen && has_data(&value))
            };
            let (shown, folded): (Vec<&Mode>, Vec<&Mode>) = modes.iter().copied().partition(has_data);
            ui.add_space(6.0);
            let group = &modes[0].group;
            ui.label(RichText::new(group).small().color(QUIET));
            for mode in shown {
                if row(ui, reading, mode, *current == mode.slug).clicked() {
                    current.clone_from(&mode.slug);
                }
            }
            if !folded.is_empty() {
                let title = RichText::new(format!("{} without data", folded.len())).small().color(QUIET);
                let header = egui::CollapsingHeader::new(title).id_salt(("no values", group));
                let header = header.show_unindented(ui, |ui| {
                    for mode in folded {
                        ui.label(RichText::new(&mode.name).small().color(QUIET)).on_hover_text(&mode.doc);
                    }
                });
                header.header_response.on_hover_text("This pixel has no data for these modes");
            }
            if let Some(more) = more.take_if(|_| group == "Material") {
                more(ui);
            }
        }
        if let Some(more) = more {
            more(ui);
        }
        let left = unread.iter().filter(|mode| is_found(mode)).count();
        if left > 0 && reading.is_complete && !reading.is_of_toy {
            ui.add_space(8.0);
            let text = format!("{left} modes of random paths and passes are not listed here");
            let names = unread.iter().map(|mode| mode.name.as_str()).collect::<Vec<_>>().join(", ");
            let doc =
                format!("Select one of them to see its value under the mouse in the corner of the picture.\n\n{names}");
            ui.label(RichText::new(text).small().color(QUIET)).on_hover_text(doc);
        }
    });
}

/// Whether a value is meaningful: the mode has data here, and something covers the pixel.
fn has_data(value: &PixelValue) -> bool {
    value.not_finite || (!value.no_data && value.value[3] > 0.0)
}

/// A row: swatch, name, numbers and unit. The numbers stand below a name that has no room beside them.
fn row(ui: &mut Ui, reading: &Reading, mode: &Mode, is_current: bool) -> Response {
    let value = reading.value(&mode.slug);
    let text = value.as_ref().map(|value| text::numbers(mode, value)).unwrap_or_default();
    let width = |text: &str, font| ui.painter().layout_no_wrap(text.to_owned(), font, QUIET.color()).size().x;
    let beside = NAME + width(&mode.name, small_font()) + GAP + width(text.trim_start(), small_mono_font()) + UNIT;
    let lines = if beside <= ui.available_width() { 1.0 } else { 2.0 };
    let (whole, response) = ui.allocate_exact_size(vec2(ui.available_width(), lines * HEIGHT), Sense::click());
    spoken::button(&response, &mode.name);
    let Some(value) = value.filter(|_| ui.is_rect_visible(whole)) else { return response };
    let painter = ui.painter();
    if response.hovered() {
        painter.rect_filled(whole, 3.0, EDGE);
    }
    // The line of the numbers, and that of the name.
    let (rect, named) = (whole.with_min_y(whole.max.y - HEIGHT), whole.with_max_y(whole.min.y + HEIGHT));
    let middle = rect.center().y;
    let swatch = pos2(rect.min.x + 0.5 * SWATCH + 1.0, named.center().y);
    let swatch = Rect::from_center_size(swatch, vec2(SWATCH, SWATCH));
    paint_swatch(ui, swatch, mode, &value, reading.exposure);
    let is_old = reading.is_old(&mode.slug);
    let color = match () {
        () if value.not_finite => ERROR.color(),
        () if is_old => QUIET.color(),
        () => ui.visuals().text_color(),
    };
    let unit = ui.painter().layout_no_wrap(with_powers(&mode.unit), small_font(), QUIET.color());
    painter.galley(pos2(rect.max.x - UNIT + 4.0, middle - 0.5 * unit.size().y), unit, QUIET.color());
    let numbers = painter.layout_no_wrap(text, small_mono_font(), color);
    painter.galley(pos2(rect.max.x - UNIT - numbers.size().x, middle - 0.5 * numbers.size().y), numbers, color);
    let name_color = if is_current { ACCENT.color() } else { ui.visuals().text_color() };
    let mut job = LayoutJob::simple_singleline(mode.name.clone(), small_font(), name_color);
    let left = named.min.x + NAME;
    job.wrap = TextWrapping::truncate_at_width(named.max.x - left);
    let name = painter.layout_job(job);
    painter.galley(pos2(left, named.center().y - 0.5 * name.size().y), name, name_color);
    response.on_hover_ui(|ui| about(ui, mode, &value))
}

/// Hover text that describes a row.
fn about(ui: &mut Ui, mode: &Mode, value: &PixelValue) {
    ui.set_max_width(340.0);
    ui.label(RichText::new(&mode.name).strong());
    ui.label(&mode.doc);
    ui.label(RichText::new(value.text(mode).trim().to_owned()).monospace());
    if value.not_finite {
        ui.label(RichText::new("The shader computed NaN or infinity here").color(ERROR));
    }
    ui.label(RichText::new("Click to show this mode").small().color(QUIET));
    ui.label(option_text(&format!("--mode {}", mode.slug)).color(ACCENT));
}

fn paint_swatch(ui: &Ui, rect: Rect, mode: &Mode, value: &PixelValue, exposure: f32) {
    let painter = ui.painter();
    if value.not_finite {
        painter.rect_filled(rect, 2.0, ERROR);
        painter.text(rect.center(), Align2::CENTER_CENTER, "!", small_font(), Color32::BLACK);
        return;
    }
    // The color of a number is that of the picture.
    if mode.numbers.is_some() {
        return;
    }
    let linear = text::swatch(mode, value, exposure);
    // Modes that show data are stored as they are, without the sRGB curve.
    let color = match mode.encode {
        crate::shader::Encode::Color => {
            let [r, g, b] = linear;
            Color32::from(egui::Rgba::from_rgb(r, g, b))
        }
        _ => {
            let [r, g, b] = linear.map(|channel| (channel * 255.0).round() as u8);
            Color32::from_rgb(r, g, b)
        }
    };
    painter.rect_filled(rect, 2.0, color);
    painter.rect_stroke(rect, 2.0, Stroke::new(1.0, Color32::from_gray(70)), StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    /// Where nothing of the model is, the list has the picture's color; other modes of light would tell that of the background.
    #[test]
    fn the_list_of_a_background_pixel_has_the_picture_alone() {
        let mode = |slug: &str, name: &str| Mode {
            slug: slug.to_owned(),
            name: name.to_owned(),
            group: "Light".to_owned(),
            ..Mode::default()
        };
        let modes = [mode(FINAL, "Final"), mode("ambient", "Ambient"), mode("depth", "Depth")];
        let seen = PixelValue { value: [0.5, 0.5, 0.5, 1.0], ..PixelValue::default() };
        let listed = |depth: PixelValue| {
            let values = [(FINAL, seen), ("ambient", seen), ("depth", depth)];
            let reading = Reading::sample(values.map(|(slug, value)| (slug.to_owned(), (value, 1))).into());
            let mut current = String::new();
            let harness = Harness::builder().with_size(vec2(320.0, 300.0)).build_ui(|ui| {
                show(ui, &reading, &Words::default(), &modes, None, &mut current, |_| {});
            });
            let folded = |count: usize| harness.query_by_label(&format!("{count} without data")).is_some();
            let names = ["Final", "Ambient", "Depth"];
            (names.map(|name| harness.query_by_label(name).is_some()), [1, 2].map(folded))
        };
        assert_eq!(listed(PixelValue::default()), ([true, false, false], [false, true]));
        assert_eq!(listed(seen), ([true; 3], [false; 2]), "a pixel of the model");
    }

    /// A long name is never cut: its numbers stand below it.
    #[test]
    fn a_name_without_room_beside_its_numbers_has_a_line_of_its_own() {
        let mode =
            |slug: &str, name: &str| Mode { slug: slug.into(), name: name.into(), components: 3, ..Mode::default() };
        let modes = [mode("a", "Short"), mode("b", "A name of many letters, and more")];
        let value = PixelValue { value: [0.5, 0.5, 0.5, 1.0], ..PixelValue::default() };
        let reading = Reading::sample(["a", "b"].map(|slug| (slug.to_owned(), (value, 1))).into());
        let mut current = String::new();
        let harness = Harness::builder().with_size(vec2(318.0, 300.0)).build_ui(|ui| {
            crate::app::widgets::theme::apply(ui.ctx());
            show(
                ui,
                &Reading { is_of_toy: true, ..reading.clone() },
                &Words::default(),
                &modes,
                None,
                &mut current,
                |_| {},
            );
        });
        let height = |name: &str| harness.get_by_label(name).rect().height();
        assert_eq!((height("Short"), height(&modes[1].name)), (HEIGHT, 2.0 * HEIGHT));
    }

    #[test]
    fn a_pixel_that_nothing_covers_has_no_data() {
        let covered = PixelValue { value: [0.0, 0.0, 0.0, 1.0], ..PixelValue::default() };
        assert!(has_data(&covered) && !has_data(&PixelValue::default()));
        assert!(!has_data(&PixelValue { no_data: true, ..covered }));
        assert!(has_data(&PixelValue { not_finite: true, ..PixelValue::default() }));
    }
}
