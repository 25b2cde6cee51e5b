//! The thumbnails of the gallery on the device: which are out of date, when they are drawn, and where.
//!
//! Thumbnails wait for everything else. They are drawn when the picture has come to rest, a few at a time, those in sight alone, with
//! pipelines that the worker builds when it has nothing else to do. A failure drops them without a word.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::background::Background;
use super::between_request::{BetweenRequest, Build, Drawn};
use super::sets::{BoundSets, RestingPicture, Shown, time_to_rest};
use crate::app::gallery::Thumbnails as ShownThumbnails;
use crate::frame::mode_sets;
use crate::gpu::{Gpu, GpuError, SetLayouts, UiImage, UiRenderer, Use};
use crate::render::{Resources, Thumbnails};
use crate::shader::Mode;

/// Draws of thumbnails, each of several modes, after one frame. On a GPU each takes less than a millisecond.
const DRAWS_PER_FRAME: usize = 3;
/// Thumbnails in a row of the texture.
const COLUMNS: u32 = 16;

/// The thumbnails of the gallery.
#[derive(Default)]
pub(super) struct Gallery {
    renderer: Option<Thumbnails>,
    /// The thumbnails as the panels show them.
    pub(super) thumbnails: ShownThumbnails,
    /// The texture, and the size of its thumbnails in pixels.
    atlas: Option<(UiImage, (u32, u32))>,
    /// Whether the texture has been drawn to.
    is_drawn: bool,
    /// The place of each mode in the texture.
    cells: HashMap<String, u32>,
    /// The modes whose thumbnails show `shown`.
    fresh: HashSet<String>,
    shown: Option<Shown>,
    since: Option<Instant>,
    /// The sets, by the slugs of their modes, whose pipelines the worker was asked for since the last change.
    asked: HashSet<String>,
    /// How many were drawn since the gallery was last up to date.
    drawn: usize,
    /// Whether drawing is suspended until something changes, because memory is short.
    failed: bool,
}

impl Gallery {
    /// Whether the texture must be dropped: its thumbnails have another size, or memory is short.
    pub(super) fn is_misfit(&self, gpu: &Gpu, points: [f32; 2], pixels_per_point: f32) -> bool {
        let size = pixels(gpu, points, pixels_per_point);
        let is_full = |image: &UiImage| {
            let (width, height) = (image.image().desc().width, image.image().desc().height);
            self.cells.len() as u32 > (width / size.0) * (height / size.1)
        };
        self.atlas.as_ref().is_some_and(|(image, drawn)| self.failed || *drawn != size || is_full(image))
    }

    /// Drops the texture. The caller has waited for the frames that use it.
    pub(super) fn drop_texture(&mut self, ui: &mut UiRenderer) {
        if let Some((image, _)) = self.atlas.take() {
            ui.remove_image(image);
        }
        (self.thumbnails, self.renderer) = (ShownThumbnails::default(), None);
        self.cells.clear();
        self.fresh.clear();
    }

    /// Draws no thumbnails until something changes.
    pub(super) fn stop(&mut self) {
        self.failed = true;
    }

    /// Draws visible thumbnails that are outdated, if the picture is idle. Returns the time until the next frame is needed;
    /// `None` if all are done. A lack of memory is not an error.
    pub(super) fn draw(
        &mut self,
        background: &mut Background,
        request: &BetweenRequest<'_>,
        resources: &mut Resources,
        (ui, layouts): (&mut UiRenderer, &Arc<SetLayouts>),
        drawn: &mut Drawn,
    ) -> Result<Option<Duration>, GpuError> {
        self.collect(request.modes);
        let Some(picture) = request.picture.filter(|_| !request.thumbnails.is_empty()) else { return Ok(None) };
        let gpu = background.gpu().clone();
        let shown = picture.at_size(pixels(&gpu, request.thumbnail_size, request.pixels_per_point));
        if self.shown.as_ref() != Some(&shown) {
            self.fresh.clear();
            self.asked.clear();
            (self.shown, self.since, self.failed) = (Some(shown), Some(Instant::now()), false);
        }
        if self.failed {
            return Ok(None);
        }
        let is_stale = |mode: &&Mode| request.thumbnails.contains(&mode.slug) && !self.fresh.contains(&mode.slug);
        // All modes are split into sets, not only the visible ones, so that scrolling needs no other pipelines.
        let is_seen = |mode: &&Mode| mode.has_data(picture.features) || request.thumbnails.contains(&mode.slug);
        let sets = mode_sets(picture.shaders.modes.iter().filter(is_seen), Thumbnails::most_at_once(&gpu));
        let stale: Vec<Vec<&Mode>> = sets.into_iter().filter(|set| set.iter().any(is_stale)).collect();
        if stale.is_empty() {
            drawn.thumbnails = std::mem::take(&mut self.drawn);
            return Ok(None);
        }
        if let Some(left) = time_to_rest(background.is_fast(), self.since) {
            return Ok(Some(left));
        }
        match self.draw_sets(background, resources, (ui, layouts), picture, stale, drawn) {
            Err(error) if error.is_shortage() => {
                self.failed = true;
                Ok(Some(Duration::ZERO))
            }
            result => result,
        }
    }

