//! The legend over the picture: the mode's name and unit, the range of values and the colors that stand for them, the channels, a
//! histogram, and the value under the mouse.

use clap::ValueEnum as _;
use egui::{Button, Color32, Mesh, Rect, RichText, Sense, Stroke, TextStyle, Ui, pos2, vec2};

use super::card::wrapped;
use super::swatches;
use crate::app::readings::{LegendOf, Readout};
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{QUIET, icon, small_mono, small_mono_font};
use crate::app::widgets::with_powers;
use crate::frame::{Limits, legend_limits, short};
use crate::interface::COLORMAP_STEPS;
use crate::settings::{Channels, Colormap, ViewRange, ViewSettings, choice_name};

/// Size of the color bar in points.
const BAR: egui::Vec2 = vec2(132.0, 9.0);
/// Size of the histogram in points.
const HISTOGRAM: egui::Vec2 = vec2(264.0, 44.0);
/// Steps of the histogram.
const BINS: usize = 88;
/// Stops around middle gray in the histogram of light.
const STOPS: f32 = 8.0;
const MIDDLE_GRAY: f32 = 0.18;

/// Contents of the legend for the picture on screen.
pub(in crate::app) struct Legend<'a> {
    pub(in crate::app) title: Option<&'a str>,
    pub(in crate::app) of: &'a LegendOf,
    /// The value under the mouse.
    pub(in crate::app) value: Option<&'a Readout>,
}

/// State of the legend between frames.
#[derive(Default)]
pub(in crate::app) struct LegendState {
    /// Whether the histogram is open.
    pub(in crate::app) shows_histogram: bool,
    /// The counts of a picture, with its number and what places its values.
    counts: Option<(u64, Axis, [Vec<u32>; 3])>,
}

/// The horizontal axis of the histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    /// Values between two limits.
    Linear(Limits),
    /// Stops around middle gray, with this exposure.
    Stops(f32),
}

impl Axis {
    fn place(self, value: f32) -> f32 {
        match self {
            Self::Linear((low, high)) => (value - low) / (high - low),
            Self::Stops(exposure) => {
                let stops = (value * exposure / MIDDLE_GRAY).max(f32::MIN_POSITIVE).log2();
                0.5 + 0.5 * stops / STOPS
            }
        }
    }

    /// The numbers at both ends.
    fn ends(self) -> [String; 2] {
        match self {
            Self::Linear((low, high)) => [short(low), short(high)],
            Self::Stops(_) => [format!("-{STOPS} EV"), format!("+{STOPS} EV")],
        }
    }
}

impl Legend<'_> {
    /// Whether the legend shows more than the value under the mouse.
    pub(super) fn is_whole(&self, view: &ViewSettings, state: &LegendState) -> bool {
        // The final picture needs no explanation.
        let is_plain = self.of.mode.slug == "final" && view.channels == Channels::Rgb && self.of.limits.is_none();
        !is_plain || state.shows_histogram
    }

    /// The range of values that the display shows.
    fn shown(&self) -> Option<Limits> {
        legend_limits(&self.of.mode, self.of.limits)
    }
}

/// Shows the legend in a card as wide as `width` at most.
pub(in crate::app) fn show(
    ui: &mut Ui,
    legend: &Legend<'_>,
    view: &mut ViewSettings,
    state: &mut LegendState,
    width: f32,
) {
    if legend.is_whole(view, state) {
        heading(ui, legend, width);
        // Colors that stand for numbers have no range.
        if legend.of.mode.numbers.is_none() {
            ui.horizontal(|ui| range(ui, legend, view));
        } else if view.channels == Channels::Rgb {
            // A single channel is gray.
            ui.scope(|ui| swatches::show(ui, &legend.of.swatches));
        }
        // Nor do they have channels.
        if legend.of.mode.numbers.is_none() || view.channels != Channels::Rgb {
            ui.horizontal(|ui| channels(ui, legend, view, state));
        }
        if state.shows_histogram {
            histogram(ui, legend, view, state);
        }
    }
    if let Some(readout) = legend.value {
        value(ui, readout, width);
    }
}

/// The value under the mouse, and below it the side of a comparison, the unit and the pixel.
fn value(ui: &mut Ui, Readout { side, value, unit, at: (x, y) }: &Readout, width: f32) {
    let mono = TextStyle::Monospace.resolve(ui.style());
    ui.label(wrapped(ui, value, mono, ui.visuals().text_color(), width));
    let parts = [side.clone().unwrap_or_default(), with_powers(unit.trim()), format!("at {x}, {y}")];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    ui.label(wrapped(ui, &parts.join("  ·  "), small_mono_font(), QUIET.color(), width));
}

