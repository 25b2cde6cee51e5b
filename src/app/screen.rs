//! The window's surface: swapchain, egui and the view. Each call of [`Screen::draw`] draws one frame.

mod background;
mod between;
mod cell;
mod error_map;
mod extras;
mod gallery;
mod grid;
mod inspector;
mod loops;
mod measured;
mod memory;
mod number;
mod pace;
mod probe;
mod readout;
mod reference;
mod reference_view;
mod selection;
mod sets;
mod shots;
mod shown_texture;
mod texture;
mod thumbnail;
mod timing;
mod ui;
mod waiting;
mod window_shot;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_winit::accesskit_winit;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::raw_window_handle::{HasDisplayHandle as _, HasWindowHandle as _};
use winit::window::Window;

use super::mouse::Mouse;
use super::panels::Panels;
use super::state::grid::PictureRect;
use super::state::timing::CpuTimes;
use super::widgets;
use crate::app::actions::watch::watch_files;
use crate::app::control::{answer, has_unanswered};
use crate::app::engine::Engine;
use crate::app::frames::picture::next_frame;
use crate::app::frames::progress::set_shortage;
use crate::app::frames::recording;
use crate::app::state::State;
use crate::cpu_clock::CpuClock;
use crate::frame::FrameState;
use crate::gpu::{Frames, Gpu, GpuError, NextImage, SetLayouts, Surface, Swapchain, UiRenderer, Use};
use crate::render::tools::Outline;
use crate::render::{BoundFrame, Output, PixelAt, Readback, Redraw, View};
use crate::scene::{CameraController, CameraView};
use crate::threads::MessageSender;
use background::Background;
pub(super) use between::Next;
use cell::Cell;
use gallery::Gallery;
use inspector::PixelReader;
use measured::ErrorMap;
use memory::MemoryClock;
use number::NumberReader;
use reference_view::ReferenceView;
use shown_texture::ShownTexture;
use window_shot::WindowShot;

/// The CPU prepares a frame while the device draws the previous one.
const FRAMES_IN_FLIGHT: usize = 2;
/// Time until the next attempt at a frame while memory is short.
const RETRY: Duration = Duration::from_millis(500);
/// Least time between two frames of a window that others cover, if neither an event nor a command needs one.
const COVERED: Duration = Duration::from_secs(1);
/// Time until the next attempt at a frame while the screen releases no image.
const HIDDEN: Duration = Duration::from_millis(100);
/// egui needs no repaint if its repaint delay is at least this.
const NEVER: Duration = Duration::from_secs(3600);

/// A thumbnail on the way from the device.
struct PendingThumbnail {
    /// The version.
    number: u64,
    readback: Readback,
}

/// The screen. Fields drop in order, so renderers go before the swapchain and the surface.
pub(super) struct Screen {
    ui: UiRenderer,
    background: Background,
    gallery: Gallery,
    inspector: PixelReader,
    number: NumberReader,
    view: View,
    frames: Frames,
    layouts: Arc<SetLayouts>,
    swapchain: Option<Swapchain>,
    surface: Arc<Surface>,
    egui: egui::Context,
    pub(super) panels: Panels,
    input: egui_winit::State,
    /// Events that wait until egui has moved the focus, in their order.
    waiting: VecDeque<WindowEvent>,
    /// Textures of egui to upload, and those to free because no later frame uses them.
    textures: egui::TexturesDelta,
    /// Whether the swapchain no longer fits the window.
    stale: bool,
    first: bool,
    /// The last frame for which targets could be allocated. It is drawn again while memory is short.
    last: Option<BoundFrame>,
    /// The out-of-memory error of the current frame.
    shortage: Option<GpuError>,
    /// The picture of each frame slot's last frame, until its loops are known to have ended.
    unchecked: [Option<Arc<FrameState>>; FRAMES_IN_FLIGHT],
    /// The attempt number of each of these frames, see `frames::recording`.
    attempts: [Option<u64>; FRAMES_IN_FLIGHT],
    /// Whether each of these frames has also drawn another picture, in which a loop may not have ended.
    has_others: [bool; FRAMES_IN_FLIGHT],
    /// Whether another frame must follow at once.
    redraws: bool,
    /// Whether no thumbnails of versions are drawn, because memory is short.
    lacks_thumbnails: bool,
    /// The last frame in which a loop did not end.
    endless: Option<Arc<FrameState>>,
    /// How many more frames are drawn only to learn whether the loops have ended.
    checks: usize,
    /// The picture that the user compares with, while there is one.
    reference: Option<ReferenceView>,
    error_map: ErrorMap,
    memory: MemoryClock,
    /// The capture of the window that is in flight.
    window_shot: Option<WindowShot>,
    /// The targets of the selection's outline, while there is a selection.
    outline: Option<Outline>,
    texture: ShownTexture,
    /// Draws thumbnails of versions while some are missing.
    thumbnails: Option<View>,
    thumbnail: Option<PendingThumbnail>,
    /// The newest value under the mouse, and whether it is the reference's.
    pixel: Option<(PixelAt, bool)>,
    pub(super) mouse: Mouse,
    pub(super) camera: CameraController,
    /// The part of the window that shows the selected mode.
    pub(super) rect: PictureRect,
    /// The part that shows all modes of the grid.
    pub(super) whole: PictureRect,
    /// The modes of the grid beside the selected one.
    cells: Vec<Cell>,
    /// Their slugs and places in this frame.
    wanted: Vec<(String, PictureRect)>,
    /// The part of the picture that no handle between it and a panel covers, in points.
    free: egui::Rect,
    last_frame: Instant,
    /// When egui wants the next frame.
    due: Option<Instant>,
    /// Whether other windows cover this one.
    pub(super) is_covered: bool,
    /// The CPU times of the current frame.
    cpu: CpuTimes,
    /// CPU time of the driver to present it. A software device copies the pixels then, which is no work of the window's.
    present_ms: f64,
}

