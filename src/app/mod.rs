//! The window, which runs beside an editor, and the same session without one for programs (`serve.rs`).
//!
//! `state` is what the window knows, `engine` makes frames and starts work, `interface` runs the panels, `screen` draws requests. Functions over
//! them, in `actions`, `frames` and `messages`, carry out what commands and threads ask for. Only this file owns all of them.

mod actions;
mod closing;
mod command;
mod commands;
mod comparison_labels;
mod context;
mod control;
mod dialog;
mod drops;
mod editor;
mod ending;
mod engine;
mod error;
mod frames;
mod gallery;
mod input;
mod interface;
mod key_codes;
mod layout;
mod messages;
mod mouse;
mod numbers;
mod options;
mod palette;
mod panels;
mod readings;
mod screen;
mod serve;
mod setting_text;
mod source_line;
mod start;
mod state;
mod widgets;

use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::Receiver;
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::raw_window_handle::HasDisplayHandle as _;
use winit::window::{Window, WindowAttributes, WindowId};

use crate::control::Asked;
use crate::events::{Event, emit};
use crate::gpu::{Gpu, GpuError, SetLayouts};
use crate::threads::WorkerMessage;
use crate::threads::{Message, MessageSender};
use actions::work::remember_session;
use closing::Closing;
use drops::{DropEvent, Drops};
use ending::Ending;
use engine::Engine;
use frames::background::Next;
use frames::draw::Drawing;
use frames::title::of_window;
use interface::Interface;
use messages::on_message;
use options::Early;
use screen::Screen;
use start::start;
use state::workspace::PanelRequest;
use state::{State, window_size};

pub use command::registry::{Described, described};
pub use error::AppError;
pub use options::{AppOptions, OtherPicture};
pub use serve::serve;
pub use state::last_session::session_to_restore;
pub use state::window_size::last_size;

/// Opens the window and runs until it is closed.
///
/// # Errors
/// No display, no device, or a device error.
pub fn run(mut options: AppOptions) -> Result<(), AppError> {
    // Its end writes the last events, so it outlives the window.
    let control = std::mem::take(&mut options.control);
    has_key_library()?;
    let event_loop = EventLoop::<Message>::with_user_event().build().map_err(no_display)?;
    let proxy = event_loop.create_proxy();
    let sender = MessageSender::Window(proxy.clone());
    if let Some(socket) = control.socket() {
        emit(control.clients(), &Event::Listening { socket: &socket.display().to_string() });
    }
    let early = Early::begin(&options, control.clients(), &sender);
    let asked = control.asked();
    let mut app = App { proxy, sender, asked, options: Some((options, early)), open: None, result: Ok(()) };
    event_loop.run_app(&mut app).map_err(no_display)?;
    app.result
}

/// Whether the library of keys on X11 is installed. Not every desktop has it, and winit panics without it.
#[cfg(target_os = "linux")]
fn has_key_library() -> Result<(), AppError> {
    let is_set = |variable: &str| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
    // winit's own order
    let is_x11 = !is_set("WAYLAND_DISPLAY") && !is_set("WAYLAND_SOCKET") && is_set("DISPLAY");
    if is_x11 && xkbcommon_dl::x11::xkbcommon_x11_option().is_none() {
        return Err(AppError::NoDisplay(
            "the library libxkbcommon-x11.so.0 is missing (on Debian and Ubuntu: apt install libxkbcommon-x11-0)"
                .into(),
        ));
    }
    Ok(())
}

#[cfg(not(target_os = "linux"))]
fn has_key_library() -> Result<(), AppError> {
    Ok(())
}

/// The window with the name of its desktop file, which gives it its icon.
#[cfg(target_os = "linux")]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    // X11 uses this name, too.
    winit::platform::wayland::WindowAttributesExtWayland::with_name(attributes, "specula", "specula")
}

#[cfg(not(target_os = "linux"))]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    attributes
}

