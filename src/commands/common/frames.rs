//! The options that say which frames a command draws, for shaders that move.

use specula::frame::{Date, Keys};
use specula::headless::Sequence;

use crate::commands::Failure;

/// Parses a place in the picture, such as `640,360`.
fn place(text: &str) -> Result<[f32; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f32| number.is_finite() && *number >= 0.0);
    let found = text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
    found.ok_or_else(|| "expected two numbers of pixels, such as 640,360".to_owned())
}

/// Frames at even distances in time, and the input in them.
#[derive(clap::Args, Clone, Debug)]
pub struct Frames {
    /// Draw N frames and show the last, for passes that read the previous frame [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: Option<u32>,
    /// Time of the first frame in seconds, for animated shaders and models
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    pub time: f32,
    /// Frames per second, for animated shaders and models [default: 60]
    #[arg(long, value_name = "N")]
    pub fps: Option<f32>,
    /// Keys that are down in all frames, such as A,Space,Left, for shaders that read keys. They go down in the first frame
    #[arg(long, value_name = "NAMES")]
    pub keys: Option<Keys>,
    /// Where the left mouse button is down in all frames, pixels from the upper left corner, for shaders that read the mouse
    #[arg(long, value_name = "X,Y", value_parser = place)]
    pub mouse: Option<[f32; 2]>,
    /// Date at time 0, such as 2026-11-23T16:00:00, for shaders that read it [default: 2000-01-01]
    #[arg(long, value_name = "DATE")]
    pub date: Option<Date>,
}

impl Frames {
    /// The frames.
    ///
    /// # Errors
    /// A time or a frame rate out of range.
    pub fn sequence(&self) -> Result<Sequence, Failure> {
        let fps = self.fps.unwrap_or(60.0);
        if !self.time.is_finite() || !(0.001..=100_000.0).contains(&fps) {
            return Err(Failure::Usage(
                "--time takes a number of seconds, and --fps 0.001 to 100000 frames a second".into(),
            ));
        }
        Ok(Sequence {
            frames: self.frames.unwrap_or(1),
            start_s: self.time,
            fps,
            date: self.date.unwrap_or_default(),
            keys: self.keys.unwrap_or_default(),
            mouse_px: self.mouse,
        })
    }
}

impl super::Common {
    /// Width and height of the picture, pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size.unwrap_or((1280, 720))
    }
}
