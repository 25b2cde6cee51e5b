//! The part of the world that a camera sees, and which spheres are beyond it.

use glam::{Mat4, Vec4};

/// Pixels around the frame that count as seen: points and lines have a width, and antialiasing shifts the frame by up to a pixel.
const MARGIN_PX: f32 = 16.0;
/// Spheres are so much larger than they should be, relative to their size and their distance from the origin: a bound on what rounding
/// does to the positions of vertices.
const ROUNDING: f32 = 1e-5;

/// Planes through the borders of a frame: a point with a negative distance from one of them is not seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frustum([Vec4; 6]);

/// Spheres around the draws of a scene, as one array for each coordinate, since all of them are tested in each frame.
#[derive(Default)]
pub(crate) struct Spheres {
    pub(super) x: Vec<f32>,
    pub(super) y: Vec<f32>,
    pub(super) z: Vec<f32>,
    radius: Vec<f32>,
}

impl Frustum {
    /// The frustum of a frame of this size in pixels.
    pub(crate) fn new(clip_from_world: Mat4, (width, height): (u32, u32)) -> Self {
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
        let wider = |size: u32| 1.0 + 2.0 * MARGIN_PX / size.max(1) as f32;
        let (w_x, w_y) = (w * wider(width), w * wider(height));
        // Depth is reversed: z = w is near, z = 0 far. The far plane of a perspective view is infinitely far, a plane without a normal.
        Self([w_x + x, w_x - x, w_y + y, w_y - y, w - z, z].map(normalized))
    }
}

/// A plane whose normal has a length of 1, so that it measures distances.
fn normalized(plane: Vec4) -> Vec4 {
    let length = plane.truncate().length();
    if length > 0.0 { plane / length } else { plane }
}

impl Spheres {
    pub(super) fn with_capacity(count: usize) -> Self {
        let new = || Vec::with_capacity(count);
        Self { x: new(), y: new(), z: new(), radius: new() }
    }

    /// Adds a sphere; one with an infinite radius is always seen.
    pub(super) fn push(&mut self, center: glam::Vec3, radius: f32) {
        self.x.push(center.x);
        self.y.push(center.y);
        self.z.push(center.z);
        self.radius.push(radius + ROUNDING * (radius + center.length()));
    }

    /// Writes for each sphere whether it is beyond the frustum. One that is not finite never is.
    pub(super) fn beyond(&self, Frustum(planes): &Frustum, out: &mut Vec<bool>) {
        out.clear();
        out.resize(self.x.len(), false);
        let coordinates = self.x.iter().zip(&self.y).zip(&self.z).zip(&self.radius);
        for (is_beyond, (((x, y), z), radius)) in out.iter_mut().zip(coordinates) {
            let far = |plane: &Vec4| plane.x * x + plane.y * y + plane.z * z + plane.w < -radius;
            *is_beyond = planes.iter().fold(false, |any, plane| any | far(plane));
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec3, camera};

    use super::*;

    /// Whether a sphere is beyond the frustum of a camera at the origin that looks along -Z, with a near plane at 0.1.
    fn is_beyond(projection: Mat4, center: Vec3, radius: f32) -> bool {
        let (mut spheres, mut out) = (Spheres::default(), Vec::new());
        spheres.push(center, radius);
        spheres.beyond(&Frustum::new(projection, (1000, 1000)), &mut out);
        out[0]
    }

    fn perspective() -> Mat4 {
        let reversed = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ]);
        // A field of view of 90 degrees both ways.
        reversed * camera::rh::view::look_at_mat4(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y)
    }

    #[test]
    fn a_sphere_that_reaches_into_the_frame_is_kept() {
        let beyond = |x: f32, y: f32, z: f32, radius: f32| is_beyond(perspective(), Vec3::new(x, y, z), radius);
        assert!(!beyond(0.0, 0.0, -10.0, 0.1));
        assert!(!beyond(0.0, 0.0, -1e6, 0.1), "there is no far plane");
        // The border lies at x = 10 there, and the sphere reaches sqrt(2) * radius along x.
        assert!(!beyond(11.0, 0.0, -10.0, 1.0));
        assert!(beyond(12.0, 0.0, -10.0, 1.0));
        assert!(beyond(0.0, -12.0, -10.0, 1.0));
        assert!(beyond(0.0, 0.0, 5.0, 1.0), "behind the eye");
        assert!(!beyond(0.0, 0.0, 5.0, 6.0), "around the eye");
        assert!(!beyond(0.0, 0.0, 5.0, f32::INFINITY));
        assert!(!beyond(f32::NAN, 0.0, 5.0, 1.0));
    }

    #[test]
    fn an_orthographic_frame_has_a_far_plane() {
        // x and y from -2 to 2, z from -0.1 to -20; depth 1 near, 0 far.
        let depth = 1.0 / 19.9;
        let projection = Mat4::from_cols_array_2d(&[
            [0.5, 0.0, 0.0, 0.0],
            [0.0, -0.5, 0.0, 0.0],
            [0.0, 0.0, depth, 0.0],
            [0.0, 0.0, 20.0 * depth, 1.0],
        ]);
        assert!(!is_beyond(projection, Vec3::new(2.5, 0.0, -5.0), 0.6));
        assert!(is_beyond(projection, Vec3::new(2.9, 0.0, -5.0), 0.6));
        assert!(is_beyond(projection, Vec3::new(0.0, 0.0, -22.0), 1.0));
        assert!(!is_beyond(projection, Vec3::new(0.0, 0.0, -22.0), 3.0));
    }
}
