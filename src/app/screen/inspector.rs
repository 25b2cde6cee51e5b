//! The values of the inspected pixel on the device: which are out of date, when they are drawn, and when they are read.
//!
//! Like thumbnails they wait for everything else. They are drawn when the picture has come to rest, a few sets of modes after each frame, with
//! pipelines that the worker builds when it has nothing else to do. A failure leaves the values before.

use std::collections::HashSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::background::Background;
use super::sets::{BoundSets, Shown, shown, time_to_rest};
use crate::app::actions::inspect::{begin_values, take_texels, take_values, values_complete};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::frame::{TargetFormat, mode_sets};
use crate::gpu::{GpuError, SetLayouts};
use crate::render::{PixelModes, TexelReadback, Thumbnails, texel_places};
use crate::shader::{Mode, ShaderSet};

/// Draws of sets of modes after one frame. On a GPU each takes less than a millisecond.
const DRAWS_PER_FRAME: usize = 3;

/// A draw that may not have finished.
struct Pending {
    /// Its place among the draws of its submission.
    place: usize,
    slugs: Vec<String>,
    /// The picture and pixel that it belongs to.
    picture: u64,
}

/// Reads the inspected pixel.
#[derive(Default)]
pub(super) struct PixelReader {
    renderer: Option<PixelModes>,
    /// The picture that the values belong to, and the pixel.
    shown: Option<(Shown, [u32; 2])>,
    /// Counts the changes of `shown`.
    picture: u64,
    since: Option<Instant>,
    /// The modes that were drawn since the last change.
    drawn: HashSet<String>,
    /// The sets, by the slugs of their modes, whose pipelines the worker was asked for since the last change.
    asked: HashSet<String>,
    pending: Vec<Pending>,
    /// The texels that are copied with the first draw of a picture, and the picture.
    texels: Option<(u64, TexelReadback)>,
    /// The pixel under the mouse when it was last over the picture.
    under_mouse: Option<[u32; 2]>,
    /// Whether drawing is suspended until something changes: memory is short, or a loop did not end.
    stopped: bool,
}

impl PixelReader {
    /// Draws nothing until something changes.
    pub(super) fn stop(&mut self) {
        self.stopped = true;
    }

    /// Forgets draws whose commands were not submitted.
    pub(super) fn forget(&mut self) {
        self.pending.clear();
        self.texels = None;
        self.drawn.clear();
        self.stopped = true;
        if let Some(renderer) = &mut self.renderer {
            renderer.forget();
        }
    }

    /// Takes the values of finished draws.
    pub(super) fn take(&mut self, background: &Background, state: &mut State) {
        let Some(renderer) = self.renderer.as_ref().filter(|_| background.is_finished()) else { return };
        if let Some((picture, readback)) = self.texels.take() {
            take_texels(state, picture, readback.finish());
        }
        for Pending { place, slugs, picture } in std::mem::take(&mut self.pending) {
            if picture == self.picture {
                take_values(state, picture, slugs.into_iter().zip(renderer.values(place)));
            }
        }
    }

    /// Draws outdated modes, if the picture is idle. Returns the time until the next frame is needed; `None` if all are drawn and
    /// read. A lack of memory is not an error.
    pub(super) fn draw(
        &mut self,
        background: &mut Background,
        state: &mut State,
        engine: &mut Engine,
        layouts: &Arc<SetLayouts>,
        (size, mouse): ((u32, u32), Option<(u32, u32)>),
    ) -> Result<Option<Duration>, GpuError> {
        let inspector = &state.inspection;
        if !state.workspace.sight.inspector || engine.recorder.is_safe_mode() {
            // The device memory is free for other things while the panel is closed.
            (self.renderer, self.shown) = (None, None);
            return Ok(None);
        }
        if let Some((x, y)) = mouse {
            self.under_mouse = Some([x, y]);
        }
        let at = inspector.pin.or(self.under_mouse.filter(|_| inspector.follows));
        let Some(at) = at.filter(|at| at[0] < size.0 && at[1] < size.1) else {
            self.shown = None;
            return Ok(None);
        };
        let is_dropped = inspector.reading.is_none() && !self.drawn.is_empty();
        let Some((shaders, mut now)) = shown(state, engine, size) else { return Ok(None) };
        (now.target, now.gives_numbers) = (TargetFormat::full(1), true);
        let now = (now, at);
        if is_dropped || self.shown.as_ref() != Some(&now) {
            if self.shown.as_ref().is_none_or(|(before, _)| *before != now.0) {
                self.asked.clear();
            }
            (self.shown, self.since, self.stopped) = (Some(now), Some(Instant::now()), false);
            self.drawn.clear();
            self.picture += 1;
        }
        if self.stopped {
            return Ok(None);
        }
        let features = state.session.features();
        let with_data = shaders.modes.iter().filter(|mode| mode.has_data(features));
        let sets = mode_sets(with_data, Thumbnails::most_at_once(&engine.gpu));
        let is_stale = |set: &Vec<&Mode>| set.iter().any(|mode| !self.drawn.contains(&mode.slug));
        let stale: Vec<Vec<&Mode>> = sets.into_iter().filter(is_stale).collect();
        if stale.is_empty() {
            // The panel shows them with the next frame.
            return Ok(values_complete(state, engine, self.picture).then_some(Duration::ZERO));
        }
        if let Some(left) = time_to_rest(engine, self.since) {
            return Ok(Some(left));
        }
        match self.draw_sets(background, state, engine, layouts, &shaders, stale) {
            Err(error) if error.is_shortage() => {
                (self.renderer, self.stopped) = (None, true);
                self.pending.clear();
                Ok(Some(Duration::ZERO))
            }
            drawn => drawn,
        }
    }

    fn draw_sets(
        &mut self,
        background: &mut Background,
        state: &mut State,
        engine: &mut Engine,
        layouts: &Arc<SetLayouts>,
        shaders: &Arc<ShaderSet>,
        stale: Vec<Vec<&Mode>>,
    ) -> Result<Option<Duration>, GpuError> {
        let Some((shown, at)) = &self.shown else { return Ok(None) };
        let BoundSets { ready, missing, is_new } = shown.bind(engine, shaders, stale, &mut self.asked)?;
        if let Some(pipelines) = engine.resources.pipelines().filter(|_| is_new) {
            engine.threads.worker.build_inspected(pipelines, missing);
        }
        if ready.is_empty() {
            return Ok(None);
        }
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(PixelModes::new(&engine.gpu, layouts, DRAWS_PER_FRAME)?),
        };
        let draws = if engine.gpu_is_fast() { DRAWS_PER_FRAME } else { 1 };
        let encoder = background.encoder()?;
        for (place, (set, frame)) in ready.iter().take(draws).enumerate() {
            if begin_values(state, engine, self.picture, *at, &frame.state) {
                let places = texel_places(&frame.state, (at[0], at[1]));
                let readback = TexelReadback::record(&engine.gpu, encoder, &engine.resources, places)?;
                self.texels = Some((self.picture, readback));
            }
            renderer.draw(encoder, place, frame, (at[0], at[1]))?;
            let slugs: Vec<String> = set.iter().map(|mode| mode.slug.clone()).collect();
            self.drawn.extend(slugs.iter().cloned());
            self.pending.push(Pending { place, slugs, picture: self.picture });
        }
        Ok(Some(Duration::ZERO))
    }
}
