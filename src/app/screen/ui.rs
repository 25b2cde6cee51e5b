//! The user interface on the screen: runs the panels and draws them over the picture.

use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::window::Window;

use super::Screen;
use crate::app::actions::select::selected_instances;
use crate::app::actions::sessions::update_offer;
use crate::app::command::execute;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::engine::Engine;
use crate::app::frames::stages::update_stages;
use crate::app::frames::title::title;
use crate::app::panels;
use crate::app::readings::Readings;
use crate::app::state::State;
use crate::app::state::grid::PictureRect;
use crate::gpu::{Attachments, Encoder, GpuError, Image, Rect, Use};
use crate::scene::built_in_pictures;
use crate::threads::Message;

impl Screen {
    /// Runs the panels. Returns their primitives, the pixels per point, and the delay until egui wants a repaint.
    pub(super) fn run_ui(
        &mut self,
        window: &Window,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<(Vec<egui::ClippedPrimitive>, f32, Option<Duration>), GpuError> {
        self.read_pixel();
        self.read_range_sample();
        self.show_background(state, engine);
        self.take_copies(engine);
        self.finish_window_shot(engine);
        if self.gallery.is_misfit(&engine.gpu, &state.workspace.sight, self.egui.pixels_per_point()) {
            // SYNC: rare, because thumbnails change their size only with the width of their panel.
            self.frames.wait_all()?;
            self.background.wait()?;
            self.gallery.drop_texture(&mut self.ui);
        }
        self.take_times(state, engine);
        let prepared = self.prepare_texture(state, engine);
        self.survive(prepared)?;
        update_stages(state, engine);
        update_offer(state);
        selected_instances(state);
        state.workspace.take_requests().iter().for_each(|request| self.panels.carry_out(request));
        let readings = Readings {
            value: self.readout(state),
            title: title(state, self.view.accumulated()),
            legend: self.legend(state),
            thumbnails: &self.gallery.thumbnails,
            texture: self.texture.shown,
            baking: engine.threads.baker.progress(),
            pipelines: engine.resources.pipelines().map_or(0, |set| set.count()),
            baked: &engine.resources.environment().report,
            memory: state.workspace.sight.timing.then(|| self.memory.read(&engine.gpu)),
        };
        let input = self.input.take_egui_input(window);
        let begin = Instant::now();
        let (context, mut commands) = (Context::new(state, readings), Commands::new(&state.session.settings));
        let (mut shown, panels) = (None, &mut self.panels);
        let output = self.egui.run_ui(input, |ui| shown = Some(panels::show(ui, &context, panels, &mut commands)));
        let panels_ms = begin.elapsed().as_secs_f64() * 1e3;
        if std::mem::take(&mut self.panels.open_gallery.wants_pictures) {
            engine.threads.wait(|| Some(Message::Pictures(Box::new(built_in_pictures()))));
        }
        let (commands, sight) = commands.finish(&state.session.settings);
        state.workspace.sight = sight;
        commands.into_iter().for_each(|command| execute(state, engine, command));
        state.grid.follow(&state.session.settings.mode);
        // A drag, or a number that is being typed, is one step.
        let is_held = self.egui.input(|input| input.pointer.any_down()) || self.egui.egui_wants_keyboard_input();
        state.history.record(&state.session.shared_settings(), is_held);
        self.input.handle_platform_output(window, output.platform_output);
        if let Some((swapchain, area)) = self.swapchain.as_ref().zip(shown) {
            self.whole = pixels(area.rect, output.pixels_per_point, swapchain.extent());
            self.free = area.free;
        }
        self.arrange_grid(state);
        self.take_textures(output.textures_delta)?;
        let begin = Instant::now();
        let primitives = self.egui.tessellate(output.shapes, output.pixels_per_point);
        self.cpu.ui_ms = panels_ms + begin.elapsed().as_secs_f64() * 1e3;
        let delay = output.viewport_output.get(&egui::ViewportId::ROOT).map(|viewport| viewport.repaint_delay);
        Ok((primitives, output.pixels_per_point, delay))
    }

    /// Draws the user interface over an image in [`Use::Color`].
    pub(super) fn draw_ui(
        &mut self,
        encoder: &mut Encoder,
        image: &Arc<Image>,
        pixels_per_point: f32,
        primitives: &[egui::ClippedPrimitive],
    ) -> Result<(), GpuError> {
        let (width, height) = (image.desc().width, image.desc().height);
        encoder.transition(image, Use::Color, Use::Color);
        let area = Rect { x: 0, y: 0, width, height };
        let over = Attachments { area, ..Attachments::of(image) };
        encoder.begin_rendering(&over);
        self.ui.draw(encoder, (width, height), pixels_per_point, primitives)?;
        encoder.end_rendering();
        Ok(())
    }

    /// Uploads egui's textures, and frees those that no later frame uses. The next frame tries a failed upload again.
    /// SYNC: waits for the frames in flight; this is rare, because textures change only with a new glyph or image.
    fn take_textures(&mut self, delta: egui::TexturesDelta) -> Result<(), GpuError> {
        if !delta.is_empty() || !self.textures.is_empty() {
            self.frames.wait_all()?;
            self.ui.free_textures(&self.textures)?;
            self.textures.free.clear();
            self.textures.append(delta);
            self.ui.set_textures(&self.textures)?;
            self.textures.set.clear();
        }
        Ok(())
    }
}

/// Converts a rectangle from egui's points to pixels inside the window, with at least one pixel a side.
fn pixels(rect: egui::Rect, pixels_per_point: f32, (width, height): (u32, u32)) -> PictureRect {
    let pixel = |points: f32, most: u32| ((points * pixels_per_point).round().max(0.0) as u32).min(most);
    let (x, y) = (pixel(rect.min.x, width - 1), pixel(rect.min.y, height - 1));
    let right = pixel(rect.max.x, width).saturating_sub(x).max(1);
    PictureRect { at: (x, y), size: (right, pixel(rect.max.y, height).saturating_sub(y).max(1)) }
}
