//! The window's surface: swapchain, renderer, egui. One call of [`Screen::draw`] is one frame on the screen.

use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::event::WindowEvent;
use winit::raw_window_handle::{HasDisplayHandle as _, HasWindowHandle as _};
use winit::window::Window;

use crate::events::{Event, emit};
use crate::gpu::{Buffer, Gpu, GpuError, Rect, SetLayouts, Surface, Swapchain, UiRenderer};
use crate::picture;
use crate::render::{Drawn, FrameInput, GpuEnvironment, Renderer, Shot, Target, UiFrame};
use crate::scene::View;

use super::camera::CameraHand;
use super::document::{Document, Hover, SCENE_FORMAT, Shown};
use super::panels;

/// Frames that a picture is the mean of at most: more change nothing that can be seen.
const MOST_ACCUMULATED: u32 = 4096;

/// The screen. Fields drop in order: what draws, then what it draws to.
pub(super) struct Screen {
    ui: UiRenderer,
    renderer: Renderer,
    swapchain: Option<Swapchain>,
    surface: Arc<Surface>,
    layouts: Arc<SetLayouts>,
    egui: egui::Context,
    input: egui_winit::State,
    to_free: egui::TexturesDelta,
    stale: bool,
    first: bool,
    /// Where the picture is, in pixels of the window.
    pub(super) rect: Rect,
    /// The camera of the last frame.
    pub(super) view: Option<View>,
    last_frame: Instant,
}

impl Screen {
    pub(super) fn new(gpu: &Arc<Gpu>, window: &Arc<Window>) -> Result<Self, GpuError> {
        let handles = window.display_handle().and_then(|d| Ok((d.as_raw(), window.window_handle()?.as_raw())));
        let (display, handle) = handles.map_err(|e| GpuError::NoDevice(format!("the window has no handle: {e}")))?;
        let surface = Surface::new(gpu, display, handle)?;
        let layouts = SetLayouts::new(gpu)?;
        let egui = egui::Context::default();
        panels::style(&egui);
        let input = egui_winit::State::new(
            egui.clone(),
            egui::ViewportId::ROOT,
            window,
            Some(window.scale_factor() as f32),
            None,
            Some(gpu.max_image_size() as usize),
        );
        Ok(Self {
            ui: UiRenderer::new(gpu, Swapchain::FORMAT, Renderer::IN_FLIGHT)?,
            renderer: Renderer::new(gpu, &layouts, SCENE_FORMAT)?,
            swapchain: None,
            surface,
            layouts,
            egui,
            input,
            to_free: egui::TexturesDelta::default(),
            stale: true,
            first: true,
            rect: Rect::default(),
            view: None,
            last_frame: Instant::now(),
        })
    }

    pub(super) fn layouts(&self) -> &Arc<SetLayouts> {
        &self.layouts
    }

    pub(super) fn on_window_event(&mut self, window: &Window, event: &WindowEvent) -> egui_winit::EventResponse {
        self.input.on_window_event(window, event)
    }

    pub(super) fn resized(&mut self) {
        self.stale = true;
    }

    /// Draws a frame; returns when the next one is due: `None` is not before something happens.
    pub(super) fn draw(&mut self, window: &Window, document: &mut Document) -> Result<Option<Duration>, GpuError> {
        let size = window.inner_size();
        if self.stale || self.swapchain.is_none() {
            let old = self.swapchain.take();
            let vsync = document.gpu_is_fast();
            self.swapchain = Swapchain::new(&self.surface, (size.width, size.height), Renderer::IN_FLIGHT, vsync, old)?;
            self.stale = false;
        }
        let Some(extent) = self.swapchain.as_ref().map(Swapchain::extent) else { return Ok(None) };

        document.hover = self.hover(document)?;
        document.accumulated = self.renderer.accumulated();

        // The user interface, which also tells where the picture goes.
        let input = self.input.take_egui_input(window);
        let mut picture = egui::Rect::NOTHING;
        let device_ms = self.renderer.device_ms();
        let output = self.egui.run_ui(input, |ui| picture = panels::show(ui, document, device_ms));
        self.input.handle_platform_output(window, output.platform_output);
        self.rect = pixels(picture, output.pixels_per_point, extent);
        self.take_textures(output.textures_delta)?;
        let primitives = self.egui.tessellate(output.shapes, output.pixels_per_point);

        // The picture behind it.
        let aspect = self.rect.width as f32 / self.rect.height.max(1) as f32;
        let moving = self.move_on(document, aspect);
        let shown = document.shown();
        let shot = shot(document, shown.as_ref(), aspect);
        self.view = Some(shot.view);
        let (environment, measured) = surroundings(document, shown.as_ref());
        let frame = frame_input(&shot, shown.as_ref(), (&environment, &measured), self.rect);
        let Some(swapchain) = &mut self.swapchain else { return Ok(None) };
        let ui = UiFrame { renderer: &mut self.ui, primitives: &primitives, pixels_per_point: output.pixels_per_point };
        let begin = Instant::now();
        match self.renderer.frame(frame, Target::Window(swapchain, ui))? {
            Drawn::Shown { fits } => self.stale |= !fits,
            Drawn::NoImage => self.stale = true,
            Drawn::Captured(_) | Drawn::Finished => {}
        }
        if std::mem::take(&mut self.first) {
            // SYNC: once, so that the time is that of a finished frame.
            self.renderer.wait_for_frames()?;
            emit(document.events, &Event::Window { ms: document.start.elapsed().as_secs_f64() * 1e3 });
        }
        if document.screenshot {
            document.screenshot = false;
            self.screenshot(document, &shot, shown.as_ref())?;
        }
        if document.times_next_frame() {
            // SYNC: once a reload, so that its first frame's time is that of the finished frame.
            self.renderer.wait_for_frames()?;
            document.frame_done(shown.as_ref(), begin.elapsed().as_secs_f64() * 1e3);
        }
        // The value under the mouse belongs to the picture before this one: once more, when this one differs.
        let hover_is_old = document.mouse.over && self.renderer.redrawn();
        let gets_better = document.accumulates() && self.renderer.accumulated() < MOST_ACCUMULATED;
        if self.stale || moving || hover_is_old || document.moves() || gets_better {
            return Ok(Some(Duration::ZERO));
        }
        let delay = output.viewport_output.get(&egui::ViewportId::ROOT).map(|v| v.repaint_delay);
        Ok(delay.filter(|delay| *delay < Duration::from_secs(3600)))
    }