    /// Reads the samples of the last thumbnails. Those whose range they change are drawn again.
    fn collect(&mut self, modes: &[Mode]) {
        let Some(renderer) = &mut self.renderer else { return };
        let changed: Vec<u32> = (0..DRAWS_PER_FRAME).flat_map(|index| renderer.collect(index)).collect();
        for mode in modes.iter().filter(|mode| changed.contains(&mode.id)) {
            self.fresh.remove(&mode.slug);
        }
    }

    fn draw_sets(
        &mut self,
        background: &mut Background,
        resources: &mut Resources,
        (ui, layouts): (&mut UiRenderer, &Arc<SetLayouts>),
        picture: &RestingPicture,
        stale: Vec<Vec<&Mode>>,
        drawn: &mut Drawn,
    ) -> Result<Option<Duration>, GpuError> {
        let Some(shown) = &self.shown else { return Ok(None) };
        let gpu = background.gpu().clone();
        let draws = if background.is_fast() { DRAWS_PER_FRAME } else { 1 };
        let BoundSets { ready, missing, is_new } = shown.bind(resources, stale, &mut self.asked)?;
        drawn.builds.extend(is_new.then_some(Build::Thumbnails(missing)));
        if ready.is_empty() {
            return Ok(None);
        }
        let rows = (picture.shaders.modes.len() as u32).div_ceil(COLUMNS).max(1);
        let size = shown.size;
        self.provide(&gpu, layouts, ui, (size, rows))?;
        let (Some(renderer), Some((image, _))) = (&mut self.renderer, &self.atlas) else { return Ok(None) };
        let atlas = image.image().clone();
        let before = if std::mem::replace(&mut self.is_drawn, true) { Use::Sampled } else { Use::Undefined };
        let encoder = background.encoder()?;
        encoder.transition(&atlas, before, Use::CopyTo);
        let mut result = Ok(());
        for (index, (set, frame)) in ready.iter().take(draws).enumerate() {
            let cells: Vec<u32> = set
                .iter()
                .map(|mode| {
                    let next = self.cells.len() as u32;
                    *self.cells.entry(mode.slug.clone()).or_insert(next)
                })
                .collect();
            let corner = |cell: &u32| (cell % COLUMNS * size.0, cell / COLUMNS * size.1);
            let corners: Vec<(u32, u32)> = cells.iter().map(corner).collect();
            result = renderer.draw(encoder, index, frame, &atlas, &corners);
            if result.is_err() {
                break;
            }
            for (mode, (x, y)) in set.iter().zip(corners) {
                let (width, height) = (atlas.desc().width as f32, atlas.desc().height as f32);
                let at = egui::pos2(x as f32 / width, y as f32 / height);
                let place = egui::Rect::from_min_size(at, egui::vec2(size.0 as f32 / width, size.1 as f32 / height));
                self.thumbnails.places.insert(mode.slug.clone(), place);
                self.fresh.insert(mode.slug.clone());
            }
            self.drawn += set.len();
            self.thumbnails.texture = Some(image.texture);
        }
        // The user interface samples the texture from the next frame on.
        encoder.transition(&atlas, Use::CopyTo, Use::Sampled);
        result.map(|()| Some(Duration::ZERO))
    }

    /// Creates what thumbnails of `size` pixels need.
    fn provide(
        &mut self,
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        ui: &mut UiRenderer,
        (size, rows): ((u32, u32), u32),
    ) -> Result<(), GpuError> {
        if self.renderer.is_none() {
            self.renderer = Some(Thumbnails::new(gpu, layouts, DRAWS_PER_FRAME)?);
        }
        if self.atlas.is_none() {
            let image = Thumbnails::atlas(gpu, size, (COLUMNS, rows))?;
            self.atlas = Some((ui.add_image(&image)?, size));
            self.is_drawn = false;
        }
        Ok(())
    }

    /// Draws all thumbnails again: their commands were not submitted.
    pub(super) fn forget(&mut self) {
        self.fresh.clear();
        // The texture may be undefined.
        self.failed = true;
        self.is_drawn = false;
        if let Some(renderer) = &mut self.renderer {
            renderer.forget();
        }
    }
}

/// Width and height of a thumbnail in pixels. A software device draws twice the size along each side.
fn pixels(gpu: &Gpu, points: [f32; 2], pixels_per_point: f32) -> (u32, u32) {
    let scale = if gpu.info().kind != "cpu" { 1.0 } else { 2.0 } * pixels_per_point;
    let [width, height] = points.map(|points| ((points * scale).round() as u32).clamp(1, 512));
    (width, height)
}
