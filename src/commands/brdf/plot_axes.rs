//! The axes of `specula brdf plot`: a half disk of directions, and a chart of the albedo over the angle.

use super::canvas::{Anchor, Canvas, Ink, pen};

/// Color of text and axes.
pub const TEXT: Ink = Ink(40, 44, 52, 255);
const FAINT: Ink = Ink(120, 126, 136, 255);
const GRID: Ink = Ink(222, 225, 230, 255);
const LIGHT: Ink = Ink(214, 158, 0, 255);
const SMALL: f32 = 14.0;

/// A polar plot of directions in the plane of incidence. The radial scale is linear near 0 and logarithmic beyond.
#[derive(Clone, Copy, Debug)]
pub struct HalfDisk {
    /// The point on the surface, pixels.
    pub center: (f32, f32),
    /// Pixels.
    pub radius: f32,
    /// The value at the rim, 1/sr.
    pub most: f32,
}

impl HalfDisk {
    /// Where the scale changes from linear to logarithmic, 1/sr.
    pub const BEND: f32 = 0.01;

    /// The position of a value at an angle from the normal (radians, positive to the right).
    pub fn at(&self, angle: f32, value: f32) -> (f32, f32) {
        let part = (value.max(0.0) / Self::BEND).ln_1p() / (self.most / Self::BEND).ln_1p();
        self.polar(angle, part.min(1.0))
    }

    fn polar(&self, angle: f32, part: f32) -> (f32, f32) {
        let radius = self.radius * part;
        (self.center.0 + radius * angle.sin(), self.center.1 - radius * angle.cos())
    }

    /// Draws rings at powers of ten, spokes every 30 degrees, and the surface.
    pub fn draw_axes(&self, canvas: &mut Canvas) {
        let arc: Vec<f32> = (-90_i16..=90).step_by(2).map(|degrees| f32::from(degrees).to_radians()).collect();
        let mut ring = 0.1;
        let circle = |value: f32| arc.iter().map(|angle| self.at(*angle, value)).collect::<Vec<_>>();
        canvas.line(&circle(self.most), pen(GRID, 1.2));
        while ring <= self.most {
            canvas.line(&circle(ring), pen(GRID, 1.2));
            let (x, y) = self.at(90_f32.to_radians(), ring);
            canvas.text((x, y + 17.0), SMALL, Anchor::Center, FAINT, &ring_label(ring));
            ring *= 10.0;
        }
        for degrees in [-60_i16, -30, 0, 30, 60] {
            let angle = f32::from(degrees).to_radians();
            canvas.line(&[self.center, self.polar(angle, 1.0)], pen(GRID, 1.2));
            let (x, y) = self.polar(angle, 1.0 + 14.0 / self.radius);
            canvas.text((x, y + 4.0), SMALL, Anchor::Center, FAINT, &format!("{}°", degrees.abs()));
        }
        let (left, right) = (self.polar(-90_f32.to_radians(), 1.0), self.polar(90_f32.to_radians(), 1.0));
        canvas.line(&[left, right], pen(TEXT, 1.6));
    }

    /// Draws the light as an arrow, at an angle to the left of the normal.
    pub fn draw_light(&self, canvas: &mut Canvas, angle_deg: f32) {
        canvas.arrow(self.polar(-angle_deg.to_radians(), 1.0), self.center, pen(LIGHT, 2.4));
    }
}

fn ring_label(ring: f32) -> String {
    if ring < 0.5 { "0.1".into() } else { format!("{ring:.0}") }
}

/// A chart of the albedo over the angle to the normal, 0 to 90 degrees.
#[derive(Clone, Copy, Debug)]
pub struct Chart {
    /// Upper left corner.
    pub origin: (f32, f32),
    /// Width and height.
    pub size: (f32, f32),
    /// The albedo at the upper edge.
    pub most: f32,
}

impl Chart {
    /// The position of an albedo at an angle, degrees.
    pub fn at(&self, angle_deg: f32, albedo: f32) -> (f32, f32) {
        let (x, y) = self.origin;
        let part = (albedo / self.most).clamp(0.0, 1.0);
        (x + self.size.0 * angle_deg / 90.0, y + self.size.1 * (1.0 - part))
    }

    /// Draws the grid, the labels, and a dashed line at 1, which no surface may exceed.
    pub fn draw_axes(&self, canvas: &mut Canvas) {
        for degrees in (0_u8..=90).step_by(15) {
            let degrees = f32::from(degrees);
            canvas.line(&[self.at(degrees, 0.0), self.at(degrees, self.most)], pen(GRID, 1.2));
            let (x, y) = self.at(degrees, 0.0);
            canvas.text((x, y + 20.0), SMALL, Anchor::Center, FAINT, &format!("{degrees}°"));
        }
        let step = if self.most > 2.5 { (self.most / 5.0).ceil() } else { 0.2 };
        let mut albedo = 0.0;
        while albedo <= self.most * 1.001 {
            canvas.line(&[self.at(0.0, albedo), self.at(90.0, albedo)], pen(GRID, 1.2));
            let (x, y) = self.at(0.0, albedo);
            canvas.text((x - 8.0, y + 5.0), SMALL, Anchor::Right, FAINT, &format!("{albedo:.1}"));
            albedo += step;
        }
        let mut whole = pen(TEXT, 1.6);
        whole.dashed = true;
        canvas.line(&[self.at(0.0, 1.0), self.at(90.0, 1.0)], whole);
        canvas.line(&[self.at(0.0, self.most), self.at(0.0, 0.0), self.at(90.0, 0.0)], pen(TEXT, 1.6));
        let (x, y) = self.at(45.0, 0.0);
        canvas.text((x, y + 42.0), SMALL, Anchor::Center, TEXT, "angle to the normal");
    }
}

/// Draws the legend: the colors of the light's arrow and of the lobes.
pub fn draw_legend(canvas: &mut Canvas, (x, y): (f32, f32), entries: &[(&str, Ink)]) {
    let mut at = x;
    for (name, ink) in [("light", LIGHT)].iter().chain(entries) {
        canvas.line(&[(at, y - 5.0), (at + 28.0, y - 5.0)], pen(*ink, 3.5));
        at += 36.0;
        at += canvas.text((at, y), 17.0, Anchor::Left, TEXT, name) + 28.0;
    }
}
