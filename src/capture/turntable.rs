//! A full turn as an animation: of the camera around the model, of the light, or of the model in its light.

use std::f32::consts::TAU;
use std::path::Path;

use glam::{Quat, Vec3};

use super::{Animation, CaptureError, Renderer, Tell, image_of, tell};
use crate::frame::{Display, Limits};
use crate::message::did_you_mean;
use crate::scene::{Model, view_of};
use crate::settings::{CameraSettings, Settings, ViewRange};

/// Frames at equal angles that are drawn first to find one range for the whole animation, if a mode's range is automatic.
/// Otherwise the brightness of the same value would change from frame to frame. Values that appear only between these angles may
/// be clipped.
const RANGE_SAMPLES: u32 = 8;

/// The object that a turntable rotates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Turn {
    /// The camera around the model.
    #[default]
    Camera,
    /// Environment and orbiting lights around the model.
    Light,
    /// The model, with fixed light, as on a turntable.
    Model,
}

impl Turn {
    /// Its names on the command line.
    pub const NAMES: [&str; 3] = ["camera", "light", "model"];

    /// The [`Turn`] with this name.
    ///
    /// # Errors
    /// A message with the names.
    pub fn named(name: &str) -> Result<Self, String> {
        match name {
            "camera" => Ok(Self::Camera),
            "light" => Ok(Self::Light),
            "model" => Ok(Self::Model),
            other => {
                let hint = did_you_mean(other, Self::NAMES);
                Err(format!("`{other}` cannot turn.{hint} It can be camera, light or model"))
            }
        }
    }
}

/// A turntable animation.
#[derive(Clone, Copy, Debug)]
pub struct Turntable {
    /// Frames of a full turn.
    pub frames: u32,
    /// Frames a second.
    pub fps: f32,
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// The object that the turntable rotates.
    pub turn: Turn,
}

impl Turntable {
    /// Most frames.
    pub const MOST_FRAMES: u32 = 10_000;

    /// Draws all frames and writes the animation. The first frame is the one that the settings describe, except that a framed
    /// model is framed so that it fits at every angle. Restores the settings afterwards.
    ///
    /// # Errors
    /// A number that is out of range, a picture that cannot be drawn, a file that cannot be written.
    pub fn write(&self, renderer: &mut dyn Renderer, path: &Path, tell: Tell<'_>) -> Result<(), CaptureError> {
        if !(1..=Self::MOST_FRAMES).contains(&self.frames) {
            let message = format!("a turntable of {} frames: it can have 1 to {}", self.frames, Self::MOST_FRAMES);
            return Err(CaptureError::Usage(message));
        }
        let animation = Animation::new(path, self.fps, self.frames as usize)?;
        let before = renderer.settings().clone();
        let written = self.draw(renderer, &before, animation, tell);
        *renderer.settings() = before;
        written
    }

    fn draw(
        &self,
        renderer: &mut dyn Renderer,
        settings: &Settings,
        mut animation: Animation,
        progress: Tell<'_>,
    ) -> Result<(), CaptureError> {
        let model = renderer.session().model().cloned().unwrap_or_default();
        let aspect = self.size.0 as f32 / self.size.1.max(1) as f32;
        let camera = match self.turn {
            Turn::Light => settings.camera.clone(),
            Turn::Camera | Turn::Model => steady(&settings.camera, &model, aspect),
        };
        let mut begin = Settings { camera, ..settings.clone() };
        let samples = if is_measured(renderer, &begin) { self.frames.min(RANGE_SAMPLES) } else { 0 };
        let all = (samples + self.frames) as usize;
        let mut range = None;
        for sample in 0..samples {
            tell(progress, sample as usize, all)?;
            *renderer.settings() = self.turned(&begin, sample as f32 / samples as f32);
            renderer.capture(self.size)?;
            range = union(range, renderer.measured_limits());
        }
        if let Some((low, high)) = range {
            begin.view.range = ViewRange::Fixed(low, high);
        }
        for index in 0..self.frames {
            tell(progress, (samples + index) as usize, all)?;
            *renderer.settings() = self.turned(&begin, index as f32 / self.frames as f32);
            animation.add(image_of(renderer.capture(self.size)?)?)?;
        }
        tell(progress, all, all)?;
        animation.finish()
    }