    /// The raw value under the mouse in the picture on screen.
    fn hover(&self, document: &Document) -> Result<Option<Hover>, GpuError> {
        let at = document.mouse.at;
        let (x, y) = (at.x - self.rect.x as f32, at.y - self.rect.y as f32);
        if x < 0.0 || y < 0.0 || !document.mouse.over {
            return Ok(None);
        }
        let value = self.renderer.raw_at(x as u32, y as u32)?;
        Ok(value.filter(|value| value[3] > 0.0).map(|value| Hover { x: x as u32, y: y as u32, value }))
    }

    /// Moves a flying camera and orbiting lights on; returns whether the camera moved.
    fn move_on(&mut self, document: &mut Document, aspect: f32) -> bool {
        let seconds = self.last_frame.elapsed().as_secs_f32();
        self.last_frame = Instant::now();
        // A pause is no movement: the first frame after one continues where the last one was.
        document.turn_lights(seconds.min(0.5));
        let view = CameraHand::view(&document.settings.camera, &document.model, aspect);
        let bounds = document.model.bounds;
        document.hand.step(&mut document.settings.camera, &view, &bounds, seconds)
    }

    /// Hands egui's textures to the device. They change when a glyph or an image is new, so waiting costs nothing that shows.
    fn take_textures(&mut self, mut delta: egui::TexturesDelta) -> Result<(), GpuError> {
        if !delta.is_empty() || !self.to_free.is_empty() {
            self.renderer.wait_for_frames()?;
            self.ui.free_textures(&self.to_free)?;
            self.to_free.clear();
            self.ui.set_textures(&delta)?;
            delta.set.clear();
            std::mem::swap(&mut self.to_free, &mut delta);
        }
        delta.clear();
        Ok(())
    }

    /// Writes the picture, without panels, to `specula-N.png` in the working directory.
    fn screenshot(&mut self, document: &mut Document, shot: &Shot, shown: Option<&Shown>) -> Result<(), GpuError> {
        let (environment, measured) = surroundings(document, shown);
        let frame = frame_input(shot, shown, (&environment, &measured), Rect { x: 0, y: 0, ..self.rect });
        if let Drawn::Captured(capture) = self.renderer.frame(frame, Target::Memory)? {
            let free = (1..).map(|n| std::path::PathBuf::from(format!("specula-{n}.png"))).find(|p| !p.exists());
            let path = free.unwrap_or_else(|| "specula.png".into());
            match picture::write(&capture, &path) {
                Ok(()) => {
                    document.say(format!("wrote {}", path.display()));
                    emit(document.events, &Event::Screenshot { file: &path.display().to_string() });
                }
                Err(message) => document.say(message),
            }
        }
        Ok(())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.to_free.clear();
    }
}

/// Camera, lights and values of a frame. The mode is the one whose pipelines are shown, and so are the kinds of light.
fn shot(document: &Document, shown: Option<&Shown>, aspect: f32) -> Shot {
    // A picture that does not move by itself is kept, so its time stands still.
    let time_s = if document.moves() { document.start.elapsed().as_secs_f32() } else { 0.0 };
    let mut settings = document.settings.clone();
    if let Some(shown) = shown {
        settings.mode.clone_from(&shown.mode);
        settings.lights.source = shown.lights;
        settings.lights.rect.enabled = shown.rect;
    }
    let view = CameraHand::view(&settings.camera, &document.model, aspect);
    Shot::new(&settings, shown.map(|s| &*s.pipelines.shaders), &document.model, view, time_s)
}

/// The environment and the measured BRDF of a frame.
fn surroundings(document: &Document, shown: Option<&Shown>) -> (Arc<GpuEnvironment>, Arc<Buffer>) {
    match shown {
        Some(shown) => (shown.environment.clone(), shown.measured.clone()),
        None => (document.surroundings.baked.environment.clone(), document.surroundings.measured.clone()),
    }
}

fn frame_input<'a>(
    shot: &'a Shot,
    shown: Option<&'a Shown>,
    (environment, measured): (&'a Arc<GpuEnvironment>, &'a Arc<Buffer>),
    rect: Rect,
) -> FrameInput<'a> {
    let pipelines = shown.map(|s| (&s.pipelines, &s.wanted));
    FrameInput { shot, pipelines, scene: shown.and_then(|s| s.scene.as_ref()), environment, measured, rect }
}

/// A rectangle of egui's points as whole pixels inside the window, at least one pixel large.
fn pixels(rect: egui::Rect, pixels_per_point: f32, (width, height): (u32, u32)) -> Rect {
    let pixel = |points: f32, most: u32| ((points * pixels_per_point).round().max(0.0) as u32).min(most);
    let (x, y) = (pixel(rect.min.x, width - 1), pixel(rect.min.y, height - 1));
    Rect {
        x,
        y,
        width: pixel(rect.max.x, width).saturating_sub(x).max(1),
        height: pixel(rect.max.y, height).saturating_sub(y).max(1),
    }
}
