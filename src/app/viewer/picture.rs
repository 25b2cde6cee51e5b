//! The picture to draw: the one that the settings describe once it is complete, until then the last complete one.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::Viewer;
use crate::app::drawn::last_complete::{LastComplete, target};
use crate::app::drawn::readout::title;
use crate::app::drawn::waits::Waits;
use crate::events::{Event, emit};
use crate::frame::{Clock, FrameState};
use crate::gpu::GpuError;
use crate::recovery::SessionState;
use crate::render::{BoundFrame, Missing};
use crate::settings::Settings;
use crate::shader::expression;
use crate::threads::worker::Snapshot;

impl Viewer {
    /// The frame to draw: the one that the settings describe if it is complete, otherwise the last good frame with the current
    /// camera. Requests the missing resources from the threads. `None` before the first shaders. `prepare` allocates the targets;
    /// a frame for which that fails does not count as shown.
    pub(in crate::app) fn next_frame(
        &mut self,
        size: (u32, u32),
        prepare: impl FnMut(&BoundFrame) -> Result<(), GpuError>,
    ) -> Result<Option<BoundFrame>, GpuError> {
        let preview = self.workspace.sight.preview.clone().filter(|_| !self.recorder.is_safe_mode());
        let Some(preview) = preview else {
            return self.frame_of_settings(size, prepare);
        };
        // Hover previews are transient: not recorded, and dropped when the pointer leaves.
        let selected = std::mem::replace(&mut self.session.settings.mode, preview);
        let frame = self.frame_of_settings(size, prepare);
        self.session.settings.mode = selected;
        // Commands that wait for the settings wait until the preview ends.
        self.shows_settings = false;
        frame
    }

    fn frame_of_settings(
        &mut self,
        size: (u32, u32),
        mut prepare: impl FnMut(&BoundFrame) -> Result<(), GpuError>,
    ) -> Result<Option<BoundFrame>, GpuError> {
        let is_animated = self.is_animated();
        let clock = self.playback.next(is_animated, self.reads_keys());
        let target = target(&self.gpu, &self.session.settings);
        let Some(state) = self.session.frame_state(clock, size, target) else { return Ok(None) };
        self.follow_settings(&state);
        (self.clock, self.is_complete, self.shows_settings) = (clock, false, false);
        // The first frame of a model does not wait for its environment.
        let is_first = self.shown.as_ref().is_none_or(|shown| shown.scene().is_none());
        let (frame, missing) = self.resources.bind(&state, is_first)?;
        let lacks_nothing = self.request_missing(missing, &state);
        let is_complete = lacks_nothing && state.shaders.is_complete();
        self.is_complete = is_complete;
        if let Some(frame) = frame {
            prepare(&frame)?;
            let generation = state.shaders.generation;
            // A reload is reported first.
            let settles = is_complete && state.scene.is_some() && self.first_frame.is_none();
            if settles && self.settled.replace(generation) != Some(generation) {
                emit(&self.events, &Event::Settled { generation });
                self.check_exercise();
            }
            let shown = LastComplete { settings: self.session.shared_settings(), frame: frame.clone() };
            let last = self.shown.replace(shown);
            self.keep_version(last);
            self.shows_settings = lacks_nothing;
            return Ok(Some(frame));
        }
        let interim = self.shown.as_ref().map(|shown| self.interim(shown, clock, size));
        interim.iter().try_for_each(prepare)?;
        Ok(interim)
    }

    /// The frame of another mode, drawn beside the selected one. Until its resources are there, it is `last` with the current
    /// camera.
    pub(in crate::app) fn frame_of_mode(
        &mut self,
        mode: &str,
        size: (u32, u32),
        last: Option<LastComplete>,
    ) -> Result<Option<LastComplete>, GpuError> {
        let selected = std::mem::replace(&mut self.session.settings.mode, mode.to_owned());
        let state = self.session.frame_state(self.clock, size, target(&self.gpu, &self.session.settings));
        let settings = self.session.shared_settings();
        self.session.settings.mode = selected;
        let Some(state) = state else { return Ok(last) };
        let (frame, missing) = self.resources.bind(&state, false)?;
        if let Some(frame) = frame {
            return Ok(Some(LastComplete { settings, frame }));
        }
        // The main picture comes first.
        if self.is_complete
            && !state.pipelines.needs_pending(&state.shaders)
            && missing.pipelines
            && let Some(set) = self.resources.pipelines()
        {
            self.threads.worker.build(set, &state.pipelines);
        }
        Ok(last.map(|last| {
            let frame = self.interim(&last, self.clock, size);
            LastComplete { frame, ..last }
        }))
    }

    /// Adds the shaders on screen to the versions if they are new, and keeps the last frame of the previous ones.
    fn keep_version(&mut self, last: Option<LastComplete>) {
        let generation = self.shown_generation();
        let has_model = self.shown.as_ref().is_some_and(|shown| shown.scene().is_some());
        if let Some(last) =
            last.filter(|last| last.scene().is_some() && last.frame.state.shaders.generation != generation)
        {
            let number = last.frame.state.shaders.generation;
            if self.versions.get(number).is_some_and(|version| !version.is_cut_short()) {
                self.generations.retire(last);
            }
        }
        if let Some(set) = self.resources.pipelines().filter(|set| has_model && !self.versions.has(&set.shaders)) {
            let edit = self.first_frame.as_ref().filter(|first| first.generation == generation);
            let reload = edit.map(|first| first.event.clone()).or_else(|| self.shader.last.clone()).unwrap_or_default();
            let again = self.edits.restored.as_ref().map(|restored| restored.number);
            self.versions.add(&set.shaders, reload, again.is_some() || self.edits.draft.as_ref().is_some(), again);
            self.generations.add(set, &self.versions);
        }
    }

