//! Draws the window: runs the panels over the state, has the screen draw the frame that the state describes, and tells the state what came
//! of it. In a session without a window there are no panels, and all else is alike.

use std::time::{Duration, Instant};

use super::adaptive::{self, Step};
use super::grid::{arrange, prepare_grid};
use super::memory::MemoryClock;
use super::picture::next_frame;
use super::pictures::{take_screenshot, take_shots};
use super::progress::{awaits_edit, is_settled, moves, set_shortage};
use super::readings::readings;
use super::recording::record;
use super::reference::reference;
use super::request::frame_request;
use super::results::{finished, take_background, take_ended, take_measurement, take_results, take_times, timed};
use super::scan::{plan_scan, take_scan};
use super::stages::update_stages;
use super::toy_pixel::{take_toy_pixel, toy_pixel};
use crate::app::actions::select::selected_instances;
use crate::app::actions::sessions::update_offer;
use crate::app::actions::watch::watch_files;
use crate::app::command::execute;
use crate::app::control::{answer, has_unanswered, wants_window};
use crate::app::engine::Engine;
use crate::app::interface::{Followed, Interface, Shown};
use crate::app::screen::{Beginning, Screen};
use crate::app::state::State;
use crate::app::state::adaptive::plan::Plan;
use crate::app::state::timing::CpuTimes;
use crate::cpu_clock::CpuClock;
use crate::gpu::GpuError;
use crate::identity::Identity;
use crate::recovery::Geometry;
use crate::render::{BoundFrame, Redraw};
use crate::scene::built_in_pictures;
use crate::threads::Message;

/// Time until the next attempt at a frame while memory is short.
const RETRY: Duration = Duration::from_millis(500);
/// Least time between two frames of a window that others cover, if neither an event nor a command needs one.
const COVERED: Duration = Duration::from_secs(1);
/// Time until the next attempt at a frame while the screen releases no image.
const HIDDEN: Duration = Duration::from_millis(100);
/// egui needs no repaint if its repaint delay is at least this.
const NEVER: Duration = Duration::from_secs(3600);

/// The parts of a window that draw, and the times between its frames. Its functions take the user interface; there is none in a session
/// without a window.
pub(in crate::app) struct Drawing {
    pub(in crate::app) screen: Screen,
    /// The output of the panels when they last ran.
    pub(super) shown: Shown,
    /// Whether other windows cover this one.
    pub(in crate::app) is_covered: bool,
    pub(super) last_frame: Instant,
    /// When egui wants the next frame.
    pub(super) due: Option<Instant>,
    is_first: bool,
    memory: MemoryClock,
    /// CPU time of the driver to present the current frame, milliseconds.
    present_ms: f64,
}

/// A frame that has been submitted.
struct Submitted {
    plan: Plan,
    /// When it was begun.
    begin: Instant,
    /// Whether a difference is being measured.
    measures: bool,
    /// Whether another frame must follow.
    changes: bool,
    /// Whether the panels have run.
    has_run: bool,
    /// The time until the picture is to be searched for NaN.
    scan: Option<Duration>,
}

impl Drawing {
    pub(in crate::app) fn new(screen: Screen) -> Self {
        Self {
            screen,
            shown: Shown::default(),
            is_covered: false,
            last_frame: Instant::now(),
            due: None,
            is_first: true,
            memory: MemoryClock::default(),
            present_ms: 0.0,
        }
    }