/// The name of the mode with its unit.
fn heading(ui: &mut Ui, legend: &Legend<'_>, width: f32) {
    let (body, strong) = (TextStyle::Body.resolve(ui.style()), ui.visuals().strong_text_color());
    // The mouse may be on another mode of the grid.
    let title = legend.title.filter(|title| title.starts_with(&legend.of.mode.name)).unwrap_or(&legend.of.mode.name);
    let unit = with_powers(&legend.of.mode.unit);
    let unit = if unit.is_empty() { unit } else { format!("  ·  {unit}") };
    let title = wrapped(ui, &format!("{title}{unit}"), body, strong, width);
    ui.label(title).on_hover_text(&legend.of.mode.doc);
}

/// The color bar between its limits, and how these are determined.
fn range(ui: &mut Ui, legend: &Legend<'_>, view: &mut ViewSettings) {
    match legend.shown() {
        Some((low, high)) => {
            ui.label(RichText::new(short(low)).monospace().small());
            bar(ui, legend);
            ui.label(RichText::new(short(high)).monospace().small());
        }
        None => {
            // Adding 0 takes the sign from a number that rounds to -0.
            let ev = (-10.0 * view.ev).round() / 10.0 + 0.0;
            let text = format!("{ev:+.1} EV · {}", choice_name(&view.tonemap));
            let label = ui.label(RichText::new(text).monospace().small());
            label.on_hover_text("Exposure compensation and tone map of this light");
        }
    }
    let (name, doc) = match (view.range, legend.of.limits) {
        (ViewRange::Mode, _) => ("mode", "The range of the mode, as `render` stores it"),
        (ViewRange::Auto, Some(_)) if legend.of.mode.range.is_none() => {
            ("auto", "The range follows the picture: 1 % of the values lie below it, 1 % above")
        }
        (ViewRange::Auto, _) => ("auto", "The range of the mode"),
        (ViewRange::Fit, _) => ("fit", "The range follows the picture, even in modes that have a range of their own"),
        (ViewRange::Fixed(..), _) => ("set", "The range that you set"),
    };
    let menu = ui.menu_button(RichText::new(name).small(), |ui| {
        for (range, text, doc) in [
            (
                ViewRange::Auto,
                "Automatic",
                "Fit to the picture where values have a unit or leave 0 to 1, and for a watched expression",
            ),
            (
                ViewRange::Mode,
                "As the mode stores it",
                "0 to 1, vectors -1 to 1, light exposed: as `render` writes them",
            ),
            (ViewRange::Fit, "Fit to this picture", "Fit to the picture in every mode, light too"),
        ] {
            if ui.selectable_label(view.range == range, text).on_hover_text(doc).clicked() {
                view.range = range;
                ui.close();
            }
        }
        if let Some((low, high)) = legend.of.limits {
            let keep = ui.button(format!("Keep {} to {}", short(low), short(high)));
            if keep.on_hover_text("Set this range, so that it stays when the picture changes").clicked() {
                view.range = ViewRange::Fixed(low, high);
                ui.close();
            }
        }
    });
    menu.response.on_hover_text(format!("{doc}\n--set view.range={}", view.range));
}

/// The colors that stand for the values.
fn bar(ui: &mut Ui, legend: &Legend<'_>) {
    let (rect, response) = ui.allocate_exact_size(BAR, Sense::hover());
    let mut mesh = Mesh::default();
    for (index, color) in legend.of.colormap.colors().into_iter().enumerate() {
        let x = egui::lerp(rect.x_range(), index as f32 / (COLORMAP_STEPS - 1) as f32);
        let color = Color32::from(egui::Rgba::from_rgb(color[0], color[1], color[2]));
        mesh.colored_vertex(pos2(x, rect.min.y), color);
        mesh.colored_vertex(pos2(x, rect.max.y), color);
        if index > 0 {
            let at = 2 * index as u32;
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at, at + 1);
        }
    }
    ui.painter().add(mesh);
    response.on_hover_text(
        "The colors of the values between the two numbers. The readout at the mouse still shows the raw value",
    );
}

