//! Many pictures in one file: a contact sheet of modes and settings, and animations. The same code serves a command, which has a [`Headless`], and
//! the window, which draws with [`OffscreenCapture`] on a thread.

mod animation;
mod cells;
mod label;
mod modes;
mod movie;
mod mp4;
mod offscreen;
mod sheet;
mod sweep;
mod turntable;
mod webp;
mod yuv;

use std::path::Path;
use std::sync::Arc;

use image::{DynamicImage, RgbaImage};

use crate::frame::Limits;
use crate::headless::{Headless, HeadlessError};
use crate::picture;
use crate::render;
use crate::session::Session;
use crate::settings::Settings;
use crate::shader::ShaderSet;

pub use animation::{Animation, check_animation};
pub use cells::{Cell, cells_of_modes, swept};
pub use modes::modes_of;
pub use movie::write_movie;
pub use offscreen::OffscreenCapture;
pub(crate) use offscreen::VersionPicture;
pub use sheet::{Page, SheetPlan};
pub use sweep::Sweep;
pub use turntable::{Turn, Turntable};

/// Draws pictures of a session at any size.
pub trait Renderer {
    /// The settings of the next picture.
    fn settings(&mut self) -> &mut Settings;

    /// The settings, the model and the shaders.
    fn session(&self) -> &Session;

    /// Draws the picture that the settings describe.
    ///
    /// # Errors
    /// Settings that do not fit, a bad file, a device error.
    fn capture(&mut self, size: (u32, u32)) -> Result<render::Capture, HeadlessError>;

    /// The limits of the values in the last picture, if its range follows them.
    fn measured_limits(&self) -> Option<Limits>;

    /// The shaders in use.
    fn shaders(&self) -> Arc<ShaderSet> {
        self.session().shaders.clone().unwrap_or_default()
    }
}

impl Renderer for Headless {
    fn settings(&mut self) -> &mut Settings {
        self.settings_mut()
    }

    fn session(&self) -> &Session {
        Headless::session(self)
    }

    fn capture(&mut self, size: (u32, u32)) -> Result<render::Capture, HeadlessError> {
        self.set_size(size)?;
        self.render()
    }

    fn measured_limits(&self) -> Option<Limits> {
        Headless::measured_limits(self)
    }
}

/// Why no file was written.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// A picture cannot be drawn.
    #[error(transparent)]
    Render(#[from] HeadlessError),
    /// A value that no capture can have.
    #[error("{0}")]
    Usage(String),
    /// The file cannot be written.
    #[error("{0}")]
    Write(String),
    /// The user has canceled it.
    #[error("canceled")]
    Canceled,
}

/// Receives how many frames are done, and of how many. Returns whether to continue.
pub type Tell<'a> = &'a mut dyn FnMut(u64, u64) -> bool;

/// Reports progress, and ends the work if it is canceled.
fn tell(tell: Tell<'_>, done: usize, of: usize) -> Result<(), CaptureError> {
    if tell(done as u64, of as u64) { Ok(()) } else { Err(CaptureError::Canceled) }
}

/// The LDR output of a capture as an image.
fn image_of(capture: render::Capture) -> Result<RgbaImage, CaptureError> {
    let render::Capture { width, height, rgba8, .. } = capture;
    RgbaImage::from_raw(width, height, rgba8)
        .ok_or_else(|| CaptureError::Write("a picture was not read whole".to_owned()))
}

/// Writes an image to a PNG file.
fn write(image: RgbaImage, path: &Path) -> Result<(), CaptureError> {
    picture::write_image(&DynamicImage::ImageRgba8(image), path).map_err(CaptureError::Write)
}