/// winit's reason, without the position in its source code that winit puts before it.
fn no_display(error: winit::error::EventLoopError) -> AppError {
    let text = error.to_string();
    let reason =
        text.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": ")).map_or(&*text, |(_, reason)| reason);
    AppError::NoDisplay(reason.trim_end_matches([')', '.']).to_owned())
}

struct App {
    /// For screen readers.
    proxy: EventLoopProxy<Message>,
    sender: MessageSender,
    /// Commands from outside.
    asked: Receiver<Asked>,
    options: Option<(AppOptions, Early)>,
    open: Option<Open>,
    result: Result<(), AppError>,
}

/// The parts of an open window. The drawing must be dropped before the device and before the window.
struct Open {
    state: State,
    engine: Engine,
    drawing: Drawing,
    interface: Interface,
    gpu: Arc<Gpu>,
    window: Arc<Window>,
    /// The window's title.
    title: String,
    drops: Drops,
    closing: Closing,
}

impl App {
    fn open(&mut self, event_loop: &ActiveEventLoop, options: AppOptions, early: Early) -> Result<Open, AppError> {
        let mut attributes = Window::default_attributes()
            .with_title("Specula")
            .with_inner_size(PhysicalSize::new(options.size.0, options.size.1))
            .with_min_inner_size(PhysicalSize::new(320, 240))
            // A screen reader wants to know of a window before it is shown.
            .with_visible(false);
        if let Some((x, y)) = options.at {
            attributes = attributes.with_position(PhysicalPosition::new(x, y));
        }
        let window = event_loop.create_window(named(attributes)).map_err(|e| AppError::NoDisplay(e.to_string()))?;
        let window = Arc::new(window);
        let display = event_loop.display_handle().map_err(|e| AppError::NoDisplay(e.to_string()))?;
        let gpu = Gpu::new(&options.gpu(Some(display.as_raw())))?;
        let layouts = SetLayouts::new(&gpu)?;
        let screen = Screen::of_window(&gpu, &layouts, &window)?;
        let mut interface = Interface::new(&gpu, &window);
        interface.init_accessibility(event_loop, self.proxy.clone());
        window.set_visible(true);
        let (state, engine) = start(&gpu, &layouts, options, early, (&self.sender, true))?;
        // Before the first frame, which records what is typed.
        interface.carry_out(&[PanelRequest::RestoreTyped(engine.recorder.typed())]);
        let (drawing, title, drops) = (Drawing::new(screen), String::new(), Drops::default());
        let closing = Closing::default();
        Ok(Open { state, engine, drawing, interface, gpu, window, title, drops, closing })
    }

    /// Goes on with what is drawn between frames, until a frame is due.
    fn go_on(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let next = open.drawing.go_on(Some(&mut open.interface), &mut open.state, &mut open.engine);
        let record = open.engine.recorder.rest();
        match next {
            Ok(Next::Frame) => open.window.request_redraw(),
            Ok(Next::After(wait)) => event_loop.set_control_flow(within(record.into_iter().chain([wait]).min())),
            Ok(Next::Event) => event_loop.set_control_flow(within(record)),
            Err(error) => self.end(event_loop, Err(error.into())),
        }
    }

    fn end(&mut self, event_loop: &ActiveEventLoop, result: Result<(), AppError>) {
        if let Some(open) = self.open.take() {
            let Open { state, engine, drawing, interface, gpu, window, .. } = open;
            let ending = Ending { state, engine, drawing, gpu };
            if let Err(AppError::Gpu(GpuError::DeviceLost(_))) = &result {
                ending.lost();
                std::mem::forget((interface, window));
                self.result = result;
                return event_loop.exit();
            }
            remember_session(&ending.state);
            window_size::remember(window.inner_size().into());
            self.result = ending.end(result, || drop((interface, window)));
        } else if let Err(error) = result {
            self.result = Err(error);
        }
        event_loop.exit();
    }
}

/// Waits for events; at most this long if there is something to do then.
fn within(wait: Option<Duration>) -> ControlFlow {
    wait.map_or(ControlFlow::Wait, |wait| ControlFlow::WaitUntil(Instant::now() + wait.min(Duration::from_secs(3600))))
}

