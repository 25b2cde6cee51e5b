//! The inspector's plots: the lobe in the plane of incidence, and the albedo over the angle. The values before the last edit are dashed.

use egui::{Align2, Color32, Grid, Response, RichText, Stroke, Ui};
use egui_plot::{Arrows, GridMark, HLine, Line, LineStyle, Plot, PlotPoint, PlotPoints, PlotUi, Text, VLine};

use crate::app::state::inspection::directions::Directions;
use crate::app::widgets::theme::{ACCENT, QUIET, Tone, WARNING, small_font, small_mono};
use crate::measure::{Curves, Lobe, Material};

/// Lines of the grid.
pub(super) const GRID: Tone = Tone::new(0x343434, 0xb4bac2);
/// Height of the polar plot, points.
const TALL: f32 = 150.0;
/// Height of the charts, points.
const LOW: f32 = 110.0;
/// Dashes of the curves before the last edit.
const DASHED: LineStyle = LineStyle::Dashed { length: 5.0 };

/// A part of a lobe: its name, color and meaning.
pub(super) struct Part {
    pub(super) name: &'static str,
    pub(super) color: Tone,
    pub(super) doc: &'static str,
    of: fn(&Lobe) -> [f32; 3],
}

/// The parts of a lobe.
pub(super) const PARTS: [Part; 4] = [
    Part {
        name: "sum",
        color: Tone::new(0xdee0e6, 0x24282d),
        doc: "f NoV: the part of the irradiance that leaves per steradian, 1/sr. Its integral over the hemisphere is the albedo",
        of: |lobe| std::array::from_fn(|c| lobe.diffuse[c] + lobe.specular[c] + lobe.multiple[c]),
    },
    Part {
        name: "diffuse",
        color: Tone::new(0xf08c42, 0xa85400),
        doc: "k_d times the selected diffuse model",
        of: |lobe| lobe.diffuse,
    },
    Part {
        name: "specular",
        color: Tone::new(0x62a0ff, 0x1a5fc4),
        doc: "D V F: single scattering between microfacets",
        of: |lobe| lobe.specular,
    },
    Part {
        name: "multiple scattering",
        color: Tone::new(0x62c884, 0x1d7a3c),
        doc: "Multiple scattering between microfacets",
        of: |lobe| lobe.multiple,
    },
];

/// The current values, and those before the last edit.
pub(super) struct Pair<'a, T: ?Sized> {
    pub(super) now: &'a T,
    pub(super) before: Option<&'a T>,
}

