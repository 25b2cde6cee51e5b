//! The camera controller: mouse and keys orbit, pan and dolly around the model, or fly while the right button is held.

use glam::{Vec2, Vec3};

use super::{Bounds, CameraView, FlyCamera, OrbitCamera};
use crate::settings::CameraSettings;

/// Radians that the camera turns when the mouse crosses the picture's height.
const TURN_PER_HEIGHT: f32 = 3.0;

/// Moves the camera that the settings describe.
#[derive(Default)]
pub struct CameraController {
    /// Keys held while flying: right, up, forward, each -1, 0 or 1.
    pub fly: Vec3,
}

impl CameraController {
    /// Drags with the left button: around the target.
    pub fn orbit(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.orbit(Vec2::new(-delta.x, delta.y) * TURN_PER_HEIGHT);
        put(settings, orbit.eye(), orbit.target);
    }

    /// Drags with the middle button or Shift: eye and target across the view.
    pub fn pan(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.pan(Vec2::new(-delta.x, delta.y), view.fovy_rad);
        put(settings, orbit.eye(), orbit.target);
    }

    /// Turns the wheel: nearer and farther.
    pub fn dolly(settings: &mut CameraSettings, view: &CameraView, steps: f32) {
        let mut orbit = OrbitCamera::new(view.eye, view.target);
        orbit.dolly(steps);
        put(settings, orbit.eye(), orbit.target);
    }

    /// Drags with the right button: looks around.
    pub fn look(settings: &mut CameraSettings, view: &CameraView, delta: Vec2) {
        let mut fly = FlyCamera::new(view.eye, view.target);
        fly.look(Vec2::new(delta.x, -delta.y) * TURN_PER_HEIGHT * 0.5);
        put(settings, fly.eye, fly.target());
    }

    /// Flies for `seconds`; returns whether anything moved.
    pub fn step(&self, settings: &mut CameraSettings, view: &CameraView, bounds: &Bounds, seconds: f32) -> bool {
        if self.fly == Vec3::ZERO {
            return false;
        }
        let mut fly = FlyCamera::new(view.eye, view.target);
        // The model's size sets the pace: its radius in one second.
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
