//! Writes pictures of the screen, on a thread.

use std::sync::Arc;

use image::{DynamicImage, RgbaImage};
use serde_json::{Value, json};

use super::text::path_text;
use crate::app::engine::Engine;
use crate::app::frames::picture::shown_session_state;
use crate::app::state::State;
use crate::app::state::captures::Destination;
use crate::app::state::waiting::{Shot, WindowShot};
use crate::gpu::Buffer;
use crate::picture;
use crate::recovery::SessionState;
use crate::render::{Capture, Readback};
use crate::threads::TaskKind;

/// Writes the picture of the screen, whose copy has finished, and answers.
pub(in crate::app) fn write_shot(state: &State, engine: &mut Engine, shot: Shot, readback: Readback) {
    let work = shown_session_state(state);
    engine.threads.use_device(TaskKind::External, move |_| {
        let capture = if shot.to.holds_light() { readback.finish() } else { readback.finish_picture() };
        match write_capture(&capture, &work, &shot.to) {
            Ok(result) => shot.reply.done(result),
            Err(message) => shot.reply.error(message),
        }
    });
}

/// Writes the picture of the window, whose copy to `pixels` has finished, and answers.
pub(in crate::app) fn write_window_shot(
    engine: &mut Engine,
    shot: WindowShot,
    pixels: Arc<Buffer>,
    (width, height): (u32, u32),
) {
    engine.threads.use_device(TaskKind::External, move |_| {
        let WindowShot { reply, file } = shot;
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

/// Writes a capture. Returns the result of the answer, with the time since it was asked for.
pub(super) fn write_capture(capture: &Capture, work: &SessionState, to: &Destination) -> Result<Value, String> {
    let file = to.file.clone().unwrap_or_else(picture::numbered);
    match to.encoding {
        Some(encoding) => picture::write_as(capture, work, &file, encoding)?,
        None => picture::write(capture, work, &file)?,
    }
    let ms = (to.since.elapsed().as_secs_f64() * 1e6).round() / 1e3;
    Ok(json!({ "file": path_text(&file), "width": capture.width, "height": capture.height, "ms": ms }))
}