impl Screen {
    /// Whether a list or a menu of egui is open.
    pub(super) fn has_open_popup(&self) -> bool {
        egui::Popup::is_any_open(&self.egui)
    }

    pub(super) fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, window: &Arc<Window>) -> Result<Self, GpuError> {
        let handles = window.display_handle().and_then(|d| Ok((d.as_raw(), window.window_handle()?.as_raw())));
        let (display, handle) = handles.map_err(|e| GpuError::NoDevice(format!("the window has no handle: {e}")))?;
        let surface = Surface::new(gpu, display, handle)?;
        let egui = egui::Context::default();
        widgets::theme::apply(&egui);
        let input = egui_winit::State::new(
            egui.clone(),
            egui::ViewportId::ROOT,
            window,
            Some(window.scale_factor() as f32),
            None,
            Some(gpu.max_image_size() as usize),
        );
        Ok(Self {
            background: Background::new(gpu)?,
            gallery: Gallery::default(),
            inspector: PixelReader::default(),
            number: NumberReader::default(),
            layouts: layouts.clone(),
            ui: UiRenderer::new(gpu, Swapchain::FORMAT, FRAMES_IN_FLIGHT)?,
            view: View::new(gpu, layouts, FRAMES_IN_FLIGHT)?,
            frames: Frames::new(gpu, FRAMES_IN_FLIGHT)?,
            swapchain: None,
            surface,
            egui,
            panels: Panels::restored(),
            input,
            waiting: VecDeque::new(),
            textures: egui::TexturesDelta::default(),
            stale: true,
            first: true,
            last: None,
            shortage: None,
            unchecked: Default::default(),
            attempts: [None; FRAMES_IN_FLIGHT],
            has_others: [false; FRAMES_IN_FLIGHT],
            redraws: false,
            lacks_thumbnails: false,
            endless: None,
            checks: 0,
            reference: None,
            error_map: ErrorMap::default(),
            memory: MemoryClock::default(),
            window_shot: None,
            outline: None,
            texture: ShownTexture::default(),
            thumbnails: None,
            thumbnail: None,
            pixel: None,
            mouse: Mouse::default(),
            camera: CameraController::default(),
            rect: PictureRect::default(),
            whole: PictureRect::default(),
            cells: Vec::new(),
            wanted: Vec::new(),
            free: egui::Rect::NOTHING,
            last_frame: Instant::now(),
            due: None,
            is_covered: false,
            cpu: CpuTimes::default(),
            present_ms: 0.0,
        })
    }

    /// Registers the window with screen readers. The accessibility tree is built once one connects.
    pub(super) fn init_accessibility(&mut self, event_loop: &ActiveEventLoop, window: &Window, sender: &MessageSender) {
        self.input.init_accesskit(event_loop, window, sender.proxy());
    }

    pub(super) fn on_accessibility(&mut self, event: accesskit_winit::WindowEvent) {
        match event {
            accesskit_winit::WindowEvent::InitialTreeRequested => self.egui.enable_accesskit(),
            accesskit_winit::WindowEvent::ActionRequested(request) => self.input.on_accesskit_action_request(request),
            accesskit_winit::WindowEvent::AccessibilityDeactivated => self.egui.disable_accesskit(),
        }
    }

    pub(super) fn on_window_event(&mut self, window: &Window, event: &WindowEvent) -> egui_winit::EventResponse {
        self.input.on_window_event(window, event)
    }

    /// Whether an event belongs to the user interface. egui has `consumed` every event over the tiles, which are one panel to it,
    /// picture included. Over the picture, only areas above it and a drag that began elsewhere take the mouse.
    pub(super) fn is_taken(&self, event: &WindowEvent, consumed: bool) -> bool {
        if !matches!(event, WindowEvent::MouseInput { .. } | WindowEvent::MouseWheel { .. }) {
            return consumed;
        }
        let scale = self.egui.pixels_per_point();
        let at = egui::Pos2::new(self.mouse.at.x, self.mouse.at.y) / scale;
        let is_covered = self.egui.layer_id_at(at).is_some_and(|layer| layer.order != egui::Order::Background);
        is_covered || self.egui.egui_is_using_pointer() || !self.free.contains(at)
    }

    pub(super) fn resized(&mut self) {
        self.stale = true;
    }

    /// The camera of the last frame.
    pub(super) fn camera_view(&self) -> Option<CameraView> {
        self.last.as_ref().map(|frame| frame.state.camera)
    }

    /// Draws a frame. Returns the time until the next frame, or `None` to wait for an event. If memory runs out, the last frame
    /// stays, the viewer reports it, and the next frame tries again.
    pub(super) fn draw(
        &mut self,
        window: &Window,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<Option<Duration>, GpuError> {
        self.present_ms = 0.0;
        let clock = CpuClock::start();
        let drawn = self.draw_frame(window, state, engine);
        clock.into_iter().for_each(|clock| state.timing.used(clock.ms() - self.present_ms));
        let drawn = self.survive(drawn)?;
        if drawn.is_none() {
            self.view.forget();
            (self.reference, self.outline) = (None, None);
            self.texture.forget();
            self.cells.clear();
        }
        let shortage = self.shortage.take();
        let wait = drawn.flatten().or(shortage.is_some().then_some(RETRY));
        let wait = if set_shortage(state, engine, shortage.as_ref()) { Some(Duration::ZERO) } else { wait };
        Ok(match wait {
            // Nobody sees a covered window, but what ends with a frame must end.
            Some(wait) if self.is_covered && wait < COVERED && !has_unanswered(state, engine) => {
                Some(self.frame_after(COVERED))
            }
            wait => wait,
        })
    }

    /// Plans the next frame. Returns `wait`.
    fn frame_after(&mut self, wait: Duration) -> Duration {
        self.due = Some(Instant::now() + wait);
        wait
    }

    /// Draws a frame. Without memory for the targets of a new frame it draws the last one; any other lack of memory is an error.
    fn draw_frame(
        &mut self,
        window: &Window,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<Option<Duration>, GpuError> {
        if !self.resize(window, engine)? {
            state.waiting.fail("the window is minimized, so nothing is drawn");
            return Ok(None);
        }

        // The user interface, which determines the rectangle of the picture.
        let begin = Instant::now();
        let (primitives, pixels_per_point, delay) = self.run_ui(window, state, engine)?;

        // The picture.
        let moving = self.advance(state);
        watch_files(state, engine);
        if state.playback.take_restart() {
            self.view.restart_passes();
        }
        let frame = self.next_frame(state, engine)?;
        self.prepare_reference(state, engine, frame.as_ref())?;
        self.prepare_grid(state, engine)?;
        self.view.samples_range = state.workspace.shows_histogram && self.panels.visible;
        self.place_probe();
        let measures = self.measure_error(state, engine, frame.as_ref());
        let measures = self.survive(measures)?.unwrap_or(false);
        if let Some(frame) = &frame {
            self.take_screenshot(state, engine, frame)?;
            self.take_shots(state, engine, frame)?;
        }

        // Record both to a swapchain image. `begin` waits for a frame slot.
        let mut encoder = self.frames.begin()?;
        let slot = self.frames.current();
        self.check_loops(state, engine);
        let next = self.swapchain.as_mut().map_or(Ok(NextImage::Outdated), Swapchain::acquire)?;
        let NextImage::Acquired(acquired) = next else {
            self.frames.submit(encoder, Default::default())?;
            let outdated = matches!(next, NextImage::Outdated);
            self.stale |= outdated;
            return Ok(Some(if outdated { Duration::ZERO } else { self.frame_after(HIDDEN) }));
        };
        let output = Output { image: &acquired.image, before: Use::Acquired, at: self.rect.at };
        let record = Instant::now();
        let redraw = Self::redraw(state, engine, frame.as_ref());
        match &frame {
            Some(frame) => self.view.draw(&mut encoder, slot, frame, &output, redraw)?,
            None => View::clear(&mut encoder, &output),
        }
        self.draw_extras((&mut encoder, slot), state, engine, frame.as_ref(), &acquired.image)?;
        encoder.pass("ui", |encoder| self.draw_ui(encoder, &acquired.image, pixels_per_point, &primitives))?;
        self.record_window_shot(&mut encoder, slot, state, engine, &acquired.image)?;
        self.has_others[slot] |= self.reference.is_some() || !self.cells.is_empty();
        self.attempts[slot] = recording::record(state, engine, window);
        self.cpu.record_ms = record.elapsed().as_secs_f64() * 1e3;
        self.frames.submit(encoder, acquired.submission)?;
        self.note_frame(state, frame.as_ref());
        self.unchecked[slot] = frame.as_ref().map(|frame| frame.state.clone());
        if let Some(swapchain) = &mut self.swapchain {
            let clock = CpuClock::start();
            self.stale |= !swapchain.present(&acquired)?;
            self.present_ms = clock.map_or(0.0, CpuClock::ms);
        }

        answer(state, engine);
        let reported = self.finished(state, engine, frame.as_ref(), begin)?;
        let wait = self.draw_background(state, engine, pixels_per_point)?;
        // Both change with every frame.
        let (redraws, awaits_loops) = (std::mem::take(&mut self.redraws), self.awaits_loops());
        let changes = self.stale || moving || reported || measures || redraw == Redraw::Always;
        if redraws || awaits_loops || changes || self.has_more(state, engine, frame.as_ref()) {
            return Ok(Some(Duration::ZERO));
        }
        let delay = delay.filter(|delay| *delay < NEVER);
        self.due = delay.map(|delay| Instant::now() + delay);
        Ok(wait.into_iter().chain(delay).min())
    }

    /// Recreates the swapchain if it does not fit the window. Returns whether there is a swapchain.
    fn resize(&mut self, window: &Window, engine: &mut Engine) -> Result<bool, GpuError> {
        if self.stale || self.swapchain.is_none() {
            let (size, old) = (window.inner_size().into(), self.swapchain.take());
            self.swapchain = Swapchain::new(&self.surface, size, FRAMES_IN_FLIGHT, engine.gpu_is_fast(), old)?;
            self.stale = false;
        }
        Ok(self.swapchain.is_some())
    }

    /// Moves a flying camera and orbiting lights. Returns whether the camera moved.
    fn advance(&mut self, state: &mut State) -> bool {
        let seconds = self.last_frame.elapsed().as_secs_f32();
        self.last_frame = Instant::now();
        // Limit the step, so that lights do not jump after a pause.
        state.turn_lights(seconds.min(0.5));
        let Some((view, model)) = self.camera_view().zip(state.session.placed_model()) else { return false };
        self.camera.step(&mut state.session.settings.camera, &view, &model.bounds, seconds)
    }

    /// The frame to draw, with its targets allocated. If memory runs out, it is the last frame.
    fn next_frame(&mut self, state: &mut State, engine: &mut Engine) -> Result<Option<BoundFrame>, GpuError> {
        let prepared = next_frame(state, engine, self.rect.size, |frame| self.view.prepare(frame));
        if let Some(frame) = self.survive(prepared)? {
            self.last = frame;
        }
        Ok(self.last.clone())
    }

    /// Turns an out-of-memory error into `None`, and keeps it for the end of the frame.
    fn survive<T>(&mut self, result: Result<T, GpuError>) -> Result<Option<T>, GpuError> {
        match result {
            Err(error) if error.is_shortage() => {
                self.shortage = Some(error);
                Ok(None)
            }
            result => result.map(Some),
        }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.textures.clear();
    }
}