impl<'a, T: ?Sized> Pair<'a, T> {
    /// Both, the older first, and whether each is drawn with dashes.
    fn each(&self) -> impl Iterator<Item = (&'a T, bool)> + use<'a, T> {
        self.before.into_iter().map(|before| (before, true)).chain([(self.now, false)])
    }
}

/// The lobe in the plane of incidence, with the directions to the light and to the eye.
pub(super) fn polar(ui: &mut Ui, curves: &Pair<'_, Curves>, of: &Material, directions: &Directions) {
    let values = curves.each().flat_map(|(curves, _)| &curves.lobes).map(|lobe| luminance((PARTS[0].of)(lobe)));
    let most = f64::from(values.filter(|value| value.is_finite()).fold(0.0, f32::max));
    let rim = if most > 0.0 { 1.1 * most } else { 1.0 };
    let plot = plain("lobe", TALL).data_aspect(1.0).show_axes(false).show_grid(false);
    let plot = plot.include_x(-1.2 * rim).include_x(1.2 * rim).include_y(-0.14 * rim).include_y(1.16 * rim);
    let shown = plot.show(ui, |plot| {
        half_disk(plot, rim);
        for (curves, is_dashed) in curves.each() {
            for part in &PARTS {
                let point = |(index, lobe): (usize, &Lobe)| {
                    place(angle_deg(index, curves.lobes.len()), luminance((part.of)(lobe)).into())
                };
                let points: Vec<_> = curves.lobes.iter().enumerate().map(point).collect();
                curve(plot, part.name, part.color, &points, is_dashed);
            }
        }
        arrows(plot, rim, of, directions);
        plot.pointer_coordinate()
    });
    // Right is positive.
    let at = shown.inner.map(|at| at.x.atan2(at.y).to_degrees().clamp(-90.0, 90.0));
    values_of_lobe(&shown.response, curves, at);
}

/// A plot without egui_plot's interactions: values come as a hover text, and the wheel scrolls the panel.
fn plain<'a>(name: &str, height: f32) -> Plot<'a> {
    let plot = Plot::new(name).height(height).allow_scroll(false).show_background(false);
    plot.label_formatter(|_| None).show_x(false).show_y(false).show_crosshair(false)
}

/// Angle of a direction of the lobe from the normal, degrees; positive is right.
fn angle_deg(index: usize, count: usize) -> f64 {
    180.0 * ((index as f64 + 0.5) / count.max(1) as f64 - 0.5)
}

/// The place of a value in the direction of its angle from the normal, which is up.
fn place(deg: f64, value: f64) -> [f64; 2] {
    let (sin, cos) = deg.to_radians().sin_cos();
    [value * sin, value * cos]
}

/// Draws the rim, half of it, and the angles.
fn half_disk(plot: &mut PlotUi<'_>, rim: f64) {
    let mut line = |points: Vec<[f64; 2]>| plot.line(Line::new("", points).color(GRID).width(1.0).allow_hover(false));
    for part in [0.5, 1.0] {
        line((-18..=18).map(|step| place(5.0 * f64::from(step), part * rim)).collect());
    }
    let angles = [-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0_f64];
    angles.into_iter().for_each(|deg| line(vec![[0.0, 0.0], place(deg, rim)]));
    for deg in angles.into_iter().filter(|deg| deg.abs() < 90.0) {
        note(plot, place(deg, 1.08 * rim), Align2::CENTER_CENTER, format!("{:.0}°", deg.abs()), QUIET.color());
    }
    for (part, unit) in [(0.5, ""), (1.0, " 1/sr")] {
        let text = format!("{}{unit}", short(part * rim));
        note(plot, [part * rim, -0.02 * rim], Align2::CENTER_TOP, text, QUIET.color());
    }
}

/// Draws the directions to the light and to the eye, with their names.
fn arrows(plot: &mut PlotUi<'_>, rim: f64, of: &Material, directions: &Directions) {
    let mut arrow = |deg: f64, color: Color32, (name, at): (&str, f64), inwards: bool| {
        let (near, far) = (place(deg, 0.25 * rim), place(deg, 0.92 * rim));
        let (from, to) = if inwards { (far, near) } else { (near, far) };
        plot.arrows(Arrows::new(name, vec![from], vec![to]).color(color).tip_length(7.0).allow_hover(false));
        note(plot, place(deg, at * rim), Align2::CENTER_CENTER, name.to_owned(), color);
    };
    // The names are at different distances, since both directions may be on one side.
    arrow(-f64::from(of.light_deg), WARNING.color(), ("light", 0.8), true);
    let name = if directions.is_in_plane() { "eye" } else { "eye (out of plane)" };
    arrow(f64::from(directions.in_plane_deg().clamp(-90.0, 90.0)), ACCENT.color(), (name, 0.5), false);
}

/// The values of the lobe at an angle, as a hover text.
fn values_of_lobe(response: &Response, curves: &Pair<'_, Curves>, at: Option<f64>) {
    let count = curves.now.lobes.len();
    let Some(deg) = at.filter(|_| count > 0) else { return };
    let index = (((deg / 180.0 + 0.5) * count as f64) as usize).min(count - 1);
    response.clone().on_hover_ui_at_pointer(|ui| {
        let angle = angle_deg(index, count);
        ui.label(RichText::new(format!("f NoV at {angle:.1}°, 1/sr (luminance)")).small());
        Grid::new("lobe values").num_columns(3).show(ui, |ui| {
            for part in &PARTS {
                ui.label(RichText::new(part.name).small().color(part.color));
                for (title, of) in [("now", Some(curves.now)), ("before", curves.before)] {
                    let Some(lobe) = of.and_then(|of| of.lobes.get(index)) else { continue };
                    let value = luminance((part.of)(lobe));
                    ui.label(small_mono(format!("{title} {value:.4}")));
                }
                ui.end_row();
            }
        });
    });
}

/// A chart of albedo over the angle of the eye from the normal.
pub(super) fn albedo(ui: &mut Ui, name: &str, values: &Pair<'_, [[f32; 3]]>, eye_deg: f32) {
    let all = values.each().flat_map(|(values, _)| values).flatten().copied().filter(|value| value.is_finite());
    let most = all.fold(1.1, |most: f32, value| most.max(1.05 * value));
    let plot = plain(name, LOW).include_x(-3.0).include_x(95.0).include_y(0.0).include_y(most).y_axis_min_width(26.0);
    let marks = |_| [0.0, 30.0, 60.0, 90.0].map(|value| GridMark { value, step_size: 30.0 }).to_vec();
    let plot = plot.x_grid_spacer(marks).x_axis_formatter(|mark, _| format!("{:.0}°", mark.value));
    let shown = plot.set_margin_fraction(egui::Vec2::ZERO).grid_color(GRID.color()).show(ui, |plot| {
        plot.hline(HLine::new("1", 1.0).color(QUIET).width(1.0).allow_hover(false));
        plot.vline(VLine::new("eye", eye_deg.clamp(0.0, 90.0)).color(ACCENT).width(1.0).allow_hover(false));
        for (values, is_dashed) in values.each() {
            channels(plot, values, is_dashed);
        }
        plot.pointer_coordinate()
    });
    let Some(at) = shown.inner else { return };
    let nearest = (0..values.now.len()).min_by(|a, b| {
        let apart = |index: &usize| (f64::from(Curves::angle_deg(*index)) - at.x).abs();
        apart(a).total_cmp(&apart(b))
    });
    let Some(index) = nearest else { return };
    shown.response.on_hover_ui_at_pointer(|ui| {
        let text = |values: &[[f32; 3]]| {
            values.get(index).map(|[r, g, b]| format!("{r:.4} {g:.4} {b:.4}")).unwrap_or_default()
        };
        let now = format!("{:>3.0}°    now {}", Curves::angle_deg(index), text(values.now));
        ui.label(small_mono(now));
        if let Some(before) = values.before {
            ui.label(small_mono(format!("     before {}", text(before))));
        }
    });
}

/// Draws the channels, or one line where they are equal.
fn channels(plot: &mut PlotUi<'_>, values: &[[f32; 3]], is_dashed: bool) {
    let colors = [Tone::new(0xff6961, 0xb8241c), Tone::new(0x77dd77, 0x1d7a3c), Tone::new(0x6ea0ff, 0x1a5fc4)];
    let is_gray = values.iter().all(|[r, g, b]| (r - g).abs().max((r - b).abs()) < 2e-3);
    for (channel, color) in colors.into_iter().enumerate().take(if is_gray { 1 } else { 3 }) {
        let point = |(index, rgb): (usize, &[f32; 3])| [Curves::angle_deg(index).into(), rgb[channel].into()];
        let points: Vec<[f64; 2]> = values.iter().enumerate().map(point).collect();
        curve(plot, "albedo", if is_gray { PARTS[0].color } else { color }, &points, is_dashed);
    }
}

/// Draws a line through points. Non-finite points interrupt it.
fn curve(plot: &mut PlotUi<'_>, name: &str, color: Tone, points: &[[f64; 2]], is_dashed: bool) {
    let (width, style) = if is_dashed { (1.2, DASHED) } else { (1.6, LineStyle::Solid) };
    for part in points.split(|[x, y]| !x.is_finite() || !y.is_finite()) {
        if part.len() > 1 {
            let line = Line::new(name, PlotPoints::from(part.to_vec())).stroke(Stroke::new(width, color));
            plot.line(line.style(style).allow_hover(false));
        }
    }
}

/// A small label in a plot.
fn note(plot: &mut PlotUi<'_>, [x, y]: [f64; 2], anchor: Align2, text: String, color: Color32) {
    let text = RichText::new(text).font(small_font());
    plot.text(Text::new("", PlotPoint::new(x, y), text).color(color).anchor(anchor).allow_hover(false));
}

/// Luminance Y of linear RGB (ITU-R BT.709).
pub(super) fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A short number, for the axis of a plot.
fn short(number: f64) -> String {
    match number.abs() {
        magnitude if magnitude >= 100.0 => format!("{number:.0}"),
        magnitude if magnitude >= 10.0 => format!("{number:.1}"),
        magnitude if magnitude >= 0.01 || magnitude == 0.0 => format!("{number:.2}"),
        _ => format!("{number:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_is_up_and_the_mirror_direction_right() {
        let close = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9;
        assert!(close(place(0.0, 2.0), [0.0, 2.0]) && close(place(90.0, 1.0), [1.0, 0.0]));
        assert!(close(place(-90.0, 2.0), [-2.0, 0.0]));
        assert!((angle_deg(0, 180) + 89.5).abs() < 1e-9 && (angle_deg(179, 180) - 89.5).abs() < 1e-9);
    }

    #[test]
    fn scales_are_short() {
        assert_eq!([0.0, 0.324, 12.34, 250.4].map(short), ["0.00", "0.32", "12.3", "250"].map(str::to_owned));
    }
}
