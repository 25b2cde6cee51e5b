//! Pictures of the screen that commands have asked for: of the picture alone, and of the whole window.

use std::sync::Arc;

use super::Screen;
use super::window_shot::WindowShot;
use crate::app::control::{take_shots, take_window_shot, write_shot, write_window_shot};
use crate::app::engine::Engine;
use crate::app::frames::picture::shown_session_state;
use crate::app::state::State;
use crate::events::{Event, emit};
use crate::gpu::{Buffer, Encoder, GpuError, Image, Memory, Use, vk};
use crate::picture;
use crate::render::{BoundFrame, Capture, Output, Redraw};

impl Screen {
    /// Writes the screenshot that a key has asked for. It waits for the first picture, and for the range of a mode's values.
    pub(super) fn take_screenshot(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        frame: &BoundFrame,
    ) -> Result<(), GpuError> {
        if !state.screenshot || self.view.lacks_limits(frame) {
            return Ok(());
        }
        state.screenshot = false;
        match self.write_screenshot(state, engine, frame) {
            Err(error) if error.is_shortage() => {
                self.view.forget();
                self.reference = None;
                state.say(format!("no screenshot: {error}"));
                Ok(())
            }
            written => written,
        }
    }

    /// Writes the picture, without panels, to `specula-N.png` in the working directory.
    fn write_screenshot(&mut self, state: &mut State, engine: &mut Engine, frame: &BoundFrame) -> Result<(), GpuError> {
        let Some(capture) = self.read_picture(state, engine, frame)? else { return Ok(()) };
        match picture::write_numbered(&capture, &shown_session_state(state)) {
            Ok(path) => {
                let whole = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
                state.say(format!("wrote {}", whole.display()));
                emit(&state.events, &Event::Screenshot { file: &path.display().to_string() });
            }
            Err(message) => state.say(message),
        }
        Ok(())
    }

    /// Draws the picture as it is on screen, without panels, and reads it back.
    fn read_picture(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        frame: &BoundFrame,
    ) -> Result<Option<Capture>, GpuError> {
        let image = self.view.output_image(frame.state.size)?;
        let mut encoder = self.frames.begin()?;
        self.check_loops(state, engine);
        let output = Output { image: &image, before: Use::Undefined, at: (0, 0) };
        let slot = self.frames.current();
        self.view.draw(&mut encoder, slot, frame, &output, Redraw::IfChanged)?;
        self.draw_reference(&mut encoder, slot, &image, (0, 0))?;
        let readback = self.view.read_back(&mut encoder, &image)?;
        self.frames.submit(encoder, Default::default())?;
        // SYNC: the CPU reads the picture.
        self.frames.wait()?;
        Ok(readback.map(|readback| readback.finish()))
    }

    /// Takes the requested captures of what is on screen. A lack of memory fails only them.
    pub(super) fn take_shots(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        frame: &BoundFrame,
    ) -> Result<(), GpuError> {
        if self.view.lacks_limits(frame) {
            return Ok(());
        }
        for shot in take_shots(state, engine) {
            match self.read_picture(state, engine, frame) {
                Ok(Some(capture)) => write_shot(state, engine, shot, capture),
                Ok(None) => shot.reply.error("there is no picture"),
                Err(error) if error.is_shortage() => {
                    self.view.forget();
                    self.reference = None;
                    shot.reply.error(error.to_string());
                }
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Copies the finished image of the window, if requested, and passes it on to be presented.
    pub(super) fn record_window_shot(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        state: &mut State,
        engine: &mut Engine,
        image: &Arc<Image>,
    ) -> Result<(), GpuError> {
        let shot = if self.window_shot.is_none() { take_window_shot(state, engine) } else { None };
        let Some(shot) = shot else {
            encoder.transition(image, Use::Color, Use::Present);
            return Ok(());
        };
        let desc = image.desc();
        if !desc.usage.contains(vk::ImageUsageFlags::TRANSFER_SRC) {
            shot.reply.error("this display's images cannot be read; capture without `ui`");
            encoder.transition(image, Use::Color, Use::Present);
            return Ok(());
        }
        let (width, height) = (desc.width, desc.height);
        let bytes = u64::from(width) * u64::from(height) * 4;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        match Buffer::new(&engine.gpu, "window readback", bytes, usage, Memory::Readback) {
            Ok(pixels) => {
                encoder.transition(image, Use::Color, Use::CopyFrom);
                encoder.copy_from_image(image, &pixels);
                encoder.transition(image, Use::CopyFrom, Use::Present);
                encoder.copies_done();
                self.window_shot = Some(WindowShot { slot, pixels, size: (width, height), shot });
            }
            Err(error) => {
                shot.reply.error(error.to_string());
                encoder.transition(image, Use::Color, Use::Present);
            }
        }
        Ok(())
    }

    /// Writes the picture of the window once the frame that copied it has finished.
    pub(super) fn finish_window_shot(&mut self, engine: &mut Engine) {
        let frames = &self.frames;
        if let Some(WindowShot { pixels, size, shot, .. }) =
            self.window_shot.take_if(|shot| frames.is_finished(shot.slot))
        {
            write_window_shot(engine, shot, pixels, size);
        }
    }
}
