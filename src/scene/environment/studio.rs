//! The built-in photo studio: soft boxes in a dark, slightly blue room.
//!
//! The key light is left of the default camera (azimuth 30 degrees), the fill right of it. Two strips behind the model
//! light its edges; they stay outside the frame, so the background is a plain gradient. Mean radiance is about 0.7, the
//! key light's is 11. A surface that faces up receives about seven times the irradiance of one that faces down.

use glam::{Vec2, Vec3};

use super::Environment;

/// A rectangular light, in the perspective projection around its center.
struct SoftBox {
    /// Degrees around the model from +Z towards +X.
    azimuth: f32,
    /// Degrees above the horizon.
    elevation: f32,
    /// Half of its width and height, as tangents of the angles to the center.
    half_size: Vec2,
    /// Half of the width of its soft edge, in the same unit.
    softness: f32,
    /// Radiance at the center, linear RGB.
    radiance: Vec3,
}

const BOXES: [SoftBox; 5] = [
    // Key
    SoftBox {
        azimuth: -22.0,
        elevation: 38.0,
        half_size: Vec2::new(0.40, 0.33),
        softness: 0.06,
        radiance: Vec3::new(11.0, 10.45, 9.68),
    },
    // Fill
    SoftBox {
        azimuth: 80.0,
        elevation: 14.0,
        half_size: Vec2::new(0.30, 0.60),
        softness: 0.12,
        radiance: Vec3::new(1.35, 1.44, 1.5),
    },
    // Rims
    SoftBox {
        azimuth: 164.0,
        elevation: 24.0,
        half_size: Vec2::new(0.075, 0.60),
        softness: 0.035,
        radiance: Vec3::new(7.0, 6.86, 6.65),
    },
    SoftBox {
        azimuth: 257.0,
        elevation: 18.0,
        half_size: Vec2::new(0.06, 0.50),
        softness: 0.035,
        radiance: Vec3::new(4.6, 4.85, 5.0),
    },
    // Overhead
    SoftBox {
        azimuth: 210.0,
        elevation: 74.0,
        half_size: Vec2::new(0.50, 0.22),
        softness: 0.14,
        radiance: Vec3::new(1.9, 1.88, 1.84),
    },
];

/// By which fraction a soft box is darker at the middle of an edge than at its center.
const EDGE_FALLOFF: f32 = 0.17;
const WALL_COLOR: Vec3 = Vec3::new(0.82, 0.94, 1.12);
/// Radiance of the upper wall, and what a band just above the horizon adds to it.
const WALL: (f32, f32) = (0.055, 0.15);
/// Height and width of that band, as `direction.y`.
const WALL_BAND: (f32, f32) = (0.06, 0.36);
const FLOOR_COLOR: Vec3 = Vec3::new(0.92, 0.97, 1.05);
/// Radiance of the floor at the horizon, and what is added towards straight down.
const FLOOR: (f32, f32) = (0.11, 0.06);
/// The floor's blurred reflection of the boxes: its strength and additional softness.
const FLOOR_MIRROR: (f32, f32) = (0.035, 0.30);
/// Half of the height of the rounded transition between wall and floor, as `direction.y`.
const SEAM: f32 = 0.16;

/// Generates the studio, with `width` columns and half as many rows.
pub fn make(width: u32) -> Environment {
    let boxes = BOXES.map(|soft_box| (soft_box.frame(), soft_box));
    Environment::render(width, |direction| {
        let y = direction.y;
        let band = (-((y - WALL_BAND.0) / WALL_BAND.1).powi(2)).exp();
        let wall = WALL_COLOR * (WALL.0 + WALL.1 * band);
        let mut floor = FLOOR_COLOR * (FLOOR.0 + FLOOR.1 * smoothstep(0.0, 1.0, -y));
        if y < 0.0 {
            let mirrored = light(&boxes, direction * Vec3::new(1.0, -1.0, 1.0), FLOOR_MIRROR.1);
            floor += mirrored * FLOOR_MIRROR.0 * smoothstep(0.0, 0.35, -y);
        }
        floor.lerp(wall, smoothstep(-SEAM, SEAM, y)) + light(&boxes, direction, 0.0)
    })
}

/// Radiance of all boxes.
fn light(boxes: &[([Vec3; 3], SoftBox)], direction: Vec3, more_softness: f32) -> Vec3 {
    boxes.iter().map(|(frame, soft_box)| soft_box.radiance(direction, frame, more_softness)).sum()
}

impl SoftBox {
    /// Unit vectors towards the box, right and up.
    fn frame(&self) -> [Vec3; 3] {
        let facing = super::super::camera::direction(self.azimuth.to_radians(), self.elevation.to_radians());
        let right = Vec3::Y.cross(facing).normalize_or(Vec3::X);
        [facing, right, facing.cross(right)]
    }

    fn radiance(&self, direction: Vec3, &[facing, right, up]: &[Vec3; 3], more_softness: f32) -> Vec3 {
        let distance = direction.dot(facing);
        if distance <= 0.0 {
            return Vec3::ZERO;
        }
        let at = (Vec2::new(direction.dot(right), direction.dot(up)) / distance).abs();
        let soft = self.softness + more_softness;
        // A product of two edges: the distance to the box would show creases where it is very soft.
        let edge = |at: f32, half: f32| 1.0 - smoothstep(half - soft, half + soft, at);
        let coverage = edge(at.x, self.half_size.x) * edge(at.y, self.half_size.y);
        if coverage <= 0.0 {
            return Vec3::ZERO;
        }
        let falloff = 1.0 - EDGE_FALLOFF * (at / self.half_size).length_squared().min(2.0);
        self.radiance * coverage * falloff
    }
}

fn smoothstep(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
