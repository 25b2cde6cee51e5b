//! The lobe in space: a surface whose distance from the origin is f NoV in that direction, drawn with egui's painter.

use egui::epaint::{Mesh, Vertex};
use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use glam::Vec3;

use super::plot::{GRID, luminance};
use crate::app::state::inspection::directions::Directions;
use crate::app::widgets::theme::{ACCENT, CARD, WARNING, small_font};
use crate::measure::Hemisphere;

/// Angle of the view above the horizon, degrees, at most and at least.
const ELEVATION: (f32, f32) = (18.0, 55.0);
/// Camera offset in degrees, so that the arrow towards the eye is not seen end-on.
const ASIDE: f32 = 40.0;

/// A view of the lobe: the normal is up.
struct View {
    center: Pos2,
    /// Points per unit of length.
    scale: f32,
    right: Vec3,
    up: Vec3,
    towards: Vec3,
}

impl View {
    fn new(rect: Rect, directions: &Directions, turn_deg: f32) -> Self {
        let elevation = (90.0 - directions.eye_deg).clamp(ELEVATION.0, ELEVATION.1).to_radians();
        let azimuth = (directions.azimuth_deg - ASIDE + turn_deg).to_radians();
        let (sin, cos) = azimuth.sin_cos();
        let towards = Vec3::new(cos * elevation.cos(), sin * elevation.cos(), elevation.sin());
        let right = Vec3::new(-sin, cos, 0.0);
        // The half of the horizon in front lies below the center; above it are the other half and the normal.
        let (below, above) = (elevation.sin(), elevation.sin().max(elevation.cos()));
        let scale = (0.44 * rect.width()).min(0.9 * rect.height() / (below + above));
        let center = pos2(rect.center().x, rect.max.y - 0.05 * rect.height() - scale * below);
        Self { center, scale, right, up: towards.cross(right), towards }
    }

    fn place(&self, point: Vec3) -> Pos2 {
        let (x, y) = (point.dot(self.right), point.dot(self.up));
        pos2(self.center.x + self.scale * x, self.center.y - self.scale * y)
    }
}

/// Direction with this angle from the normal, and this azimuth from the mirror direction, degrees. z is the normal.
fn direction(deg: f32, azimuth_deg: f32) -> Vec3 {
    let ((sin, cos), (sin_a, cos_a)) = (deg.to_radians().sin_cos(), azimuth_deg.to_radians().sin_cos());
    Vec3::new(sin * cos_a, sin * sin_a, cos)
}

/// Draws the lobe. It is seen from the side of the eye; `turn_deg` turns the view around the normal.
pub(super) fn paint(painter: &Painter, rect: Rect, hemisphere: &Hemisphere, directions: &Directions, turn_deg: f32) {
    let view = View::new(rect, directions, turn_deg);
    let horizon = (0..=48).map(|step| view.place(direction(90.0, 7.5 * step as f32))).collect();
    painter.add(Shape::line(horizon, Stroke::new(1.0, GRID)));
    let arrow = |towards: Vec3, color: Color32, name: &str, inwards: bool| {
        let (near, far) = (view.place(0.15 * towards), view.place(0.98 * towards));
        let (from, to) = if inwards { (far, near) } else { (near, far) };
        draw_arrow(painter, from, to, color);
        draw_name(painter, view.place(1.06 * towards), name, color);
    };
    let arrows = [
        (direction(directions.light_deg.min(90.0), 180.0), WARNING.color(), "light", true),
        (direction(directions.eye_deg.min(90.0), directions.azimuth_deg), ACCENT.color(), "eye", false),
    ];
    // The arrows that point away from the viewer lie behind the lobe.
    let (front, behind): (Vec<_>, Vec<_>) =
        arrows.into_iter().partition(|(towards, ..)| towards.dot(view.towards) > 0.0);
    behind.into_iter().for_each(|(towards, color, name, inwards)| arrow(towards, color, name, inwards));
    painter.add(Shape::mesh(mesh(&view, hemisphere)));
    front.into_iter().for_each(|(towards, color, name, inwards)| arrow(towards, color, name, inwards));
}

/// The name of an arrow, with its color, on a ground of its own.
fn draw_name(painter: &Painter, at: Pos2, text: &str, color: Color32) {
    let galley = painter.layout_no_wrap(text.to_owned(), small_font(), color);
    let rect = Align2::CENTER_CENTER.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand2(vec2(2.0, 0.0)), 2.0, CARD.color().gamma_multiply(0.7));
    painter.galley(rect.min, galley, color);
}