    /// Draws a frame. Returns the time until the next frame, or `None` to wait for an event. If memory runs out, the last frame
    /// stays, the window reports it, and the next frame tries again.
    pub(in crate::app) fn draw(
        &mut self,
        mut interface: Option<&mut Interface>,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<Option<Duration>, GpuError> {
        self.present_ms = 0.0;
        let clock = CpuClock::start();
        let drawn = self.draw_frame(interface.as_deref_mut(), state, engine);
        clock.into_iter().for_each(|clock| state.timing.used(clock.ms() - self.present_ms));
        let drawn = self.screen.survive(drawn)?;
        if drawn.is_none() {
            self.screen.forget_frame();
        }
        let shortage = self.screen.take_shortage();
        let wait = drawn.flatten().or(shortage.is_some().then_some(RETRY));
        let is_told = set_shortage(state, engine, shortage.as_ref());
        if is_told {
            outdate(interface);
        }
        let wait = if is_told { Some(Duration::ZERO) } else { wait };
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
        mut interface: Option<&mut Interface>,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<Option<Duration>, GpuError> {
        let size = interface.as_ref().map(|interface| interface.size()).or(self.screen.extent());
        if !self.screen.resize(size.unwrap_or_default())? {
            state.waiting.fail("the window is minimized, so nothing is drawn");
            return Ok(None);
        }

        // The user interface, which determines the rectangle of the picture.
        let begin = Instant::now();
        let has_run = self.run_interface(interface.as_deref_mut(), state, engine)?;
        // Before the device can be lost with this frame.
        if let Some(interface) = interface.as_ref().filter(|_| has_run) {
            engine.recorder.record_typed(interface.panels.unsaved());
        }
        let textures = std::mem::take(&mut self.shown.textures);
        let shown = &self.shown;
        let cells = arrange(state, &mut self.screen, shown.picture, shown.pixels_per_point);
        self.screen.take_textures(textures)?;

        // The picture.
        let moving = self.advance(interface.as_deref_mut(), state);
        watch_files(state, engine);
        let screen = &mut self.screen;
        if state.playback.take_restart() {
            screen.view.restart_passes();
        }
        let before = screen.last_frame().cloned();
        let prepared = next_frame(state, engine, screen.rect.size, |frame| screen.view.prepare(frame));
        let frame = screen.accept(prepared)?;
        let frame = frame.as_ref();
        if let Some(live) = frame {
            screen.prepare_reference(reference(state, engine, live))?;
        }
        prepare_grid(state, engine, screen, &cells)?;
        let plan = adaptive::plan(state, engine, screen, (frame, before.as_ref()), self.shown.is_held)?;
        let are_visible = interface.as_ref().is_some_and(|interface| interface.panels.visible);
        screen.view.samples_range = state.workspace.shows_histogram && are_visible;
        screen.place_probe();
        screen.view.probe_passes = toy_pixel(state, screen.mouse_pixel());
        let scan = plan_scan(state, engine, &mut screen.view);
        let measurement = screen.measure_error(state.compare.is_on() && !state.compare.is_held, frame)?;
        take_ended(state, engine, screen);
        let measures = take_measurement(state, measurement);
        if let Some(frame) = frame {
            take_screenshot(state, engine, screen, frame)?;
            take_shots(state, engine, screen, frame)?;
        }

        // Record both to an image of the window.
        let beginning = screen.begin();
        take_ended(state, engine, screen);
        let mut begun = match beginning? {
            Beginning::Begun(begun) => begun,
            Beginning::Outdated => return Ok(Some(Duration::ZERO)),
            Beginning::Hidden => return Ok(Some(self.frame_after(HIDDEN))),
        };
        let record_begin = Instant::now();
        let copies_window = wants_window(state, engine) && !screen.copies_window();
        let shown = &self.shown;
        let drawn = adaptive::Drawing::of(screen, frame, plan);
        let request = frame_request(state, engine, (frame, plan), shown, copies_window);
        let redraw = request.redraw;
        let recorded = screen.record(&mut begun, &request)?;
        if recorded.grid_failed {
            state.grid.end();
        }
        if copies_window {
            state.waiting.window_copied(recorded.copy_error);
        }
        let unseen = || Geometry { size: screen.extent().unwrap_or_default(), at: None };
        let attempt = record(state, engine, || interface.as_ref().map_or_else(unseen, |shown| shown.geometry()));
        let cpu = CpuTimes {
            ui_ms: if has_run { shown.ms } else { 0.0 },
            record_ms: record_begin.elapsed().as_secs_f64() * 1e3,
        };
        self.present_ms = screen.submit(begun, frame, attempt)?;
        adaptive::submitted(state, screen, frame, &drawn);
        timed(state, screen, drawn.timed(screen, frame), cpu);

        let changes = moving || measures || redraw == Redraw::Always;
        let done = Submitted { plan, begin, measures, changes, has_run, scan };
        self.after_frame(interface, state, engine, frame, &done)
    }

    /// Takes what a submitted frame has done, and draws what comes between frames. Returns the time until the next frame.
    fn after_frame(
        &mut self,
        interface: Option<&mut Interface>,
        state: &mut State,
        engine: &mut Engine,
        frame: Option<&BoundFrame>,
        done: &Submitted,
    ) -> Result<Option<Duration>, GpuError> {
        let screen = &mut self.screen;
        answer(state, engine);
        let reported = finished(state, engine, screen, frame, &mut self.is_first, done.begin)?;
        let wait = match adaptive::draw_part(state, engine, screen)? {
            Step::Frame => Some(Duration::ZERO),
            Step::After(wait) => Some(wait),
            Step::Done => self.draw_background(interface.as_deref(), state, engine)?,
        };
        let follows = self.screen.has_more(frame, done.plan) || reported || done.changes;
        if follows || has_unanswered(state, engine) || moves(state) {
            if reported || done.measures {
                outdate(interface);
            }
            return Ok(Some(Duration::ZERO));
        }
        // The last frame before the window rests shows the panels as they are.
        if std::mem::take(&mut state.checks.redraws) || !done.has_run {
            outdate(interface);
            return Ok(Some(Duration::ZERO));
        }
        let delay = self.shown.delay.filter(|delay| *delay < NEVER);
        let delay = delay.into_iter().chain(done.scan).min();
        self.due = delay.map(|delay| Instant::now() + delay);
        Ok(wait.into_iter().chain(delay).min())
    }

    /// Takes the results of finished frames, runs the panels, and carries out what they ask for. Returns whether they have run: if nothing
    /// has happened that they show, the frame shows them as they are. Where there are none, they count as run.
    fn run_interface(
        &mut self,
        interface: Option<&mut Interface>,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<bool, GpuError> {
        let Some(interface) = interface else {
            let screen = &mut self.screen;
            screen.read_finished();
            take_background(state, engine, screen);
            take_scan(state, screen);
            take_results(state, engine, screen);
            take_times(state, screen, engine.gpu_is_fast());
            drop(state.workspace.take_requests());
            state.history.record(&state.session.shared_settings(), false);
            return Ok(true);
        };
        let Self { screen, memory, .. } = self;
        screen.pointer = interface.mouse.over.then_some(interface.mouse.at);
        screen.read_finished();
        if take_background(state, engine, screen) || screen.between.is_unseen() {
            interface.outdate();
        }
        if take_scan(state, screen) || take_toy_pixel(state, screen) {
            interface.outdate();
        }
        screen.between.set_unseen(false);
        take_results(state, engine, screen);
        take_times(state, screen, engine.gpu_is_fast());
        adaptive::take_times(state, screen);
        let followed = Followed {
            settings: Identity::of(&state.session.shared_settings()),
            pixel: screen.pixel(),
            limits: screen.view.limits(),
            is_settled: is_settled(state, engine),
            is_preview: state.previews.is_preview(),
            waits: state.picture.waits_for().map(|(waits, _)| waits),
        };
        if state.waiting.is_empty() && !awaits_edit(state, engine) && interface.is_fresh(&followed) {
            return Ok(false);
        }
        screen.fit_thumbnails(state.workspace.sight.thumbnail_size, interface.pixels_per_point())?;
        if let Some(request) = &state.workspace.sight.texture
            && let Some(tools) = engine.tools()
        {
            screen.prepare_texture(&tools, request.size)?;
        }
        update_stages(state, engine);
        update_offer(state);
        selected_instances(state);
        interface.carry_out(&state.workspace.take_requests());
        self.shown = interface.run(state, readings(state, engine, screen, memory), followed);
        let shown = &mut self.shown;
        if shown.wants_pictures {
            engine.threads.wait(|| Some(Message::Pictures(Box::new(built_in_pictures()))));
        }
        state.workspace.sight = std::mem::take(&mut shown.sight);
        shown.commands.drain(..).for_each(|command| execute(state, engine, command));
        state.grid.follow(&state.session.settings.mode);
        // A drag, or a number that is being typed, is one step.
        state.history.record(&state.session.shared_settings(), shown.is_held);
        Ok(true)
    }

    /// Moves a flying camera and orbiting lights, while somebody sees them. Returns whether the camera moved.
    fn advance(&mut self, interface: Option<&mut Interface>, state: &mut State) -> bool {
        let seconds = self.last_frame.elapsed().as_secs_f32();
        self.last_frame = Instant::now();
        let Some(interface) = interface else { return false };
        // Limit the step, so that lights do not jump after a pause.
        state.turn_lights(seconds.min(0.5));
        let Some((view, model)) = self.screen.camera_now(&state.session).zip(state.session.placed_model()) else {
            return false;
        };
        interface.camera.step(&mut state.session.settings.camera, &view, &model.bounds, seconds)
    }
}

/// Has the panels run with the next frame.
fn outdate(interface: Option<&mut Interface>) {
    interface.into_iter().for_each(Interface::outdate);
}
