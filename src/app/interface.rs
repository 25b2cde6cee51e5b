//! The user interface: egui with the panels, and the window's input for both. It knows neither the engine nor the screen.

mod freshness;
mod waiting;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_winit::accesskit_winit;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::Window;

use super::command::spec::Command;
use super::commands::Commands;
use super::context::Context;
use super::mouse::Mouse;
use super::panels::all::{self, Panels, PictureArea};
use super::readings::Readings;
use super::state::State;
use super::state::waits::Waits;
use super::state::workspace::{PanelRequest, Sight};
use super::widgets;
use crate::frame::Limits;
use crate::gpu::Gpu;
use crate::identity::Identity;
use crate::recovery::Geometry;
use crate::render::PixelAt;
use crate::scene::CameraController;
use crate::threads::Message;
use freshness::Freshness;

/// The user interface of the window.
pub(super) struct Interface {
    window: Arc<Window>,
    egui: egui::Context,
    pub(super) panels: Panels,
    input: egui_winit::State,
    /// Events that wait until egui has moved the focus, in their order.
    waiting: VecDeque<WindowEvent>,
    /// The part of the picture that no handle between it and a panel covers, in points.
    free: egui::Rect,
    pub(super) mouse: Mouse,
    pub(super) camera: CameraController,
    freshness: Freshness<Followed>,
}

/// Values that panels show at once although no event tells of them: settings that move by themselves, and what the device has read.
#[derive(PartialEq)]
pub(super) struct Followed {
    pub(super) settings: Identity,
    pub(super) pixel: Option<(PixelAt, bool)>,
    pub(super) limits: Option<Limits>,
    pub(super) is_settled: bool,
    pub(super) is_preview: bool,
    pub(super) waits: Option<Waits>,
}

/// The output of the panels in a frame. The default is that of a session without a window.
pub(super) struct Shown {
    pub(super) primitives: Vec<egui::ClippedPrimitive>,
    pub(super) pixels_per_point: f32,
    pub(super) textures: egui::TexturesDelta,
    pub(super) picture: Option<PictureArea>,
    pub(super) commands: Vec<Command>,
    pub(super) sight: Sight,
    /// Whether a value is being dragged or typed.
    pub(super) is_held: bool,
    /// Whether the gallery lacks its pictures.
    pub(super) wants_pictures: bool,
    /// The time until egui wants a repaint.
    pub(super) delay: Option<Duration>,
    /// Time of the panels and of making triangles of them, milliseconds.
    pub(super) ms: f64,
}

impl Default for Shown {
    fn default() -> Self {
        Self {
            primitives: Vec::new(),
            pixels_per_point: 1.0,
            textures: egui::TexturesDelta::default(),
            picture: None,
            commands: Vec::new(),
            sight: Sight::default(),
            is_held: false,
            wants_pictures: false,
            delay: None,
            ms: 0.0,
        }
    }
}

impl Interface {
    pub(super) fn new(gpu: &Gpu, window: &Arc<Window>) -> Self {
        let egui = egui::Context::default();
        widgets::theme::apply(&egui);
        let scale = Some(window.scale_factor() as f32);
        let largest = Some(gpu.max_image_size() as usize);
        let input = egui_winit::State::new(egui.clone(), egui::ViewportId::ROOT, &**window, scale, None, largest);
        Self {
            window: window.clone(),
            egui,
            panels: Panels::restored(),
            input,
            waiting: VecDeque::new(),
            free: egui::Rect::NOTHING,
            mouse: Mouse::default(),
            camera: CameraController::default(),
            freshness: Freshness::new(),
        }
    }

    /// Registers the window with screen readers. The accessibility tree is built once one connects.
    pub(super) fn init_accessibility(&mut self, event_loop: &ActiveEventLoop, proxy: EventLoopProxy<Message>) {
        self.input.init_accesskit(event_loop, &self.window, proxy);
    }

    pub(super) fn on_accessibility(&mut self, event: accesskit_winit::WindowEvent) {
        self.outdate();
        match event {
            accesskit_winit::WindowEvent::InitialTreeRequested => self.egui.enable_accesskit(),
            accesskit_winit::WindowEvent::ActionRequested(request) => self.input.on_accesskit_action_request(request),
            accesskit_winit::WindowEvent::AccessibilityDeactivated => self.egui.disable_accesskit(),
        }
    }

    pub(super) fn on_window_event(&mut self, event: &WindowEvent) -> egui_winit::EventResponse {
        if *event != WindowEvent::RedrawRequested {
            self.outdate();
        }
        self.input.on_window_event(&self.window, event)
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

    /// Whether a list or a menu of egui is open.
    pub(super) fn has_open_popup(&self) -> bool {
        egui::Popup::is_any_open(&self.egui)
    }

    pub(super) fn pixels_per_point(&self) -> f32 {
        self.egui.pixels_per_point()
    }

    /// Does what the rest of the window asks panels for.
    pub(super) fn carry_out(&mut self, requests: &[PanelRequest]) {
        requests.iter().for_each(|request| self.panels.carry_out(request));
    }

    /// Runs the panels with the next frame: something has happened that they may show.
    pub(super) fn outdate(&mut self) {
        self.freshness.outdate();
    }

    /// Whether what the panels have shown last still holds, so that they need not run.
    pub(super) fn is_fresh(&self, followed: &Followed) -> bool {
        self.freshness.is_fresh(followed, Instant::now())
    }

    /// The size of the window, pixels.
    pub(super) fn size(&self) -> (u32, u32) {
        self.window.inner_size().into()
    }

    /// The size and the place of the window.
    pub(super) fn geometry(&self) -> Geometry {
        Geometry { size: self.size(), at: self.window.outer_position().ok().map(Into::into) }
    }

    /// Runs the panels over the state.
    pub(super) fn run(&mut self, state: &State, readings: Readings<'_>, followed: Followed) -> Shown {
        let input = self.input.take_egui_input(&self.window);
        let begin = Instant::now();
        let (context, mut commands) = (Context::new(state, readings), Commands::new(&state.session.settings));
        let (mut picture, panels) = (None, &mut self.panels);
        let output = self.egui.run_ui(input, |ui| picture = Some(all::show(ui, &context, panels, &mut commands)));
        let pixels_per_point = output.pixels_per_point;
        let primitives = self.egui.tessellate(output.shapes, pixels_per_point);
        let ms = begin.elapsed().as_secs_f64() * 1e3;
        self.input.handle_platform_output(&self.window, output.platform_output);
        let (commands, sight) = commands.finish(&state.session.settings);
        self.free = picture.map_or(self.free, |area: PictureArea| area.free);
        let delay = output.viewport_output.get(&egui::ViewportId::ROOT).map(|viewport| viewport.repaint_delay);
        self.freshness.ran(followed, begin, delay);
        Shown {
            primitives,
            pixels_per_point,
            textures: output.textures_delta,
            picture,
            commands,
            sight,
            is_held: self.egui.input(|input| input.pointer.any_down()) || self.egui.egui_wants_keyboard_input(),
            wants_pictures: std::mem::take(&mut self.panels.open_gallery.wants_pictures),
            delay,
            ms,
        }
    }
}
