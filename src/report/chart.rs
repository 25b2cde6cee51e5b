//! Tables of numbers in colors, and charts of lines.

use std::fmt::Write as _;

use super::encode::escaped;

/// Width and height of a chart, and its margins: left, top, right, bottom.
const SIZE: (f64, f64) = (760.0, 320.0);
const MARGINS: [f64; 4] = [64.0, 14.0, 150.0, 44.0];
/// About how many lines a grid has along an axis.
const STEPS: f64 = 5.0;
/// Colors of lines, one after the other. Readable on light and dark.
const INKS: [&str; 6] = ["#2468d6", "#e06c20", "#22965c", "#b03070", "#8a6d1f", "#6a4fc0"];

/// A table of numbers in colors: white at `middle`, blue below, red above.
#[derive(Clone, Debug)]
pub struct Heat {
    /// Meaning of the numbers.
    pub title: String,
    /// Meaning of the rows and of the columns.
    pub axes: [String; 2],
    /// The names of the rows.
    pub rows: Vec<String>,
    /// The names of the columns.
    pub columns: Vec<String>,
    /// The numbers, row by row.
    pub values: Vec<f64>,
    /// The number without a color.
    pub middle: f64,
    /// The distance to `middle` with the full color.
    pub span: f64,
}

impl Heat {
    pub(super) fn html(&self) -> String {
        let [rows, columns] = self.axes.each_ref().map(|axis| escaped(axis));
        let head: String = self.columns.iter().map(|name| format!("<th>{}</th>", escaped(name))).collect();
        let mut body = String::new();
        for (name, values) in self.rows.iter().zip(self.values.chunks(self.columns.len().max(1))) {
            let cells: String = values.iter().map(|value| self.cell(*value)).collect();
            let _ = writeln!(body, "<tr><th>{}</th>{cells}</tr>", escaped(name));
        }
        format!(
            "<table class=\"heat\"><caption>{}</caption><thead><tr><th title=\"rows: {rows}; columns: {columns}\">{rows} \\ {columns}</th>{head}</tr></thead>\
             <tbody>\n{body}</tbody></table>",
            escaped(&self.title),
        )
    }

    fn cell(&self, value: f64) -> String {
        if !value.is_finite() {
            return format!("<td class=\"bad\">{value}</td>");
        }
        let share = ((value - self.middle) / self.span).clamp(-1.0, 1.0);
        let color = if share > 0.0 { "200,40,30" } else { "40,110,220" };
        format!("<td style=\"background:rgba({color},{:.2})\">{value:.3}</td>", 0.85 * share.abs())
    }
}

/// A line of a chart.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name.
    pub name: String,
    /// Its points, from the left. One that is not finite interrupts it.
    pub points: Vec<(f64, f64)>,
}

/// A chart of lines.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Its heading.
    pub title: String,
    /// Name of the axis to the right, with the unit.
    pub x: String,
    /// The same, upwards.
    pub y: String,
    /// The lines.
    pub series: Vec<Series>,
    /// The least range of the upward axis, so that noise does not fill the chart.
    pub least: f64,
}

impl Lines {
    pub(super) fn html(&self) -> String {
        let [left, top, right, bottom] = MARGINS;
        let (width, height) = (SIZE.0 - left - right, SIZE.1 - top - bottom);
        let points = || self.series.iter().flat_map(|series| series.points.iter()).filter(|at| at.1.is_finite());
        let [across, up] = [axis(points().map(|at| at.0), 0.0), axis(points().map(|at| at.1), self.least)];
        let x = |value: f64| left + width * across.share(value);
        let y = |value: f64| top + height * (1.0 - up.share(value));
        let mut svg = String::new();
        for value in across.ticks() {
            let (at, end) = (x(value), top + height);
            let _ = write!(svg, "<path class=\"grid\" d=\"M{at:.1} {top}V{end}\"/>");
            let _ = write!(
                svg,
                "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                end + 16.0,
                across.text(value)
            );
        }
        for value in up.ticks() {
            let (at, end) = (y(value), left + width);
            let _ = write!(svg, "<path class=\"grid\" d=\"M{left} {at:.1}H{end}\"/>");
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                left - 6.0,
                at + 4.0,
                up.text(value)
            );
        }
        for (index, series) in self.series.iter().enumerate() {
            let ink = INKS[index % INKS.len()];
            let mut path = String::new();
            let mut is_first = true;
            for (across, up) in &series.points {
                if !up.is_finite() {
                    is_first = true;
                    continue;
                }
                let _ = write!(path, "{}{:.1} {:.1}", if is_first { "M" } else { "L" }, x(*across), y(*up));
                is_first = false;
            }
            let _ = write!(svg, "<path class=\"line\" stroke=\"{ink}\" d=\"{path}\"/>");
            let (at, line) = (left + width + 14.0, top + 14.0 + 19.0 * index as f64);
            let _ = write!(svg, "<path class=\"line\" stroke=\"{ink}\" d=\"M{at} {:.1}h18\"/>", line - 4.0);
            let _ = write!(svg, "<text x=\"{}\" y=\"{line}\">{}</text>", at + 24.0, escaped(&series.name));
        }
        let middle = left + width / 2.0;
        let _ = write!(
            svg,
            "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            SIZE.1 - 6.0,
            escaped(&self.x)
        );
        let place = top + height / 2.0;
        let _ = write!(
            svg,
            "<text transform=\"translate(14 {place}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            escaped(&self.y)
        );
        let title = escaped(&self.title);
        format!(
            "<figure class=\"chart\"><figcaption>{title}</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{title}\">{svg}</svg></figure>",
            SIZE.0, SIZE.1
        )
    }
}