    /// The settings after a fraction of a turn.
    fn turned(&self, begin: &Settings, turn: f32) -> Settings {
        let mut settings = begin.clone();
        if self.turn != Turn::Light {
            settings.camera = turned(&begin.camera, turn);
        }
        if self.turn != Turn::Camera {
            turn_light(&mut settings, turn);
        }
        // Animations of the model play on.
        let animation = &mut settings.animation;
        animation.time += animation.speed * turn * self.frames as f32 / self.fps;
        settings
    }
}

/// Whether each frame would have an automatic range of its own.
fn is_measured(renderer: &dyn Renderer, settings: &Settings) -> bool {
    let shaders = renderer.shaders();
    let mode = shaders.modes.iter().find(|mode| mode.slug == settings.mode);
    Display::new(&settings.view, mode).is_measured()
}

/// The union of both ranges.
fn union(a: Option<Limits>, b: Option<Limits>) -> Option<Limits> {
    match (a, b) {
        (Some(a), Some(b)) => Some((a.0.min(b.0), a.1.max(b.1))),
        (one, other) => one.or(other),
    }
}

/// A camera with an eye. A framed model is seen from a distance at which it fits at every angle, so that its size does not
/// pulsate.
fn steady(camera: &CameraSettings, model: &Model, aspect: f32) -> CameraSettings {
    let bounds = &model.bounds;
    let at = |azimuth: f32| {
        let camera = CameraSettings { azimuth, ..camera.clone() };
        view_of(model, &camera, aspect)
    };
    let view = at(camera.azimuth);
    if camera.eye.is_some() || camera.target.is_some() || model.camera(&camera.name).is_some() {
        return CameraSettings { eye: Some(view.eye.into()), target: Some(view.target.into()), ..camera.clone() };
    }
    let views = || (0..24).map(|step| at(step as f32 * 15.0)).chain([view]);
    // The axis goes through the center, around which the fitting targets lie.
    let farthest = |distance: fn(&crate::scene::CameraView, Vec3) -> f32| {
        views().map(|view| distance(&view, bounds.center())).fold(0.0, f32::max)
    };
    let distance = farthest(|view, _| view.eye.distance(view.target))
        + farthest(|view, center| Vec3::new(view.target.x - center.x, 0.0, view.target.z - center.z).length());
    let height = views().map(|view| view.target.y).sum::<f32>() / views().count() as f32;
    let target = Vec3::new(bounds.center().x, height, bounds.center().z);
    let eye = target - view.forward() * distance;
    CameraSettings { eye: Some(eye.into()), target: Some(target.into()), ..camera.clone() }
}

/// The camera after a fraction of a turn around the axis through its target.
fn turned(camera: &CameraSettings, turn: f32) -> CameraSettings {
    let (Some(eye), Some(target)) = (camera.eye, camera.target) else { return camera.clone() };
    let target = Vec3::from(target);
    let offset = Quat::from_rotation_y(turn * TAU) * (Vec3::from(eye) - target);
    CameraSettings { eye: Some((target + offset).into()), ..camera.clone() }
}

/// Rotates environment and orbiting lights with the camera, so that the model seems to rotate.
fn turn_light(settings: &mut Settings, turn: f32) {
    let wrapped = |degrees: f32| (degrees + 180.0).rem_euclid(360.0) - 180.0;
    let angle = turn * 360.0;
    let environment = &mut settings.environment.rotation;
    *environment = wrapped(*environment + angle);
    for light in &mut settings.lights.orbit {
        light.azimuth = wrapped(light.azimuth + angle);
    }
    settings.lights.rect.azimuth = wrapped(settings.lights.rect.azimuth + angle);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_goes_around_the_target() {
        let camera =
            CameraSettings { eye: Some([1.0, 2.0, 3.0]), target: Some([1.0, 0.0, 0.0]), ..CameraSettings::default() };
        assert_eq!(turned(&camera, 0.0), camera);
        let quarter = Vec3::from(turned(&camera, 0.25).eye.unwrap());
        assert!(quarter.distance(Vec3::new(4.0, 2.0, 0.0)) < 1e-5, "{quarter}");
    }

    #[test]
    fn names_are_known() {
        assert_eq!(Turn::NAMES.map(|name| Turn::named(name).unwrap()), [Turn::Camera, Turn::Light, Turn::Model]);
        assert!(Turn::named("lights").unwrap_err().contains("Did you mean `light`?"));
    }
}