/// An arrow with a small head.
fn draw_arrow(painter: &Painter, from: Pos2, to: Pos2, color: Color32) {
    let stroke = Stroke::new(1.2, color);
    let back = (from - to).normalized() * 6.0;
    let side = 0.5 * back.rot90();
    painter.line_segment([from, to], stroke);
    painter.line_segment([to + back + side, to], stroke);
    painter.line_segment([to + back - side, to], stroke);
}

/// The surface as quads, the farthest first.
fn mesh(view: &View, hemisphere: &Hemisphere) -> Mesh {
    let (columns, values) = (hemisphere.azimuths.max(1), &hemisphere.values);
    let rings = values.len() / columns;
    let length = |value: &[f32; 3]| Some(luminance(*value)).filter(|value| value.is_finite()).unwrap_or(0.0).max(0.0);
    let most = values.iter().map(length).fold(0.0, f32::max);
    let mut mesh = Mesh::default();
    if rings < 2 || most <= 0.0 {
        return mesh;
    }
    let point = |ring: usize, column: usize| {
        let column = column % columns;
        let (deg, azimuth) = (90.0 * ring as f32 / (rings - 1) as f32, 360.0 * column as f32 / columns as f32);
        direction(deg, azimuth) * (length(&values[ring * columns + column]) / most)
    };
    let cells = (0..rings - 1).flat_map(|ring| (0..columns).map(move |column| (ring, column)));
    let mut quads: Vec<(f32, [Vec3; 4])> = cells
        .map(|(ring, column)| {
            let corners =
                [point(ring, column), point(ring, column + 1), point(ring + 1, column + 1), point(ring + 1, column)];
            (corners.iter().sum::<Vec3>().dot(view.towards), corners)
        })
        .collect();
    quads.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    for (_, corners) in quads {
        let normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero();
        let facing = normal.dot(view.towards).abs();
        let above = normal.dot(view.up + 0.5 * view.right).abs();
        let shade = (0.25 + 0.5 * facing + 0.3 * above).min(1.0);
        let color = Color32::from_rgb((120.0 * shade) as u8, (182.0 * shade) as u8, (255.0 * shade) as u8);
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(corners.map(|corner| Vertex {
            pos: view.place(corner),
            uv: egui::epaint::WHITE_UV,
            color,
        }));
        mesh.indices.extend([first, first + 1, first + 2, first, first + 2, first + 3]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(directions: &Directions) -> View {
        View::new(Rect::from_min_size(Pos2::ZERO, egui::vec2(200.0, 150.0)), directions, 0.0)
    }

    #[test]
    fn the_normal_points_up_and_the_view_is_orthonormal() {
        let of = Directions { light_deg: 40.0, eye_deg: 50.0, azimuth_deg: 20.0 };
        let view = view(&of);
        let (origin, normal) = (view.place(Vec3::ZERO), view.place(Vec3::Z));
        assert!(normal.y < origin.y && (normal.x - origin.x).abs() < 1e-3, "{origin} {normal}");
        assert!(view.right.cross(view.up).distance(view.towards) < 1e-5);
    }

    #[test]
    fn horizon_and_normal_fit_the_plot() {
        let rect = Rect::from_min_size(Pos2::ZERO, egui::vec2(200.0, 150.0));
        for eye_deg in [0.0, 45.0, 89.0] {
            let view = view(&Directions { light_deg: 40.0, eye_deg, azimuth_deg: 0.0 });
            let horizon = (0..36).map(|step| view.place(direction(90.0, 10.0 * step as f32)));
            let places: Vec<Pos2> = horizon.chain([view.place(Vec3::Z)]).collect();
            assert!(places.iter().all(|place| rect.contains(*place)), "{eye_deg}: {places:?}");
        }
    }

    #[test]
    fn a_surface_of_n_rings_has_a_quad_for_each_cell_and_survives_nan() {
        let values = vec![[0.3, f32::NAN, 0.3]; 4].into_iter().chain(vec![[0.5; 3]; 8]).collect();
        let hemisphere = Hemisphere { azimuths: 4, values };
        let mesh = mesh(&view(&Directions { light_deg: 0.0, eye_deg: 0.0, azimuth_deg: 0.0 }), &hemisphere);
        assert_eq!((mesh.vertices.len(), mesh.indices.len()), (2 * 4 * 4, 2 * 4 * 6));
        assert!(mesh.vertices.iter().all(|vertex| vertex.pos.x.is_finite() && vertex.pos.y.is_finite()));
        let black = Hemisphere { azimuths: 4, values: vec![[0.0; 3]; 12] };
        let nothing = super::mesh(&view(&Directions { light_deg: 0.0, eye_deg: 0.0, azimuth_deg: 0.0 }), &black);
        assert!(nothing.vertices.is_empty());
    }
}