/// The range of an axis, with round ends and steps.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

/// An axis that holds these numbers, with this range at least.
fn axis(numbers: impl Iterator<Item = f64>, least: f64) -> Axis {
    let (low, high) = numbers.fold((f64::MAX, f64::MIN), |(low, high), n| (low.min(n), high.max(n)));
    let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
    // Equal numbers have room on both sides.
    let room = if high - low > 1e-9 * high.abs().max(1e-9) { 0.0 } else { 0.1 * high.abs().max(1e-3) };
    let room = room.max((least - (high - low)) / 2.0);
    let (low, high) = (low - room, high + room);
    let rough = (high - low) / STEPS;
    let power = 10_f64.powf(rough.log10().floor());
    let step =
        [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    Axis { low: (low / step).floor() * step, high: (high / step).ceil() * step, step }
}

impl Axis {
    /// Where a number lies: 0 at the lower end, 1 at the upper.
    fn share(self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    fn ticks(self) -> impl Iterator<Item = f64> {
        let count = ((self.high - self.low) / self.step).round() as u32;
        (0..=count).map(move |index| self.low + self.step * f64::from(index))
    }

    /// A number with as many decimals as the steps need.
    fn text(self, value: f64) -> String {
        let decimals = (-self.step.log10().floor()).clamp(0.0, 9.0) as usize;
        // Without the sum, a number that rounds to 0 from below has a sign.
        format!("{:.decimals$}", (value / self.step).round() * self.step + 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_round_ends_that_hold_all_numbers() {
        let found = axis([0.93, 1.004].into_iter(), 0.0);
        assert_eq!((found.text(found.low), found.text(found.high)), ("0.92".into(), "1.02".into()));
        let texts: Vec<String> = found.ticks().map(|tick| found.text(tick)).collect();
        assert_eq!(texts, ["0.92", "0.94", "0.96", "0.98", "1.00", "1.02"]);
        assert_eq!(axis(std::iter::empty(), 0.0).share(1.0), 1.0);
        let equal = axis([1.0, 1.0].into_iter(), 0.0);
        assert!(equal.low < 1.0 && equal.high > 1.0 && equal.ticks().count() > 2, "{equal:?}");
        let noise = axis([0.9999, 1.0001].into_iter(), 0.1);
        assert!(noise.low <= 0.95 && noise.high >= 1.05, "{noise:?}");
        let below = axis([-0.5, 0.5].into_iter(), 0.0);
        assert!(below.ticks().any(|tick| below.text(tick) == "0.0"), "{below:?}");
    }

    #[test]
    fn colors_say_on_which_side_of_the_middle_a_number_lies() {
        let heat = Heat {
            title: "Albedo".into(),
            axes: ["roughness".into(), "angle".into()],
            rows: vec!["0.1".into()],
            columns: ["0", "45", "85", "89"].map(String::from).to_vec(),
            values: vec![1.0, 0.9, 1.2, f64::NAN],
            middle: 1.0,
            span: 0.1,
        };
        let html = heat.html();
        for cell in [
            "rgba(40,110,220,0.00)\">1.000",
            "rgba(40,110,220,0.85)\">0.900",
            "rgba(200,40,30,0.85)\">1.200",
            "class=\"bad\">NaN",
        ] {
            assert!(html.contains(cell), "{cell}: {html}");
        }
    }
}