    /// The last good frame at this size and time. While the model is the same, camera and orbiting lights follow the current
    /// settings, since they need no new resources. Everything else is unchanged.
    pub(super) fn interim(&self, shown: &LastComplete, clock: Clock, size: (u32, u32)) -> BoundFrame {
        let same_model = match (shown.scene(), self.session.model()) {
            (Some(scene), Some(model)) => Arc::ptr_eq(scene.loaded(), model),
            (scene, model) => scene.is_none() && model.is_none(),
        };
        let state = &shown.frame.state;
        shown.frame.with_state(match same_model {
            true => state.moved(&shown.settings.placed_as(&self.session.settings), clock, size),
            false => state.moved(&shown.settings, clock, size),
        })
    }

    /// The number and picture, at `size`, of a version that lacks a thumbnail while the panel that shows them is open.
    pub(in crate::app) fn missing_thumbnail(&self, size: (u32, u32)) -> Option<(u64, BoundFrame)> {
        let newest = self.shown_generation();
        // The thumbnail of the newest version waits until its lighting is complete.
        let shown = self.shown.as_ref().filter(|shown| self.is_settled() && shown.scene().is_some());
        // Do not use a watched expression as the version's thumbnail.
        let shown = shown.filter(|shown| shown.settings.mode != expression::MODE);
        let lacks = self.versions.without_thumbnail();
        if !self.workspace.sight.timeline {
            return None;
        }
        let mut with_picture = lacks.filter_map(|version| {
            let picture = if version.number == newest { shown } else { self.generations.picture(version.number) };
            Some((version.number, picture?))
        });
        let (number, picture) = with_picture.next()?;
        Some((number, self.interim(picture, self.clock, size)))
    }

    /// Tells the worker what the next reload is for.
    fn follow_settings(&mut self, state: &FrameState) {
        let (settings, scene) = (self.session.shared_settings(), state.scene.clone());
        let suns = self.session.revisions.suns_of(&settings);
        self.threads.worker.set_snapshot(Snapshot { settings, scene, target: state.pipelines.target, suns });
        self.watch_expression();
    }

    /// Requests the resources that a state lacks from the threads. Returns whether it is complete.
    fn request_missing(&mut self, missing: Missing, state: &FrameState) -> bool {
        let Some(set) = self.resources.pipelines() else { return false };
        let is_empty = missing.is_empty();
        let waits = Waits::of(&missing);
        let since = self.waits.filter(|(before, _)| Some(*before) == waits).map(|(_, since)| since);
        self.waits = waits.map(|waits| (waits, since.unwrap_or_else(Instant::now)));
        if missing.pipelines {
            self.threads.worker.build(set, &state.pipelines);
        }
        self.threads.baker.bake_tables(set, missing.tables, &self.resources);
        self.threads.baker.bake(set, missing.environment, &self.resources);
        self.threads.baker.read(missing.measured);
        self.threads.baker.build_path_tracing(missing.path_tracing);
        is_empty
    }

    /// What the picture waits for, and for how long.
    pub(in crate::app) fn waits_for(&self) -> Option<(Waits, Duration)> {
        self.waits.map(|(waits, since)| (waits, since.elapsed()))
    }

    /// The time of the last frame.
    pub(in crate::app) fn clock(&self) -> Clock {
        self.clock
    }

    /// The settings and the files of the picture on screen, from the current camera.
    pub(in crate::app) fn shown_session_state(&self) -> SessionState {
        let now = &self.session.settings;
        let shown = self.shown.as_ref().map_or(now, |shown| &*shown.settings);
        let settings = Settings { camera: now.camera.clone(), lights: now.lights.clone(), ..shown.clone() };
        SessionState { settings: Arc::new(settings), ..self.session_state() }
    }

    /// The state of the picture on screen.
    pub(in crate::app) fn shown(&self) -> Option<&FrameState> {
        self.shown.as_ref().map(|shown| &*shown.frame.state)
    }

    /// The title over the picture, see [`title`]. `frames` is the number of accumulated frames.
    pub(in crate::app) fn title(&self, frames: u32) -> Option<String> {
        let shown = self.shown()?;
        let request = &shown.pipelines;
        let paths = request.accumulates.then(|| frames.saturating_mul(request.paths_per_frame()));
        let preview = self.workspace.sight.preview.as_ref();
        let selected = preview.and_then(|slug| shown.shaders.modes.iter().find(|mode| mode.slug == *slug));
        let title = title(shown.mode()?, selected.or_else(|| self.session.mode()), paths)?;
        Some(request.limit().map_or_else(|| title.clone(), |limit| format!("{title}. Note: {limit}")))
    }
}
