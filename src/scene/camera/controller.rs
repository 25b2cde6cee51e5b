//! The camera controller: mouse and keys orbit, pan and dolly around the model, or fly while the right button is held.

use glam::{Vec2, Vec3};

use super::{CameraView, FlyCamera, OrbitCamera};
use crate::scene::model::Bounds;
use crate::settings::CameraSettings;

/// Radians that the camera turns when the mouse moves by the picture's height.
const TURN_PER_HEIGHT: f32 = 3.0;

/// Moves the camera of the settings.
#[derive(Default)]
pub struct CameraController {
    /// Keys held while flying: right, up, forward, each -1, 0 or 1.
    pub fly: Vec3,
}

impl CameraController {
    /// Left drag: moves the eye around the target.
    pub fn orbit(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.orbit(Vec2::new(-delta.x, delta.y) * TURN_PER_HEIGHT);
        put(settings, view, orbit.eye(), orbit.target);
        settings.up = None;
    }

    /// Middle drag or Shift with left drag: moves eye and target parallel to the picture.
    pub fn pan(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let height = 2.0 * view.eye.distance(view.target) * (view.fovy_rad * 0.5).tan();
        let step = (view.up * delta.y - view.forward().cross(view.up) * delta.x) * height;
        put(settings, view, view.eye + step, view.target + step);
    }

    /// Moves the camera across its view so that it looks at `point`, at the distance that the point has.
    pub fn focus(settings: &mut CameraSettings, view: &CameraView, point: Vec3) {
        let distance = view.forward().dot(point - view.eye);
        put(settings, view, point - view.forward() * distance, point);
    }

    /// Wheel: moves the eye towards the target or away from it. A parallel projection shows less or more.
    pub fn dolly(settings: &mut CameraSettings, view: &CameraView, steps: f32) {
        if let Some(parallel) = view.parallel {
            let height = parallel.height * 0.9_f32.powf(steps);
            if height.is_normal() {
                settings.height = height;
            }
            return;
        }
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.dolly(steps);
        put(settings, view, orbit.eye(), orbit.target);
    }

    /// Right drag: turns the camera in place.
    pub fn look(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut fly = FlyCamera::new(view.eye, view.target);
        fly.look(Vec2::new(delta.x, -delta.y) * TURN_PER_HEIGHT * 0.5);
        put(settings, view, fly.eye, fly.target());
        settings.up = None;
    }

    /// Flies for `seconds`. Returns whether the camera moved.
    pub fn step(&self, settings: &mut CameraSettings, view: &CameraView, bounds: &Bounds, seconds: f32) -> bool {
        if self.fly == Vec3::ZERO {
            return false;
        }
        let mut fly = FlyCamera::new(view.eye, view.target);
        // Speed: one model radius per second.
        fly.fly(self.fly * bounds.radius(), seconds.min(0.1));
        put(settings, view, fly.eye, fly.target());
        settings.up = None;
        true
    }
}

/// Stores where the camera is, and its roll.
fn put(settings: &mut CameraSettings, view: &CameraView, eye: Vec3, target: Vec3) {
    // The eye of a parallel projection is far away. Its settings keep the distance that they have.
    let eye = match view.parallel {
        Some(parallel) => target + (eye - target).normalize_or(Vec3::Z) * parallel.distance,
        None => eye,
    };
    if eye.is_finite() && target.is_finite() {
        settings.eye = Some(eye.to_array());
        settings.target = Some(target.to_array());
        settings.up = view.is_rolled().then(|| view.up.to_array());
    }
}
