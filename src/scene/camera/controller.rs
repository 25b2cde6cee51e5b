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
        put(settings, orbit.eye(), orbit.target);
    }

    /// Middle drag or Shift with left drag: moves eye and target parallel to the picture.
    pub fn pan(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.pan(Vec2::new(-delta.x, delta.y), view.fovy_rad);
        put(settings, orbit.eye(), orbit.target);
    }

    /// Moves the camera across its view so that it looks at `point`, at the distance that the point has.
    pub fn focus(settings: &mut CameraSettings, view: &CameraView, point: Vec3) {
        let distance = view.forward().dot(point - view.eye);
        settings.eye = Some((point - view.forward() * distance).to_array());
        settings.target = Some(point.to_array());
    }

    /// Wheel: moves the eye towards the target or away from it.
    pub fn dolly(settings: &mut CameraSettings, view: &CameraView, steps: f32) {
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.dolly(steps);
        put(settings, orbit.eye(), orbit.target);
    }

    /// Right drag: turns the camera in place.
    pub fn look(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut fly = FlyCamera::new(view.eye, view.target);
        fly.look(Vec2::new(delta.x, -delta.y) * TURN_PER_HEIGHT * 0.5);
        put(settings, fly.eye, fly.target());
    }

    /// Flies for `seconds`. Returns whether the camera moved.
    pub fn step(&self, settings: &mut CameraSettings, view: &CameraView, bounds: &Bounds, seconds: f32) -> bool {
        if self.fly == Vec3::ZERO {
            return false;
        }
        let mut fly = FlyCamera::new(view.eye, view.target);
        // Speed: one model radius per second.
        fly.fly(self.fly * bounds.radius(), seconds.min(0.1));
        put(settings, fly.eye, fly.target());
        true
    }
}

fn put(settings: &mut CameraSettings, eye: Vec3, target: Vec3) {
    if eye.is_finite() && target.is_finite() {
        settings.eye = Some(eye.to_array());
        settings.target = Some(target.to_array());
    }
}
