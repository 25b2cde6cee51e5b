//! Everything that a frame depends on.

use std::path::PathBuf;
use std::sync::Arc;

use super::date::Date;
use super::formats::TargetFormat;
use super::keys::Keys;
use super::scene::Scene;
use crate::scene::{has_exact_sun, separates_suns};
use crate::settings::Settings;
use crate::shader::ShaderSet;

/// Everything that a frame depends on.
#[derive(Clone, Copy)]
pub struct FrameInputs<'a> {
    /// The user's settings. A mode that the tree lacks falls back to the tree's first mode. A value that does not fit its
    /// shader parameter falls back to the parameter's default.
    pub settings: &'a Settings,
    /// One generation of shaders.
    pub shaders: &'a Arc<ShaderSet>,
    /// The model as the settings show it, in its pose; `None` draws the background alone.
    pub scene: Option<&'a Scene>,
    /// Revisions of the files of `settings.environment.name` and `settings.measured`.
    pub revisions: Revisions,
    /// The time, for animated shaders, and the input.
    pub clock: Clock,
    /// Width and height of the picture, pixels.
    pub size: (u32, u32),
    /// Format of the HDR target.
    pub target: TargetFormat,
}

/// [`Clock::cursor_px`] while the mouse is not over the picture.
pub(crate) const BEYOND: [f32; 2] = [-1.0; 2];

/// The time of a frame, and the state of mouse and keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Seconds since the start.
    pub time_s: f32,
    /// Seconds since the frame before.
    pub delta_s: f32,
    /// Frames before this one.
    pub frame_index: u32,
    /// The mouse over the picture: `interface::Frame::mouse_px`.
    pub mouse_px: [f32; 4],
    /// Where the mouse is: `interface::Frame::cursor_px`.
    pub cursor_px: [f32; 2],
    /// The buttons that are down: `interface::Frame::mouse_buttons`.
    pub mouse_buttons: u32,
    /// The date and the time of the day.
    pub date: Date,
    /// The keys.
    pub keys: Keys,
}

impl Default for Clock {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            delta_s: 0.0,
            frame_index: 0,
            mouse_px: [0.0; 4],
            cursor_px: BEYOND,
            mouse_buttons: 0,
            date: Date::default(),
            keys: Keys::default(),
        }
    }
}

/// Counts the changes of watched files, so that the same name is loaded again after a change. Also holds what is known only after
/// a bake.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Revisions {
    /// Changes of the environment map.
    pub environment: u64,
    /// Changes of the measured BRDF.
    pub measured: u64,
    /// Suns of the environment that was baked last. Until a map is baked it counts as having none, so that frames without suns
    /// contain no code for them; `Resources` binds no frame to an environment with more suns.
    pub suns: u32,
}

impl Revisions {
    /// The suns of the environment that lights a frame with these settings, as far as known. While the map of the settings is
    /// being baked, this is the previous environment.
    pub(crate) fn suns_of(self, settings: &Settings) -> u32 {
        let environment = &settings.environment;
        let exact = separates_suns(environment) && has_exact_sun(&environment.name);
        if environment.is_lit() { self.suns.max(exact.into()) } else { 0 }
    }
}

/// Identifies a measured BRDF.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredKey {
    /// MERL or UTIA file.
    pub path: PathBuf,
    pub(super) revision: u64,
}
