//! A view: a position, a direction and a projection, never degenerate.

use glam::{Mat4, Vec3};

use crate::scene::model::{Bounds, Camera, Lens};

/// Larger coordinates of eye and target overflow when squared.
const FARTHEST: f32 = 1e18;
/// A parallel projection is a perspective from as many radii, or heights of the picture, away: sizes then differ by 0.2 % over a radius,
/// and all that follows rays from an eye needs no second kind of them.
const PARALLEL: f32 = 500.0;
/// Largest height of a parallel projection, meters.
pub(super) const HIGHEST: f32 = 1e9;
/// Smallest and largest field of view of a camera of the model, radians.
const LENSES: (f32, f32) = (1e-3, 3.1);
/// Field of view if the setting is not finite, degrees.
const DEFAULT_FOVY_DEG: f32 = 35.0;

/// A perspective view in world space: right-handed, +Y up, meters. Create it with [`CameraView::new`] or `view_of`, which
/// never return a degenerate view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraView {
    /// Position.
    pub eye: Vec3,
    /// The point looked at; never equal to `eye`.
    pub target: Vec3,
    /// Up in the picture: unit, perpendicular to the viewing direction.
    pub up: Vec3,
    /// Vertical field of view, radians.
    pub fovy_rad: f32,
    /// Width over height.
    pub aspect: f32,
    /// Near plane distance, meters.
    pub near: f32,
    /// Distance beyond which the model has no point, meters. (The projection itself is infinite.)
    pub far: f32,
    /// For a parallel projection, which is a perspective from far away.
    pub parallel: Option<Parallel>,
}

/// Parameters of a parallel projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallel {
    /// Height of the picture, meters.
    pub height: f32,
    /// Distance from the target to the plane of the eye, behind which nothing is shown, meters.
    pub distance: f32,
}

impl CameraView {
    /// A view of a model with these bounds. Values that are not finite, or that give no direction, are replaced so that
    /// the model is visible. The near plane is as far away as the bounds allow.
    pub fn new(eye: Vec3, target: Vec3, fovy_rad: f32, aspect: f32, bounds: &Bounds) -> Self {
        let radius = bounds.radius();
        let usable = |point: Vec3| point.abs().max_element() <= FARTHEST && point.is_finite();
        let target = if usable(target) { target } else { bounds.center() };
        let apart = usable(eye) && (target - eye).try_normalize().is_some();
        // Far from the origin a radius can be smaller than the spacing of floats.
        let eye = if apart { eye } else { target + Vec3::Z * radius.max(target.length() * 1e-3) };
        let forward = (target - eye).normalize_or(Vec3::NEG_Z);
        let center_distance = (bounds.center() - eye).length();
        let least = radius * 1e-3;
        let near = (center_distance - radius).max(least);
        Self {
            eye,
            target,
            up: upright(forward),
            fovy_rad: sane_fovy(fovy_rad),
            aspect: if aspect.is_finite() && aspect > 0.0 { aspect } else { 1.0 },
            near,
            far: (center_distance + radius).max(near * 2.0),
            parallel: None,
        }
    }

    /// The view of one of the model's cameras. The target is at the depth of the model's center, which suits orbiting.
    /// If the center is behind the camera or too close to orbit around, the target is one radius ahead.
    pub(super) fn of_camera(camera: &Camera, aspect: f32, bounds: &Bounds) -> Self {
        let depth = camera.forward.dot(bounds.center() - camera.eye);
        let depth = if depth > bounds.radius() * 1e-2 { depth } else { bounds.radius() };
        Self::new(camera.eye, camera.eye + camera.forward * depth, 0.0, aspect, bounds).upright_as(camera.up)
    }

    pub(super) fn upright_as(self, up: Vec3) -> Self {
        Self { up: up.reject_from_normalized(self.forward()).normalize_or(self.up), ..self }
    }

    /// The same with another projection. A parallel one shows nothing behind the eye, either.
    pub(super) fn through(self, lens: Lens, bounds: &Bounds) -> Self {
        match lens {
            Lens::Perspective { fovy } => Self { fovy_rad: fovy.clamp(LENSES.0, LENSES.1), ..self },
            Lens::Orthographic { height } => {
                let distance = PARALLEL * bounds.radius().max(height.min(HIGHEST));
                let parallel = Parallel { height, distance: self.eye.distance(self.target) };
                let plane = distance - parallel.distance;
                let eye = self.target - self.forward() * distance;
                let far = Self::new(eye, self.target, 0.0, self.aspect, bounds);
                let fovy_rad = 2.0 * (0.5 * height / distance).atan();
                let (near, most) = (far.near.max(plane), far.far.max(plane * 2.0));
                Self { up: self.up, fovy_rad, near, far: most, parallel: Some(parallel), ..far }
            }
        }
    }

    /// Whether the picture is turned about the viewing direction.
    pub(super) fn is_rolled(&self) -> bool {
        self.up.distance(upright(self.forward())) > 1e-4
    }

    /// Viewing direction, unit.
    pub fn forward(&self) -> Vec3 {
        (self.target - self.eye).normalize_or(Vec3::NEG_Z)
    }

    /// World to view space: the camera looks along -Z, +Y is up.
    pub fn view_from_world(&self) -> Mat4 {
        glam::camera::rh::view::look_to_mat4(self.eye, self.forward(), self.up)
    }

    /// World to Vulkan's clip space: +Y down, depth 1 at the near plane and 0 at infinity (reversed, for float depth).
    pub fn clip_from_world(&self) -> Mat4 {
        let clip_from_view =
            glam::camera::rh::proj::vulkan::perspective_infinite_reverse(self.fovy_rad, self.aspect, self.near);
        clip_from_view * self.view_from_world()
    }
}

/// Up in the picture for a viewing direction: +Y projected, or a fixed vector when looking straight up or down.
fn upright(forward: Vec3) -> Vec3 {
    let fallback = if forward.y < 0.0 { Vec3::NEG_Z } else { Vec3::Z };
    let up = Vec3::Y.reject_from_normalized(forward);
    if up.length() > 1e-4 { up.normalize() } else { fallback.reject_from_normalized(forward).normalize_or(fallback) }
}

pub(super) fn sane_fovy(fovy_rad: f32) -> f32 {
    let fovy_rad = if fovy_rad.is_finite() { fovy_rad } else { DEFAULT_FOVY_DEG.to_radians() };
    fovy_rad.clamp(1_f32.to_radians(), 170_f32.to_radians())
}
