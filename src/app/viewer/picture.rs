//! The picture to draw: the one that the settings describe once it is complete, until then the last complete one.

use std::sync::Arc;

use super::{LastComplete, Viewer};
use crate::app::status::title;
use crate::events::{Event, emit};
use crate::frame::{Clock, FrameInputs, FrameState, TargetFormat};
use crate::gpu::{Gpu, GpuError};
use crate::render::{BoundFrame, PixelAt, View};
use crate::settings::Settings;
use crate::threads::worker::Snapshot;

impl Viewer {
    /// The frame to draw: the picture that the settings describe if it is complete, otherwise the last complete picture
    /// with the current camera. Requests the missing resources from the threads. `None` before the first shaders.
    /// `prepare` allocates the targets; a picture for which that fails does not count as shown.
    ///
    /// # Errors
    /// Out of memory.
    pub(in crate::app) fn next_frame(
        &mut self,
        size: (u32, u32),
        prepare: impl FnMut(&BoundFrame) -> Result<(), GpuError>,
    ) -> Result<Option<BoundFrame>, GpuError> {
        let Some(preview) = self.panels.gallery.preview().map(str::to_owned) else {
            return self.frame_of_settings(size, prepare);
        };
        // A preview is no setting: it is not recorded, and ends when the mouse leaves the mode.
        let selected = std::mem::replace(&mut self.session.settings.mode, preview);
        let frame = self.frame_of_settings(size, prepare);
        self.session.settings.mode = selected;
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
        let state = Arc::new(state);
        let is_complete = self.request_missing(&state) && state.shaders.pending.is_empty();
        // The first picture of a model does not wait for its environment.
        let is_first = self.shown.as_ref().is_none_or(|shown| shown.scene.is_none());
        if let Some(before) = self.before.as_ref().filter(|_| self.shows_before) {
            let frame = self.interim(before, clock, size);
            prepare(&frame)?;
            return Ok(Some(frame));
        }
        if let Some(frame) = self.resources.bind(&state, is_first)? {
            prepare(&frame)?;
            let generation = state.shaders.generation;
            if is_complete && state.scene.is_some() && self.settled.replace(generation) != Some(generation) {
                emit(self.events, &Event::Settled { generation });
            }
            let (settings, revisions) = (self.session.settings.clone(), self.session.revisions);
            let shown = LastComplete { settings, scene: state.scene.clone(), revisions, frame: frame.clone() };
            let last = self.shown.replace(shown);
            self.keep_before(last, generation);
            return Ok(Some(frame));
        }
        let interim = self.shown.as_ref().map(|shown| self.interim(shown, clock, size));
        interim.iter().try_for_each(prepare)?;
        Ok(interim)
    }

    /// Keeps the last picture if its shaders are not those of the new one.
    fn keep_before(&mut self, last: Option<LastComplete>, generation: u64) {
        let is_earlier =
            |last: &LastComplete| last.scene.is_some() && last.frame.state.shaders.generation != generation;
        let Some(last) = last.filter(is_earlier) else { return };
        self.before = Some(last);
        let edit = self.first_frame.as_ref().filter(|first| first.generation == generation);
        self.edited = edit.map(|first| first.event.changed.clone()).unwrap_or_default();
    }

    /// The last complete picture at this size and time. While the model is the same, camera and orbiting lights follow
    /// the current settings, since they need no new resources. All else is unchanged.
    fn interim(&self, shown: &LastComplete, clock: Clock, size: (u32, u32)) -> BoundFrame {
        let mut settings = shown.settings.clone();
        let same_model = match (&shown.scene, self.session.model()) {
            (Some(scene), Some(model)) => Arc::ptr_eq(scene.model(), model),
            (scene, model) => scene.is_none() && model.is_none(),
        };
        if same_model {
            settings.camera = self.session.settings.camera.clone();
            for (old, new) in settings.lights.orbit.iter_mut().zip(&self.session.settings.lights.orbit) {
                old.azimuth = new.azimuth;
            }
        }
        let state = &shown.frame.state;
        shown.frame.with_state(FrameState::new(&FrameInputs {
            settings: &settings,
            shaders: &state.shaders,
            scene: shown.scene.as_ref(),
            revisions: shown.revisions,
            clock,
            size,
            target: state.pipelines.target,
        }))
    }

    /// Requests the resources that a state lacks from the threads. Returns whether it lacks none.
    fn request_missing(&mut self, state: &FrameState) -> bool {
        let (settings, scene) = (self.session.settings.clone(), state.scene.clone());
        self.threads.worker.set_snapshot(Snapshot { settings, scene, target: state.pipelines.target });
        let Some(set) = self.resources.pipelines() else { return false };
        let missing = self.resources.missing(state);
        let is_empty = missing.is_empty();
        if missing.pipelines {
            self.threads.worker.build(set, &state.pipelines);
        }
        self.threads.baker.bake_tables(set, missing.tables, &self.resources);
        self.threads.baker.bake(set, missing.environment, &self.resources);
        self.threads.baker.read(missing.measured);
        self.threads.baker.trace(missing.traced);
        is_empty
    }

    /// The state of the picture on screen.
    pub(in crate::app) fn shown(&self) -> Option<&FrameState> {
        self.shown.as_ref().map(|shown| &*shown.frame.state)
    }

    /// The title over the picture: see [`title`]. `frames` is the number of frames in the mean of an accumulating mode.
    pub(in crate::app) fn title(&self, frames: u32) -> Option<String> {
        if let Some(before) = self.before.as_ref().filter(|_| self.shows_before) {
            let mode = before.frame.state.mode().map_or("", |mode| &mode.name);
            let files: Vec<&str> = self.edited.iter().map(|path| path.rsplit('/').next().unwrap_or(path)).collect();
            return Some(format!("{mode}, before the edit of {}", files.join(", ")));
        }
        let shown = self.shown()?;
        let request = &shown.pipelines;
        let paths = request.accumulates.then(|| frames.saturating_mul(request.paths_per_frame()));
        let preview = self.panels.gallery.preview();
        let selected = preview.and_then(|slug| shown.shaders.modes.iter().find(|mode| mode.slug == slug));
        title(shown.mode()?, selected.or_else(|| self.session.mode()), paths)
    }

    /// The text of a pixel's value; `None` where nothing covers the pixel.
    pub(in crate::app) fn value_text(&self, pixel: &PixelAt) -> Option<String> {
        let PixelAt { at: (x, y), value, .. } = pixel;
        let covered = value.value[3] > 0.0 || value.no_data || value.not_finite;
        let mode = self.shown().filter(|_| covered)?.mode()?;
        Some(format!("{}   at {x}, {y}", value.text(mode)))
    }
}

/// Half floats with the samples of the settings, or 1 if the device does not support them.
pub(super) fn target(gpu: &Gpu, settings: &Settings) -> TargetFormat {
    View::target_format(gpu, settings.view.msaa, false).unwrap_or(TargetFormat::half(1))
}
