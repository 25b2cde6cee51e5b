//! Camera controllers. Pure math: the window translates input into these calls and stores eye and target in the
//! settings.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Vec2, Vec3};

use super::direction;

/// Largest elevation, radians. Straight up or down, left and right would be undefined.
const STEEPEST: f32 = FRAC_PI_2 - 1e-3;

/// A camera that orbits its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitCamera {
    /// The center, world space.
    pub target: Vec3,
    /// Distance from the target to the eye, meters, above 0.
    pub distance: f32,
    /// Around +Y, from +Z towards +X, radians.
    pub azimuth_rad: f32,
    /// Above the horizon, radians.
    pub elevation_rad: f32,
}

impl OrbitCamera {
    /// Starts from an eye and a target.
    pub fn new(eye: Vec3, target: Vec3) -> Self {
        let (azimuth_rad, elevation_rad, distance) = angles(eye - target);
        Self { target, distance, azimuth_rad, elevation_rad }
    }

    /// Position of the camera.
    pub fn eye(&self) -> Vec3 {
        self.target + direction(self.azimuth_rad, self.elevation_rad) * self.distance
    }

    /// Orbits the target: `delta_rad.x` increases the azimuth, `delta_rad.y` the elevation.
    pub fn orbit(&mut self, delta_rad: Vec2) {
        turn(&mut self.azimuth_rad, &mut self.elevation_rad, delta_rad);
    }

    /// Moves towards the target: each step reduces the distance by a tenth; negative steps move back.
    pub fn dolly(&mut self, steps: f32) {
        let distance = self.distance * 0.9_f32.powf(steps);
        if distance.is_finite() && distance > f32::MIN_POSITIVE {
            self.distance = distance;
        }
    }
}

/// A camera that flies freely, with a level horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlyCamera {
    /// Position, world space.
    pub eye: Vec3,
    /// Direction of view around +Y, from +Z towards +X, radians.
    pub azimuth_rad: f32,
    /// Direction of view above the horizon, radians.
    pub elevation_rad: f32,
    /// Distance to the point that [`Self::target`] returns, meters.
    pub distance: f32,
}

impl FlyCamera {
    /// Starts from an eye and a target.
    pub fn new(eye: Vec3, target: Vec3) -> Self {
        let (azimuth_rad, elevation_rad, distance) = angles(target - eye);
        Self { eye, azimuth_rad, elevation_rad, distance }
    }

    /// Viewing direction, unit.
    pub fn forward(&self) -> Vec3 {
        direction(self.azimuth_rad, self.elevation_rad)
    }

    /// The point ahead that the camera looks at.
    pub fn target(&self) -> Vec3 {
        self.eye + self.forward() * self.distance
    }

    /// Rotates the view: `delta_rad.x` to the right, `delta_rad.y` up.
    pub fn look(&mut self, delta_rad: Vec2) {
        // Azimuths increase counterclockwise seen from above, so turning right decreases the azimuth.
        turn(&mut self.azimuth_rad, &mut self.elevation_rad, Vec2::new(-delta_rad.x, delta_rad.y));
    }

    /// Flies for `seconds`: `velocity` in meters a second, x right, y up in the world, z forward.
    pub fn fly(&mut self, velocity: Vec3, seconds: f32) {
        let right = direction(self.azimuth_rad - FRAC_PI_2, 0.0);
        let step = (right * velocity.x + Vec3::Y * velocity.y + self.forward() * velocity.z) * seconds;
        if step.is_finite() {
            self.eye += step;
        }
    }
}

/// Azimuth, elevation and length of a vector. A vector without direction counts as +Z with length 1.
fn angles(vector: Vec3) -> (f32, f32, f32) {
    let (unit, length) = match vector.try_normalize() {
        Some(unit) => (unit, vector.length()),
        None => (Vec3::Z, 1.0),
    };
    (unit.x.atan2(unit.z), unit.y.clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST), length)
}

fn turn(azimuth_rad: &mut f32, elevation_rad: &mut f32, delta_rad: Vec2) {
    if delta_rad.is_finite() {
        *azimuth_rad = (*azimuth_rad + delta_rad.x) % TAU;
        *elevation_rad = (*elevation_rad + delta_rad.y).clamp(-STEEPEST, STEEPEST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: Vec3 = Vec3::new(1.0, 2.0, 5.0);
    const TARGET: Vec3 = Vec3::new(0.5, 0.0, -1.0);

    #[test]
    fn taking_over_keeps_eye_and_target() {
        let orbit = OrbitCamera::new(EYE, TARGET);
        assert!(orbit.eye().distance(EYE) < 1e-5 && orbit.target == TARGET);
        let fly = FlyCamera::new(EYE, TARGET);
        assert!(fly.target().distance(TARGET) < 1e-5 && fly.eye == EYE);
    }

    #[test]
    fn orbit_keeps_the_distance_and_never_turns_over() {
        let mut camera = OrbitCamera::new(EYE, TARGET);
        camera.orbit(Vec2::new(0.3, 9.0));
        assert!((camera.eye().distance(TARGET) - EYE.distance(TARGET)).abs() < 1e-4);
        assert!(camera.eye().y > TARGET.y && camera.elevation_rad < FRAC_PI_2);
        let mut camera = OrbitCamera::new(Vec3::Z, Vec3::ZERO);
        camera.orbit(Vec2::new(FRAC_PI_2, 0.0));
        assert!(camera.eye().distance(Vec3::X) < 1e-5);
    }

    #[test]
    fn dolly() {
        let mut camera = OrbitCamera::new(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO);
        camera.dolly(1.0);
        assert!((camera.distance - 1.8).abs() < 1e-5);
        camera.dolly(-1.0);
        assert!((camera.distance - 2.0).abs() < 1e-5);
        camera.dolly(1e9);
        assert!(camera.distance > 0.0);
    }

    #[test]
    fn fly_goes_where_it_looks() {
        let mut camera = FlyCamera::new(Vec3::ZERO, Vec3::NEG_Z);
        camera.fly(Vec3::new(1.0, 2.0, 3.0), 2.0);
        assert!(camera.eye.distance(Vec3::new(2.0, 4.0, -6.0)) < 1e-4, "{:?}", camera.eye);
        camera.look(Vec2::new(FRAC_PI_2, 0.0));
        assert!(camera.forward().distance(Vec3::X) < 1e-4, "{:?}", camera.forward());
    }

    #[test]
    fn degenerate_input_is_ignored() {
        for mut camera in [OrbitCamera::new(EYE, EYE), OrbitCamera::new(Vec3::Y, Vec3::ZERO)] {
            camera.orbit(Vec2::NAN);
            camera.dolly(f32::NAN);
            assert!(camera.eye().is_finite() && camera.target.is_finite());
        }
        let mut camera = FlyCamera::new(EYE, EYE);
        camera.look(Vec2::NAN);
        camera.fly(Vec3::ONE, f32::INFINITY);
        assert!(camera.eye.is_finite() && camera.target().is_finite());
    }
}