/// Switches of the channels, the colormap and the histogram.
fn channels(ui: &mut Ui, legend: &Legend<'_>, view: &mut ViewSettings, state: &mut LegendState) {
    ui.spacing_mut().item_spacing.x = 2.0;
    for (channel, name, doc) in [
        (Channels::Rgb, "RGB", "All channels"),
        (Channels::R, "R", "The first channel: red, or x"),
        (Channels::G, "G", "The second channel: green, or y"),
        (Channels::B, "B", "The third channel: blue, or z"),
        (Channels::A, "A", "Coverage: 1 where the model covers the whole pixel"),
    ] {
        let button = Button::selectable(view.channels == channel, small_mono(name));
        let response = ui.add(button);
        if response.on_hover_text(format!("{doc}\n--set view.channels={}", choice_name(&channel))).clicked() {
            view.channels = channel;
        }
    }
    ui.add_space(4.0);
    let is_number = legend.of.mode.components == 1 || view.channels != Channels::Rgb;
    ui.add_enabled_ui(is_number, |ui| {
        let menu = ui.menu_button(RichText::new(choice_name(&legend.of.colormap)).small(), |ui| {
            for map in Colormap::value_variants() {
                let name = if *map == Colormap::None { "none (as in the mode)".to_owned() } else { choice_name(map) };
                if ui.selectable_label(view.colormap == *map, name).clicked() {
                    view.colormap = *map;
                    ui.close();
                }
            }
        });
        let doc = "Colors that stand for a number: in modes with one component, and for a single channel";
        menu.response.on_hover_text(doc).on_disabled_hover_text(format!("{doc}. Choose R, G or B first"));
    });
    let histogram = Button::selectable(state.shows_histogram, icon::CHART_BAR);
    if named(ui.add(histogram), "Histogram").on_hover_text("How often each value occurs in the picture").clicked() {
        state.shows_histogram ^= true;
    }
}

/// The histogram of the values.
fn histogram(ui: &mut Ui, legend: &Legend<'_>, view: &ViewSettings, state: &mut LegendState) {
    let (rect, response) = ui.allocate_exact_size(HISTOGRAM, Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let Some(range_sample) = &legend.of.range_sample else { return };
    let axis = legend.shown().map_or(Axis::Stops(legend.of.exposure), Axis::Linear);
    let is_known = |(picture, of, _): &&(u64, Axis, _)| *picture == range_sample.picture && *of == axis;
    if state.counts.as_ref().filter(is_known).is_none() {
        let counts = range_sample.histogram(BINS, |value| axis.place(value));
        state.counts = Some((range_sample.picture, axis, counts));
    }
    let Some((.., counts)) = &state.counts else { return };
    let shown: Vec<(usize, Color32)> = match (legend.of.mode.components, view.channels) {
        (_, Channels::R) | (1, _) => vec![(0, Color32::from_gray(170))],
        (_, Channels::G) => vec![(1, Color32::from_gray(170))],
        (_, Channels::B) => vec![(2, Color32::from_gray(170))],
        (components, _) => [0xe0_50_50, 0x50_c0_60, 0x50_80_f0_u32][..usize::from(components.clamp(1, 3))]
            .iter()
            .map(|hex| Color32::from_rgb((hex >> 16) as u8, (hex >> 8) as u8, *hex as u8))
            .enumerate()
            .collect(),
    };
    // Values beyond the ends are counted there, and would leave no height to the others.
    let most = shown.iter().flat_map(|(channel, _)| &counts[*channel][1..BINS - 1]).max().copied().unwrap_or(0).max(1);
    for (channel, color) in &shown {
        let color = color.gamma_multiply(if shown.len() > 1 { 0.6 } else { 1.0 });
        for (bin, count) in counts[*channel].iter().enumerate().filter(|(_, count)| **count > 0) {
            let height = (*count as f32 / most as f32).min(1.0).sqrt() * rect.height();
            let x = egui::lerp(rect.x_range(), (bin as f32 + 0.5) / BINS as f32);
            let width = rect.width() / BINS as f32;
            let column =
                Rect::from_min_max(pos2(x - 0.5 * width, rect.max.y - height), pos2(x + 0.5 * width, rect.max.y));
            painter.rect_filled(column, 0.0, color);
        }
    }
    painter.rect_stroke(rect, 2.0, Stroke::new(1.0, Color32::from_gray(70)), egui::StrokeKind::Inside);
    ui.horizontal(|ui| {
        ui.set_width(HISTOGRAM.x);
        let [low, high] = axis.ends();
        ui.label(RichText::new(low).monospace().small().color(QUIET));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new(high).monospace().small().color(QUIET));
        });
    });
    let axis = if legend.shown().is_some() { "value" } else { "stops from middle gray after exposure" };
    response.on_hover_text(format!(
        "Horizontal: {axis}; the outer columns also count all values beyond. Vertical: square root of the count"
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_gray_is_in_the_middle() {
        let axis = Axis::Stops(1.0 / 1.2);
        assert!((axis.place(0.18 * 1.2) - 0.5).abs() < 1e-6);
        assert!(axis.place(0.0) < 0.0 && axis.place(1e9) > 1.0);
    }
}
