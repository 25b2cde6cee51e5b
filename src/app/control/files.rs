//! Writes pictures of the screen, on a thread.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::{DynamicImage, RgbaImage};
use serde_json::json;

use super::text::path_text;
use crate::app::engine::Engine;
use crate::app::frames::picture::shown_session_state;
use crate::app::state::State;
use crate::app::state::waiting::Shot;
use crate::gpu::Buffer;
use crate::picture;
use crate::recovery::SessionState;
use crate::render::Capture;
use crate::threads::TaskKind;

/// Writes the picture of the screen, and answers.
pub(in crate::app) fn write_shot(state: &State, engine: &Engine, shot: Shot, capture: Capture) {
    let work = shown_session_state(state);
    engine.threads.wait(move || {
        let Shot { reply, file } = shot;
        match write_capture(&capture, &work, file.as_deref()) {
            Ok(file) => {
                let (width, height) = (capture.width, capture.height);
                reply.done(json!({ "file": path_text(&file), "width": width, "height": height }));
            }
            Err(message) => reply.error(message),
        }
        None
    });
}

/// Writes the picture of the window, whose copy to `pixels` has finished, and answers.
pub(in crate::app) fn write_window_shot(
    engine: &mut Engine,
    shot: Shot,
    pixels: Arc<Buffer>,
    (width, height): (u32, u32),
) {
    engine.threads.use_device(TaskKind::External, move |_| {
        let Shot { reply, file } = shot;
        let mut bgra = pixels.read();
        for pixel in bgra.chunks_exact_mut(4) {
            pixel.swap(0, 2);
            pixel[3] = 255;
        }
        let file = file.unwrap_or_else(picture::numbered);
        let written = RgbaImage::from_raw(width, height, bgra)
            .ok_or_else(|| "the window could not be read completely".to_owned());
        let written = written.and_then(|image| picture::write_image(&DynamicImage::ImageRgba8(image), &file));
        match written {
            Ok(()) => reply.done(json!({ "file": path_text(&file), "width": width, "height": height })),
            Err(message) => reply.error(message),
        }
    });
}

/// Writes a capture to a file, or to the first free `specula-N.png`.
pub(super) fn write_capture(capture: &Capture, work: &SessionState, file: Option<&Path>) -> Result<PathBuf, String> {
    let file = file.map_or_else(picture::numbered, Path::to_owned);
    picture::write(capture, work, &file).map(|()| file)
}
