//! A canvas for plots: lines, areas and text on white.

use std::path::Path;

use ab_glyph::{Font as _, FontVec, GlyphId, OutlineCurve, Point};
use specula::picture;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Shader, Stroke, StrokeDash, Transform,
};

/// An sRGB color with opacity, 0..255.
#[derive(Clone, Copy, Debug)]
pub struct Ink(pub u8, pub u8, pub u8, pub u8);

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    /// Color.
    pub ink: Ink,
    /// Pixels.
    pub width: f32,
    /// Whether the line is dashed.
    pub dashed: bool,
}

/// A solid line.
pub fn pen(ink: Ink, width: f32) -> Pen {
    Pen { ink, width, dashed: false }
}

/// The part of a text that is at the given position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its start.
    Left,
    /// Its middle.
    Center,
    /// Its end.
    Right,
}

/// A canvas. Coordinates are pixels from the upper left corner.
pub struct Canvas {
    pixmap: Pixmap,
    font: FontVec,
}

impl Canvas {
    /// Creates a white canvas.
    ///
    /// # Errors
    /// A message if memory or a font is missing.
    pub fn new(width: u32, height: u32) -> Result<Self, String> {
        let mut pixmap = Pixmap::new(width, height).ok_or("no memory for the plot")?;
        pixmap.fill(Color::WHITE);
        // The font that the window uses.
        let fonts = egui::FontDefinitions::default().font_data;
        let data = fonts.get("Ubuntu-Light").or_else(|| fonts.values().next()).ok_or("this build has no font")?;
        let font = FontVec::try_from_vec(data.font.to_vec()).map_err(|e| e.to_string())?;
        Ok(Self { pixmap, font })
    }

    /// Draws a line through points.
    pub fn line(&mut self, points: &[(f32, f32)], pen: Pen) {
        let Some(path) = through(points, false) else { return };
        let dash = if pen.dashed { StrokeDash::new(vec![pen.width * 4.0, pen.width * 4.0], 0.0) } else { None };
        let (line_cap, line_join) = (LineCap::Round, LineJoin::Round);
        let stroke = Stroke { width: pen.width, line_cap, line_join, dash, ..Stroke::default() };
        self.pixmap.stroke_path(&path, &paint(pen.ink), &stroke, Transform::identity(), None);
    }

    /// Fills the polygon of these points.
    pub fn area(&mut self, points: &[(f32, f32)], ink: Ink) {
        let Some(path) = through(points, true) else { return };
        self.pixmap.fill_path(&path, &paint(ink), FillRule::Winding, Transform::identity(), None);
    }

    /// Draws an arrow.
    pub fn arrow(&mut self, from: (f32, f32), to: (f32, f32), pen: Pen) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy).max(1e-3);
        let (ux, uy) = (dx / length, dy / length);
        let head = pen.width * 5.0;
        let base = (to.0 - ux * head, to.1 - uy * head);
        self.line(&[from, base], pen);
        let half = head * 0.4;
        self.area(&[to, (base.0 - uy * half, base.1 + ux * half), (base.0 + uy * half, base.1 - ux * half)], pen.ink);
    }

    /// Draws text on a baseline and returns its width.
    pub fn text(&mut self, (x, y): (f32, f32), size: f32, anchor: Anchor, ink: Ink, text: &str) -> f32 {
        let width = self.width_of(text, size);
        let left = match anchor {
            Anchor::Left => x,
            Anchor::Center => x - width * 0.5,
            Anchor::Right => x - width,
        };
        let mut outline = PathBuilder::new();
        for (glyph, at) in self.placed(text, size) {
            self.add_glyph(&mut outline, glyph, (left + at, y), size);
        }
        if let Some(path) = outline.finish() {
            self.pixmap.fill_path(&path, &paint(ink), FillRule::Winding, Transform::identity(), None);
        }
        width
    }

    /// The width of a text, pixels.
    pub fn width_of(&self, text: &str, size: f32) -> f32 {
        let end = self.placed(text, size).last().copied();
        end.map_or(0.0, |(glyph, at)| at + self.font.h_advance_unscaled(glyph) * self.scale(size))
    }

    /// Writes a PNG.
    ///
    /// # Errors
    /// A message if the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        picture::write_image(&image::DynamicImage::ImageRgba8(self.image()), path)
    }

    /// Its pixels.
    pub fn image(&self) -> image::RgbaImage {
        let (width, height) = (self.pixmap.width(), self.pixmap.height());
        // The page is opaque, so premultiplied colors are plain ones.
        image::RgbaImage::from_raw(width, height, self.pixmap.data().to_vec()).unwrap_or_default()
    }

    fn scale(&self, size: f32) -> f32 {
        size / self.font.units_per_em().unwrap_or(1000.0)
    }

    /// Each glyph with its offset from the start.
    fn placed(&self, text: &str, size: f32) -> Vec<(GlyphId, f32)> {
        let scale = self.scale(size);
        let mut before: Option<GlyphId> = None;
        let mut at = 0.0;
        let mut placed = Vec::new();
        for character in text.chars() {
            let glyph = self.font.glyph_id(character);
            if let Some(before) = before {
                at += (self.font.h_advance_unscaled(before) + self.font.kern_unscaled(before, glyph)) * scale;
            }
            placed.push((glyph, at));
            before = Some(glyph);
        }
        placed
    }

    fn add_glyph(&self, path: &mut PathBuilder, glyph: GlyphId, (x, y): (f32, f32), size: f32) {
        let Some(outline) = self.font.outline(glyph) else { return };
        let scale = self.scale(size);
        let place = |p: Point| (x + p.x * scale, y - p.y * scale);
        let mut pen: Option<Point> = None;
        for curve in &outline.curves {
            let (OutlineCurve::Line(start, end)
            | OutlineCurve::Quad(start, _, end)
            | OutlineCurve::Cubic(start, _, _, end)) = curve;
            if pen != Some(*start) {
                path.close();
                let (x, y) = place(*start);
                path.move_to(x, y);
            }
            let (ex, ey) = place(*end);
            match curve {
                OutlineCurve::Line(..) => path.line_to(ex, ey),
                OutlineCurve::Quad(_, control, _) => {
                    let (cx, cy) = place(*control);
                    path.quad_to(cx, cy, ex, ey);
                }
                OutlineCurve::Cubic(_, first, second, _) => {
                    let ((ax, ay), (bx, by)) = (place(*first), place(*second));
                    path.cubic_to(ax, ay, bx, by, ex, ey);
                }
            }
            pen = Some(*end);
        }
        path.close();
    }
}

fn paint(ink: Ink) -> Paint<'static> {
    let Ink(r, g, b, a) = ink;
    Paint { shader: Shader::SolidColor(Color::from_rgba8(r, g, b, a)), anti_alias: true, ..Paint::default() }
}

fn through(points: &[(f32, f32)], closed: bool) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    let (first, rest) = points.split_first()?;
    path.move_to(first.0, first.1);
    rest.iter().for_each(|(x, y)| path.line_to(*x, *y));
    if closed {
        path.close();
    }
    path.finish()
}
