//! The camera: framing and matrices.

mod controller;
mod framing;
mod motion;
mod view;

use glam::Vec3;

pub use controller::CameraController;
pub use motion::{FlyCamera, OrbitCamera};
pub use view::{CameraView, Parallel};

use crate::scene::model::{Lens, Model};
use crate::settings::CameraSettings;
pub(super) use framing::direction;
use framing::frame;
use view::HIGHEST;

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

#[cfg(test)]
mod tests {
    use super::framing::FILL;
    use super::*;
    use crate::scene::model::{Bounds, Camera};

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
