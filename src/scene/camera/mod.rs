//! The camera: framing and matrices.

mod controller;
mod motion;

use glam::{Mat4, Vec3};

pub use controller::CameraController;
pub use motion::{FlyCamera, OrbitCamera};

use crate::scene::model::{Bounds, Camera, Lens, Model};
use crate::settings::CameraSettings;

/// The framed model fills this fraction of the picture's width or height.
const FILL: f32 = 1.0 / 1.08;
/// Larger coordinates of eye and target overflow when squared.
const FARTHEST: f32 = 1e18;
/// A parallel projection is a perspective from as many radii, or heights of the picture, away: sizes then differ by 0.2 % over a radius,
/// and all that follows rays from an eye needs no second kind of them.
const PARALLEL: f32 = 500.0;
/// Largest height of a parallel projection, meters.
const HIGHEST: f32 = 1e9;
/// Smallest and largest field of view of a camera of the model, radians.
const LENSES: (f32, f32) = (1e-3, 3.1);
/// Field of view if the setting is not finite, degrees.
const DEFAULT_FOVY_DEG: f32 = 35.0;

/// A perspective view in world space: right-handed, +Y up, meters. Create it with [`CameraView::new`] or [`view_of`], which
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
    fn of_camera(camera: &Camera, aspect: f32, bounds: &Bounds) -> Self {
        let depth = camera.forward.dot(bounds.center() - camera.eye);
        let depth = if depth > bounds.radius() * 1e-2 { depth } else { bounds.radius() };
        Self::new(camera.eye, camera.eye + camera.forward * depth, 0.0, aspect, bounds).upright_as(camera.up)
    }

    fn upright_as(self, up: Vec3) -> Self {
        Self { up: up.reject_from_normalized(self.forward()).normalize_or(self.up), ..self }
    }

    /// The same with another projection. A parallel one shows nothing behind the eye, either.
    fn through(self, lens: Lens, bounds: &Bounds) -> Self {
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
    fn is_rolled(&self) -> bool {
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

/// The view of a model according to the settings: that of the camera that they name, if the model has it, or else one that frames the model.
pub fn view_of(model: &Model, settings: &CameraSettings, aspect: f32) -> CameraView {
    let bounds = &model.bounds;
    let named = model.camera(&settings.name);
    let mut view = match named.filter(|_| settings.eye.is_none() && settings.target.is_none()) {
        Some(camera) => CameraView::of_camera(camera, aspect, bounds),
        None => frame(bounds, &model.outline, settings, aspect),
    };
    if let Some(up) = settings.up.map(Vec3::from) {
        view = view.upright_as(up);
    }
    let lens = match named {
        _ if settings.height > 0.0 && settings.height <= HIGHEST => {
            Some(Lens::Orthographic { height: settings.height })
        }
        named => named.map(|camera| camera.lens),
    };
    lens.map_or(view, |lens| view.through(lens, bounds))
}

/// The view without a camera of the model. Without `eye`, this fits the model's outline (or its bounding box) into the
/// picture with a margin, seen from `azimuth` (degrees from +Z towards +X) and `elevation`.
fn frame(bounds: &Bounds, outline: &[Vec3], settings: &CameraSettings, aspect: f32) -> CameraView {
    let corners = bounds.corners();
    let outline = if outline.is_empty() { &corners } else { outline };
    let aspect = if aspect.is_finite() && aspect > 0.0 { aspect } else { 1.0 };
    let fovy_rad = sane_fovy(settings.fovy.to_radians());
    let number = |degrees: f32| if degrees.is_finite() { degrees.to_radians() } else { 0.0 };
    let (framed_eye, framed_target) =
        fit(bounds, outline, number(settings.azimuth), number(settings.elevation), fovy_rad, aspect);
    let (eye, target) = match (settings.eye.map(Vec3::from), settings.target.map(Vec3::from)) {
        (None, None) => (framed_eye, framed_target),
        (None, Some(target)) => (target + (framed_eye - framed_target), target),
        (Some(eye), None) => (eye, bounds.center()),
        (Some(eye), Some(target)) => (eye, target),
    };
    let mut view = CameraView::new(eye, target, fovy_rad, aspect, bounds);
    if settings.eye.is_none() {
        // When looking straight down, the azimuth still determines which direction is up.
        let (_, _, up) = basis(number(settings.azimuth), number(settings.elevation));
        view.up = up.reject_from_normalized(view.forward()).normalize_or(view.up);
    }
    view
}

/// Unit vectors back (towards the eye), right and up.
fn basis(azimuth_rad: f32, elevation_rad: f32) -> (Vec3, Vec3, Vec3) {
    let (sin_a, cos_a) = azimuth_rad.sin_cos();
    let back = direction(azimuth_rad, elevation_rad);
    let right = Vec3::new(cos_a, 0.0, -sin_a);
    (back, right, back.cross(right))
}

/// Unit vector at an azimuth (from +Z towards +X) and an elevation above the horizon.
pub(super) fn direction(azimuth_rad: f32, elevation_rad: f32) -> Vec3 {
    let (sin_a, cos_a) = azimuth_rad.sin_cos();
    let (sin_e, cos_e) = elevation_rad.sin_cos();
    Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}

/// Eye and target at which the points just fit. In camera space, with t the tangent of half the usable angle, a point
/// (x, z) is inside if |x - eye.x| <= t (eye.z - z). These are two linear bounds per axis; the closest eye meets both
/// with equality.
fn fit(
    bounds: &Bounds,
    points: &[Vec3],
    azimuth_rad: f32,
    elevation_rad: f32,
    fovy_rad: f32,
    aspect: f32,
) -> (Vec3, Vec3) {
    let (back, right, up) = basis(azimuth_rad, elevation_rad);
    let center = bounds.center();
    let tan_y = (fovy_rad * 0.5).tan() * FILL;
    let tan_x = tan_y * aspect;
    // If there is nothing to fit, or a single point, this fits a sphere of radius 1.
    let solid = !bounds.is_empty() && (bounds.max - bounds.min).max_element() > 0.0;
    if !solid {
        return (center + back * (bounds.radius() / tan_y.min(tan_x)).max(1.0), center);
    }
    let axis = |side: Vec3, tan: f32| {
        let most = |sign: f32| {
            let reach = |point: &Vec3| sign * (*point - center).dot(side) + tan * (*point - center).dot(back);
            points.iter().map(reach).fold(f32::NEG_INFINITY, f32::max)
        };
        let (high, low) = (most(1.0), most(-1.0));
        ((high - low) * 0.5, (high + low) / (2.0 * tan))
    };
    let (x, distance_x) = axis(right, tan_x);
    let (y, distance_y) = axis(up, tan_y);
    let target = center + right * x + up * y;
    (target + back * distance_x.max(distance_y), target)
}

/// Up in the picture for a viewing direction: +Y projected, or a fixed vector when looking straight up or down.
fn upright(forward: Vec3) -> Vec3 {
    let fallback = if forward.y < 0.0 { Vec3::NEG_Z } else { Vec3::Z };
    let up = Vec3::Y.reject_from_normalized(forward);
    if up.length() > 1e-4 { up.normalize() } else { fallback.reject_from_normalized(forward).normalize_or(fallback) }
}

fn sane_fovy(fovy_rad: f32) -> f32 {
    let fovy_rad = if fovy_rad.is_finite() { fovy_rad } else { DEFAULT_FOVY_DEG.to_radians() };
    fovy_rad.clamp(1_f32.to_radians(), 170_f32.to_radians())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Bounds {
        Bounds { min: Vec3::new(-1.0, 0.0, -0.5), max: Vec3::new(3.0, 2.0, 0.5) }
    }

    fn extent(view: &CameraView, bounds: &Bounds) -> (f32, f32) {
        let corners = bounds.corners().map(|corner| view.clip_from_world().project_point3(corner));
        assert!(corners.iter().all(|c| c.is_finite() && c.z > 0.0 && c.z <= 1.0), "{corners:?}");
        let most = |pick: fn(&Vec3) -> f32| corners.iter().map(pick).fold(0.0, f32::max);
        (most(|c| c.x.abs()), most(|c| c.y.abs()))
    }

    #[test]
    fn framing_fills_the_picture_from_every_side() {
        for azimuth in [-180.0, -35.0, 0.0, 30.0, 90.0] {
            for elevation in [-90.0, -30.0, 0.0, 15.0, 89.9, 90.0] {
                for (aspect, fovy) in [(1.0, 35.0), (1.78, 20.0), (0.5, 60.0), (3.0, 90.0)] {
                    let settings = CameraSettings { azimuth, elevation, fovy, ..CameraSettings::default() };
                    let (x, y) = extent(&frame(&cube(), &[], &settings, aspect), &cube());
                    let fill = x.max(y);
                    assert!((fill - FILL).abs() < 1e-3, "{azimuth} {elevation} {aspect} {fovy}: {x} {y}");
                }
            }
        }
    }

    #[test]
    fn clip_space_is_vulkan_reversed() {
        let view = CameraView::new(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, 1.0, 2.0, &cube());
        let clip = view.clip_from_world();
        let at = |x: f32, y: f32, depth: f32| clip.project_point3(Vec3::new(x, y, 5.0 - depth));
        assert!((at(0.0, 0.0, view.near).z - 1.0).abs() < 1e-5);
        assert!(at(0.0, 0.0, 1e6).z < 1e-4 && at(0.0, 0.0, 1e6).z > 0.0);
        assert!(at(0.0, 1.0, 5.0).y < 0.0, "+Y is up in the world and down in clip space");
        assert!(at(1.0, 0.0, 5.0).x > 0.0);
        let top = 5.0 * 0.5_f32.tan();
        assert!((at(2.0 * top, top, 5.0) - Vec3::new(1.0, -1.0, view.near / 5.0)).length() < 1e-5);
    }

    #[test]
    fn azimuth_goes_from_z_towards_x() {
        let settings = |azimuth, elevation| CameraSettings { azimuth, elevation, ..CameraSettings::default() };
        let from = |azimuth, elevation| -frame(&cube(), &[], &settings(azimuth, elevation), 1.0).forward();
        assert!(from(0.0, 0.0).distance(Vec3::Z) < 1e-5);
        assert!(from(90.0, 0.0).distance(Vec3::X) < 1e-5);
        assert!(from(0.0, 90.0).distance(Vec3::Y) < 1e-5);
    }

    #[test]
    fn explicit_eye_and_target_win() {
        let settings =
            CameraSettings { eye: Some([1.0, 2.0, 3.0]), target: Some([1.0, 0.0, 0.0]), ..CameraSettings::default() };
        let view = frame(&cube(), &[], &settings, 1.5);
        assert_eq!((view.eye, view.target), (Vec3::new(1.0, 2.0, 3.0), Vec3::X));
        let only_target = CameraSettings { target: Some([9.0, 0.0, 0.0]), ..CameraSettings::default() };
        let view = frame(&cube(), &[], &only_target, 1.5);
        assert_eq!(view.target, Vec3::new(9.0, 0.0, 0.0));
        let only_eye = CameraSettings { eye: Some([9.0, 0.0, 0.0]), ..CameraSettings::default() };
        assert_eq!(frame(&cube(), &[], &only_eye, 1.5).target, cube().center());
    }

    fn with_camera(camera: Camera) -> Model {
        Model { bounds: cube(), cameras: vec![camera], ..Model::default() }
    }

    fn camera(eye: Vec3, forward: Vec3, lens: Lens) -> Camera {
        Camera { name: "Shot".into(), eye, forward, up: Vec3::X, lens }
    }

    fn named(name: &str) -> CameraSettings {
        CameraSettings { name: name.into(), ..CameraSettings::default() }
    }

    #[test]
    fn a_camera_of_the_model_looks_as_it_did_and_orbits_the_model() {
        let lens = Lens::Perspective { fovy: 0.7 };
        let at = |eye, forward| view_of(&with_camera(camera(eye, forward, lens)), &named("Shot"), 1.5);
        let view = at(Vec3::new(1.0, 1.0, 9.0), Vec3::NEG_Z);
        assert_eq!((view.eye, view.target), (Vec3::new(1.0, 1.0, 9.0), Vec3::new(1.0, 1.0, 0.0)));
        assert_eq!((view.up, view.fovy_rad, view.aspect), (Vec3::X, 0.7, 1.5));
        for (eye, forward) in [(Vec3::new(1.0, 1.0, 9.0), Vec3::Z), (cube().center(), Vec3::Y)] {
            let view = at(eye, forward);
            assert_eq!(view.eye, eye);
            assert!(view.target.distance(eye + forward * cube().radius()) < 1e-5);
        }
    }

    #[test]
    fn a_moved_camera_of_the_model_keeps_its_lens_and_another_model_has_the_users() {
        let model = with_camera(camera(Vec3::Z * 9.0, Vec3::NEG_Z, Lens::Perspective { fovy: 0.7 }));
        let mut settings = named("#0");
        let view = view_of(&model, &settings, 1.0);
        CameraController::dolly(&mut settings, &view, 2.0);
        let nearer = view_of(&model, &settings, 1.0);
        assert!(nearer.eye.z < 8.0 && nearer.up == Vec3::X && nearer.fovy_rad == 0.7, "{nearer:?}");
        CameraController::orbit(&mut settings, &nearer, glam::Vec2::new(0.1, 0.0));
        assert!(view_of(&model, &settings, 1.0).up.y > 0.9, "orbiting levels the horizon");
        let other = Model { bounds: cube(), ..Model::default() };
        assert_eq!(view_of(&other, &settings, 1.0).fovy_rad, 35_f32.to_radians());
        settings.frame_model();
        assert_eq!(settings, CameraSettings::default());
    }

    #[test]
    fn parallel_projections_show_equal_sizes_at_every_depth() {
        let lens = Lens::Orthographic { height: 4.0 };
        let of_file = with_camera(camera(Vec3::new(1.0, 1.0, 9.0), Vec3::NEG_Z, lens));
        let of_settings = CameraSettings { eye: Some([1.0, 1.0, 9.0]), height: 4.0, ..CameraSettings::default() };
        let upright = CameraSettings { up: Some([0.0, 1.0, 0.0]), ..named("Shot") };
        for settings in [&of_settings, &upright] {
            let clip = view_of(&of_file, settings, 2.0).clip_from_world();
            for depth in [-2.0, 0.0, 2.0] {
                // The upper right corner: 2 m above the center, 4 m right of it.
                let corner = clip.project_point3(Vec3::new(5.0, 3.0, depth));
                assert!((corner.truncate() - glam::Vec2::new(1.0, -1.0)).length() < 3e-3, "{depth}: {corner}");
            }
            let behind = clip.project_point3(Vec3::new(1.0, 1.0, 9.5)).z;
            assert!(behind > 1.0, "what is behind the camera is seen: {behind}");
        }
        let mut settings = of_settings.clone();
        let view = view_of(&of_file, &settings, 2.0);
        CameraController::dolly(&mut settings, &view, 1.0);
        assert!((settings.height - 3.6).abs() < 1e-5 && settings.eye == of_settings.eye);
        let side = |settings: &CameraSettings| {
            let view = view_of(&of_file, settings, 2.0);
            view.clip_from_world().project_point3(Vec3::new(1.0, 1.0, 0.0)).x
        };
        CameraController::pan(&mut settings, &view, glam::Vec2::new(0.25, 0.0));
        assert!(side(&settings) > 0.2, "{}", side(&settings));
        let distance = |settings: &CameraSettings| {
            Vec3::from(settings.eye.unwrap()).distance(settings.target.map_or(cube().center(), Vec3::from))
        };
        assert!((distance(&settings) - 9.0).abs() < 1e-3, "the eye moves to where rays are parallel");
    }

    #[test]
    fn nothing_degenerate_makes_nan() {
        let point = Bounds { min: Vec3::ONE, max: Vec3::ONE };
        let plane = Bounds { min: Vec3::ZERO, max: Vec3::new(1.0, 0.0, 0.0) };
        let huge = Bounds { min: Vec3::splat(-1e15), max: Vec3::splat(1e15) };
        let tiny = Bounds { min: Vec3::splat(-1e-12), max: Vec3::splat(1e-12) };
        let odd = [f32::NAN, f32::INFINITY, 0.0, -90.0, 90.0, 1e30];
        for bounds in [Bounds::default(), point, plane, huge, tiny, cube()] {
            for value in odd {
                let framed =
                    CameraSettings { azimuth: value, elevation: value, fovy: value, ..CameraSettings::default() };
                let same = CameraSettings { eye: Some([value; 3]), target: Some([value; 3]), ..framed.clone() };
                let above = CameraSettings { eye: Some([0.0, 5.0, 0.0]), target: Some([0.0; 3]), ..framed.clone() };
                let flat = CameraSettings { height: value, up: Some([value; 3]), ..same.clone() };
                let low = CameraSettings { height: 2.0, ..framed.clone() };
                for settings in [framed, same, above, flat, low] {
                    let view = view_of(&Model { bounds, ..Model::default() }, &settings, value);
                    assert!(view.view_from_world().is_finite(), "{bounds:?} {settings:?}");
                    assert!(view.clip_from_world().is_finite(), "{bounds:?} {settings:?}");
                    let is_odd = bounds == huge || bounds == tiny || view.parallel.is_some();
                    assert!(view.clip_from_world().determinant() != 0.0 || is_odd);
                    assert!(view.near > 0.0 && view.far > view.near, "{view:?}");
                }
            }
        }
    }
}
