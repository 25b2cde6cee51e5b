//! Draws between frames: thumbnails and values of pixels.

use std::time::{Duration, Instant};

use super::adaptive::{Step, draw_part, prepare_next};
use super::draw::Drawing;
use super::picture::missing_thumbnail;
use super::progress::awaits_edit;
use super::results::take_background;
use crate::app::actions::checks::update_checks;
use crate::app::actions::costs::update_costs;
use crate::app::actions::guests::update_guests;
use crate::app::actions::inspect::{begin_values, values_complete};
use crate::app::actions::trace::update_trace;
use crate::app::control::answer_found;
use crate::app::engine::Engine;
use crate::app::interface::Interface;
use crate::app::panels::timeline::THUMBNAIL;
use crate::app::screen::{BetweenRequest, Build, Inspected, InspectorRequest, POLL, RestingPicture};
use crate::app::state::State;
use crate::app::state::workspace::Sight;
use crate::events::{Event, emit};
use crate::frame::TargetFormat;
use crate::gpu::GpuError;
use crate::identity::Identity;

/// How long a software device may continue between frames. Showing a thumbnail takes it longer than drawing one.
const UNSEEN: Duration = Duration::from_millis(200);

/// The next step of the window.
pub(in crate::app) enum Next {
    /// Draws a frame.
    Frame,
    /// Waits, then asks again.
    After(Duration),
    /// Waits for an event.
    Event,
}