impl ApplicationHandler<Message> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Some((options, early)) = self.options.take() else { return };
        match self.open(event_loop, options, early) {
            Ok(open) => {
                self.sender.pass_on(self.asked.clone());
                open.window.request_redraw();
                self.open = Some(open);
            }
            Err(error) => self.end(event_loop, Err(error)),
        }
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            self.go_on(event_loop);
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let mut files = Vec::new();
        for event in open.drops.take_events() {
            match event {
                DropEvent::Dropped(dropped) => files = dropped,
                DropEvent::Repeated => drops::forget(&open.window),
            }
        }
        if files.is_empty() {
            return;
        }
        let adds = open.interface.mouse.modifiers.shift_key();
        let dropped = command::file::dropped(&open.state, files, adds);
        dropped.into_iter().for_each(|command| command::execute(&mut open.state, &mut open.engine, command));
        open.interface.outdate();
        open.window.request_redraw();
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, message: Message) {
        let Some(open) = &mut self.open else { return };
        match message {
            // A frame would wait for the thumbnail that the device may be drawing.
            Message::Worker(WorkerMessage::ThumbnailsBuilt) => return self.go_on(event_loop),
            Message::Accessibility(event) => open.interface.on_accessibility(event.window_event),
            Message::Pictures(pictures) => open.interface.panels.open_gallery.take(pictures),
            message => on_message(&mut open.state, &mut open.engine, message),
        }
        open.interface.outdate();
        open.window.request_redraw();
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let Some(event) = open.interface.wait(event) else { return open.window.request_redraw() };
        let is_frame = event == WindowEvent::RedrawRequested;
        self.handle(event_loop, event);
        while is_frame && let Some(event) = self.open.as_mut().and_then(|open| open.interface.next_waiting()) {
            self.handle(event_loop, event);
        }
    }
}

impl App {
    fn handle(&mut self, event_loop: &ActiveEventLoop, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let response = open.interface.on_window_event(&event);
        // egui requests a repaint in response to every redraw, so the window would never be idle.
        if response.repaint && !matches!(event, WindowEvent::RedrawRequested) {
            open.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => open.state.quits_by_hand = true,
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                open.drawing.screen.resized();
                open.window.request_redraw();
            }
            WindowEvent::Occluded(is_covered) => {
                open.drawing.is_covered = is_covered;
                open.window.request_redraw();
            }
            WindowEvent::HoveredFile(path) => open.drops.hover(path),
            WindowEvent::DroppedFile(path) => open.drops.release(path),
            WindowEvent::RedrawRequested => {
                let title = of_window(&open.state);
                if open.title != title {
                    open.window.set_title(&title);
                    open.title = title;
                }
                let drawn = open.drawing.draw(Some(&mut open.interface), &mut open.state, &mut open.engine);
                match drawn {
                    Ok(Some(Duration::ZERO)) => {
                        open.window.request_redraw();
                        event_loop.set_control_flow(ControlFlow::Wait);
                    }
                    Ok(again) => {
                        let record = open.engine.recorder.rest();
                        event_loop.set_control_flow(within(again.into_iter().chain(record).min()));
                    }
                    Err(error) => return self.end(event_loop, Err(error.into())),
                }
            }
            event => {
                let taken = open.interface.is_taken(&event, response.consumed);
                let parts = (&mut open.interface, &open.drawing.screen);
                if input::on_window_event(&mut open.state, &mut open.engine, &event, parts, taken) {
                    open.window.request_redraw();
                }
            }
        }
        if std::mem::take(&mut open.state.quits_by_hand) {
            let unsaved = open.interface.panels.unsaved();
            open.state.quit |= open.closing.may_close(&mut open.state, unsaved);
            open.interface.outdate();
            open.window.request_redraw();
        }
        if open.state.quit {
            self.end(event_loop, Ok(()));
        }
    }
}