impl Drawing {
    /// Draws more between two frames, once the device has run the last submission, or reports that a frame is due.
    pub(in crate::app) fn go_on(
        &mut self,
        interface: Option<&mut Interface>,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<Next, GpuError> {
        let now = Instant::now();
        let left = |due: Option<Instant>| due.map(|due| due.saturating_duration_since(now));
        let is_finished = self.screen.between.is_finished();
        if left(self.due).is_some_and(|left| left.is_zero()) || (is_finished && engine.gpu_is_fast()) {
            return Ok(Next::Frame);
        }
        let mut wait = self.screen.between.time_to_poll();
        if is_finished && !awaits_edit(state, engine) {
            if left(self.shows_at()).is_some_and(|left| left.is_zero()) {
                return Ok(Next::Frame);
            }
            wait = match draw_part(state, engine, &mut self.screen)? {
                Step::Frame => return Ok(Next::Frame),
                Step::After(wait) => Some(wait),
                Step::Done => self.draw_background(interface.as_deref(), state, engine)?,
            };
            if std::mem::take(&mut state.checks.redraws) {
                interface.into_iter().for_each(Interface::outdate);
                return Ok(Next::Frame);
            }
        }
        Ok(wait.into_iter().chain(left(self.due)).min().map_or(Next::Event, Next::After))
    }

    /// When a frame is due that shows new results.
    fn shows_at(&self) -> Option<Instant> {
        self.screen.between.is_unseen().then(|| self.last_frame + UNSEEN)
    }

    /// Draws thumbnails and values of pixels that are out of date. Returns the time until they or results that no frame has shown need the
    /// next frame, or `None`.
    ///
    /// # Errors
    /// A device error other than out of memory.
    pub(super) fn draw_background(
        &mut self,
        interface: Option<&Interface>,
        state: &mut State,
        engine: &mut Engine,
    ) -> Result<Option<Duration>, GpuError> {
        let is_safe_mode = engine.recorder.is_safe_mode();
        let trace = update_trace(state, engine, is_safe_mode);
        let checks = update_checks(state, engine, is_safe_mode);
        let guests = update_guests(state, engine, is_safe_mode);
        let costs = update_costs(state, engine, is_safe_mode);
        answer_found(state);
        let preview = prepare_next(state, engine, &mut self.screen)?;
        self.screen.pointer = interface.map(|shown| &shown.mouse).filter(|mouse| mouse.over).map(|mouse| mouse.at);
        let drawn = self.draw_between(state, engine, is_safe_mode)?;
        Ok(trace.into_iter().chain(checks).chain(guests).chain(costs).chain(preview).chain(drawn).min())
    }

    fn draw_between(
        &mut self,
        state: &mut State,
        engine: &mut Engine,
        is_safe_mode: bool,
    ) -> Result<Option<Duration>, GpuError> {
        let screen = &mut self.screen;
        if !screen.between.is_finished() {
            return Ok(Some(POLL));
        }
        let is_unseen = take_background(state, engine, screen) || screen.between.is_unseen();
        screen.between.set_unseen(is_unseen);
        let pixels_per_point = self.shown.pixels_per_point;

        let version = if screen.between.versions.is_free(state.workspace.sight.timeline) && !awaits_edit(state, engine)
        {
            let size = THUMBNAIL * pixels_per_point;
            let missing = match missing_thumbnail(state, engine, (size.x.round() as u32, size.y.round() as u32)) {
                Err(error) if error.is_shortage() => None,
                missing => missing?,
            };
            if missing.is_none() {
                screen.between.versions.rest();
            }
            missing
        } else {
            None
        };
        let sees_nothing = Sight::default();
        let sight = if is_safe_mode { &sees_nothing } else { &state.workspace.sight };
        let inspection = &state.inspection;
        let inspector = (sight.inspector && !state.shader.is_single_file).then(|| InspectorRequest {
            pin: inspection.pin,
            mouse: screen.mouse_pixel(),
            size: screen.rect.size,
            follows: inspection.follows,
            reading: inspection.reading.as_ref().map(|reading| reading.picture),
        });
        let pointed = screen.pointed_number(state.shown()).filter(|_| !is_safe_mode);
        let is_seen = !sight.thumbnails.is_empty() || inspector.is_some() || pointed.is_some();
        let picture = if is_seen { resting_picture(state, engine) } else { None };
        let request = BetweenRequest {
            picture: picture.as_ref(),
            modes: state.session.shaders.as_ref().map_or(&[], |shaders| &shaders.modes),
            thumbnails: &sight.thumbnails,
            thumbnail_size: sight.thumbnail_size,
            pixels_per_point,
            inspector,
            pointed,
            version,
        };
        let drawn = screen.draw_between(&request, &mut engine.resources)?;

        if let Some(pipelines) = engine.resources.pipelines() {
            for build in drawn.builds {
                match build {
                    Build::Thumbnails(requests) => engine.threads.worker.build_thumbnails(pipelines, requests),
                    Build::Inspected(requests) => engine.threads.worker.build_inspected(pipelines, requests),
                }
            }
        }
        if drawn.thumbnails > 0 {
            emit(&state.events, &Event::Thumbnails { drawn: drawn.thumbnails });
        }
        let mut wait = drawn.wait;
        match drawn.inspected {
            Some(Inspected::Begun(picture, at, shown)) => begin_values(state, engine, picture, at, &shown),
            // The panel shows them with the next frame.
            Some(Inspected::All(picture)) if values_complete(state, engine, picture) => wait = Some(Duration::ZERO),
            _ => {}
        }
        // The frame that follows shows the results.
        let wait = self.screen.between.time_to_poll().or(wait);
        let shows = self.shows_at().map(|at| at.saturating_duration_since(Instant::now()));
        Ok(wait.into_iter().chain(shows).min())
    }
}

/// The picture that thumbnails and values show. `None` while the shaders or resources of the picture are incomplete.
fn resting_picture(state: &State, engine: &Engine) -> Option<RestingPicture> {
    let frame_state = state.shown()?;
    let shaders = state.session.shaders.clone()?;
    let is_current = frame_state.shaders.generation == shaders.generation;
    if !is_current || !shaders.is_complete() || awaits_edit(state, engine) {
        return None;
    }
    // A software device spends most of the time of multisampled thumbnails on small triangles. It draws twice the size instead, with one
    // sample per pixel, which egui halves.
    let samples = if engine.gpu_is_fast() { frame_state.pipelines.target.samples } else { 1 };
    Some(RestingPicture {
        settings: state.session.shared_settings(),
        shaders,
        plays: state.playback.runs() && state.session.scene()?.is_playing(),
        scene: state.session.scene()?,
        revisions: state.session.revisions,
        environment: Identity::of(engine.resources.environment()),
        target: TargetFormat { samples, ..frame_state.pipelines.target },
        features: state.session.features(),
    })
}
