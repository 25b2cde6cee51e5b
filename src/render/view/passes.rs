//! How the passes that make up the picture are drawn, in the order in which they run: the model with its background, the
//! resolve of its samples, the mean, the tone map.
//!
//! The model is drawn in this order: opaque surfaces front to back; if a surface is transmissive, a copy of the HDR
//! target so far, blurred level by level (the opaque scene color, `behind` in GLSL), and those surfaces back to front;
//! the environment where nothing covers it; blended surfaces back to front. A mode that says `through` draws the opaque
//! surfaces twice: as in the final picture for the copy, then as the mode shows them. Lines of the wireframe come last,
//! in the same multisampled target, flagged as "no data" over data. Blended primitives are sorted by their centers, so
//! interleaved ones blend in the wrong order, unless `view.blend_layers` sorts them in each pixel (`peeling.rs`). Draws
//! beyond the frame are left out, unless a stage may move them into it.
//!
//! How `model` is drawn stays in Rust: the order of its surfaces, the copy of the opaque scene and the number of
//! samples depend on the scene and the settings, not on the shader tree.

use std::sync::Arc;

use super::declared::PassSets;
use super::model_draws::{Draws, ModelDraws, instances};
use super::output::cleared;
use super::peel_images::PeelImages;
use super::targets::{ColorTarget, Targets};
use crate::frame::{MaterialVariant, PipelineKey, PipelineRequest};
use crate::gpu::{Attachments, Encoder, Image, Pipeline, Rect, SetLayouts, Use, vk};
use crate::interface::ALPHA_BLEND;
use crate::render::bound_frame::BoundFrame;
use crate::render::scene::{Frustum, Layer, PlacedScene, Run, SortedDraws};
use crate::shader::GraphPass;

/// The rows of the model that a submission draws.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) rows: Rect,
    /// Whether no rows are drawn yet.
    pub(super) is_first: bool,
    /// Whether no rows are left.
    pub(super) is_last: bool,
}

/// The arguments of all passes of a frame.
#[derive(Clone, Copy)]
pub(super) struct Passes<'a> {
    pub(super) layouts: &'a Arc<SetLayouts>,
    pub(super) targets: &'a Targets,
    pub(super) frame: &'a BoundFrame,
    /// The model in the pose of the frame.
    pub(super) placed: Option<&'a Arc<PlacedScene>>,
    /// The sets of the stages of the model, the sky and the accumulation.
    pub(super) sets: &'a PassSets,
    /// The part of the frame to shade; `None` is all of it.
    pub(super) only: Option<Rect>,
    /// The targets of further modes that are drawn at once: color, and multisampled color if there is more than one sample.
    pub(super) more: &'a [ColorTarget],
    /// How blended surfaces are sorted in each pixel; `None` if they are not.
    pub(super) peeling: Option<&'a PeelImages<'a>>,
    /// The rows of the model to draw; `None` is all of them.
    pub(super) part: Option<Part>,
}

impl Passes<'_> {
    /// Draws the scene to the HDR target and resolves it, or the rows of a part. Leaves `color` in [`Use::Color`].
    pub(super) fn model(&self, encoder: &mut Encoder) {
        let targets = self.targets;
        // A later part keeps what is drawn.
        let (color, depth) = match self.is_first() {
            true => (Use::Undefined, Use::Undefined),
            false => (Use::Color, Use::Depth),
        };
        if !targets.color_replaces_depth {
            encoder.transition(&targets.color, color, Use::Color);
        }
        encoder.transition(&targets.depth, depth, Use::Depth);
        if let Some(multisampled) = &targets.multisampled {
            encoder.transition(multisampled, color, Use::Color);
        }
        let sorted = self.sorted();
        if let Some(opaque_scene) = targets.opaque_scene.as_ref().filter(|_| self.is_first()) {
            encoder.pass("behind", |encoder| self.opaque_scene(encoder, &sorted, opaque_scene));
        }
        encoder.pass("model", |encoder| self.surfaces(encoder, &sorted));
        self.take_back(sorted);
    }

    /// Draws the surfaces of several modes at once, each mode to its own target, and the sky to each. Transmissive surfaces show nothing
    /// behind them. Leaves all color targets in [`Use::Color`].
    pub(super) fn modes(&self, encoder: &mut Encoder) {
        let targets = self.targets;
        let first = ColorTarget { color: targets.color.clone(), multisampled: targets.multisampled.clone() };
        let all: Vec<&ColorTarget> = std::iter::once(&first).chain(self.more).collect();
        for image in all.iter().flat_map(|target| std::iter::once(&target.color).chain(&target.multisampled)) {
            encoder.transition(image, Use::Undefined, Use::Color);
        }
        encoder.transition(&targets.depth, Use::Undefined, Use::Depth);
        let sorted = self.sorted();
        let drawn: Vec<Arc<Image>> = self.more.iter().map(|target| target.drawn().clone()).collect();
        let attachments = Attachments {
            more: &drawn,
            clear: Some([0.0; 4]),
            depth: Some(&targets.depth),
            keeps_contents: true,
            ..Attachments::of(first.drawn())
        };
        encoder.begin_rendering(&attachments);
        for runs in [&sorted.opaque, &sorted.transmissive, &sorted.blended] {
            self.draw(encoder, &sorted, runs, PipelineRequest::model_key);
        }
        encoder.end_rendering();
        self.take_back(sorted);
        for target in all {
            encoder.transition(target.drawn(), Use::Color, Use::Color);
            encoder.transition(&targets.depth, Use::Depth, Use::Depth);
            let resolve = target.multisampled.as_ref().map(|_| &target.color);
            let attachments = Attachments {
                resolve,
                depth: Some(&targets.depth),
                keeps_contents: true,
                ..Attachments::of(target.drawn())
            };
            encoder.begin_rendering(&attachments);
            self.background(encoder);
            encoder.end_rendering();
        }
    }

    /// Draws the surfaces that the opaque scene color does not hold yet, and the sky.
    fn surfaces(&self, encoder: &mut Encoder, sorted: &SortedDraws) {
        let targets = self.targets;
        let opaque = self.opaque_keys();
        let clear = opaque.is_some().then_some([0.0; 4]);
        let (resolve_depth, keeps_depth) = (targets.resolved_depth.as_ref(), targets.desc.reads_depth);
        if let Some(resolved) = resolve_depth {
            let before = if self.is_first() { Use::Undefined } else { Use::DepthResolve };
            encoder.transition(resolved, before, Use::DepthResolve);
        }
        let weigh = self.request().resolve_key().and_then(|key| self.pipeline(&key));
        let hdr = self.hdr();
        let resolve = hdr.resolve.filter(|_| weigh.is_none());
        let peeling = self.peeling.filter(|_| !sorted.blended.is_empty());
        let last = Attachments { clear, resolve, resolve_depth, keeps_depth, ..hdr };
        self.begin(encoder, &if peeling.is_some() { self.in_parts(clear) } else { last });
        if let Some(keys) = opaque {
            self.draw(encoder, sorted, &sorted.opaque, keys);
            self.added(encoder, false);
        }
        self.draw(encoder, sorted, &sorted.transmissive, PipelineRequest::model_key);
        self.background(encoder);
        match peeling {
            None => self.draw(encoder, sorted, &sorted.blended, PipelineRequest::model_key),
            Some(peeling) => {
                encoder.end_rendering();
                self.sort_blended(encoder, sorted, peeling);
                self.begin(encoder, &Attachments { clear: None, ..last });
            }
        }
        self.added(encoder, true);
        self.wireframe(encoder);
        encoder.end_rendering();
        if !self.is_last() {
            return;
        }
        if let (Some(pipeline), Some(samples)) = (weigh, &targets.multisampled) {
            encoder.transition(samples, Use::Color, Use::Sampled);
            if targets.color_replaces_depth {
                encoder.transition(&targets.color, Use::Undefined, Use::Color);
            }
            self.weigh(encoder, pipeline);
        }
        if let Some(depth) = targets.read_depth() {
            let before = if resolve_depth.is_some() { Use::DepthResolve } else { Use::Depth };
            encoder.transition(depth, before, Use::Sampled);
        }
    }

    /// The pipelines that draw the opaque surfaces to the HDR target; `None` if it holds them: those in the opaque scene color are not drawn
    /// again, unless this mode draws them differently from the final picture, which that image holds. Parts begin with a clear target.
    fn opaque_keys(&self) -> Option<fn(&PipelineRequest, MaterialVariant) -> Option<PipelineKey>> {
        match (&self.targets.opaque_scene, self.part) {
            (Some(_), None) if !self.request().draws_opaque_twice() => None,
            (Some(_), Some(_)) if !self.request().draws_opaque_twice() => Some(PipelineRequest::opaque_scene_key),
            _ => Some(PipelineRequest::model_key),
        }
    }

    /// Attachments of the HDR target for a part of its draws.
    fn in_parts(&self, clear: Option<[f32; 4]>) -> Attachments<'_> {
        Attachments { clear, resolve: None, keeps_contents: true, ..self.hdr() }
    }

    fn begin(&self, encoder: &mut Encoder, to: &Attachments<'_>) {
        encoder.begin_rendering(to);
        if self.part.is_some() {
            encoder.set_viewport(whole(to.color));
        }
        if let Some(rect) = self.part.map(|part| part.rows).or(self.only) {
            encoder.set_scissor(rect);
        }
    }

    fn is_first(&self) -> bool {
        self.part.is_none_or(|part| part.is_first)
    }

    fn is_last(&self) -> bool {
        self.part.is_none_or(|part| part.is_last)
    }

    /// Draws the blended surfaces, sorted in each pixel, to the HDR target.
    fn sort_blended(&self, encoder: &mut Encoder, sorted: &SortedDraws, peeling: &PeelImages<'_>) {
        let (color, depth) = (self.hdr().color, &self.targets.depth);
        encoder.transition(color, Use::Color, Use::Color);
        encoder.transition(depth, Use::Depth, Use::Depth);
        self.peel(encoder, sorted, peeling, |encoder, to| {
            let (depth, clear_depth) = (Some(to.depth), to.clear_depth);
            self.begin(encoder, &Attachments { depth, clear_depth, ..self.in_parts(None) });
        });
        encoder.transition(color, Use::Color, Use::Color);
        encoder.transition(depth, Use::Depth, Use::Depth);
    }

    /// Draws the opaque surfaces and copies them with mip levels, for transmissive surfaces to look up.
    fn opaque_scene(&self, encoder: &mut Encoder, sorted: &SortedDraws, opaque_scene: &Arc<Image>) {
        let targets = self.targets;
        encoder.transition(opaque_scene, Use::Undefined, Use::Sampled);
        // All rows look it up.
        let area = whole(&targets.color);
        encoder.begin_rendering(&Attachments { keeps_contents: true, area, ..self.hdr() });
        self.draw(encoder, sorted, &sorted.opaque, PipelineRequest::opaque_scene_key);
        self.added(encoder, false);
        encoder.end_rendering();
        encoder.transition(&targets.color, Use::Color, Use::CopyFrom);
        encoder.transition(opaque_scene, Use::Sampled, Use::CopyTo);
        encoder.fill_levels(&targets.color, opaque_scene);
        encoder.transition(opaque_scene, Use::CopyFrom, Use::Sampled);
        encoder.transition(&targets.color, Use::CopyFrom, Use::Color);
        encoder.transition(&targets.depth, Use::Depth, Use::Depth);
        if let Some(multisampled) = &targets.multisampled {
            encoder.transition(multisampled, Use::Color, Use::Color);
        }
    }

    /// Draws the passes that add to the model: those that blend, or the others.
    pub(super) fn added(&self, encoder: &mut Encoder, blend: bool) {
        for pass in self.request().added_passes().filter(|pass| pass.desc.blend == blend) {
            let instances = instances(self.frame, pass);
            let model = self.model_draws(pass, instances);
            model.draw_pass(encoder);
        }
    }

    /// Draws the wireframe of all triangles over the picture, if the settings say so.
    fn wireframe(&self, encoder: &mut Encoder) {
        let Some(pass) = &self.request().wireframe else { return };
        self.model_draws(pass, 1).draw_all(encoder, false, |material| self.request().wireframe_key(material));
    }

    /// Draws the background where nothing covers it.
    pub(super) fn background(&self, encoder: &mut Encoder) {
        for pipeline in self.request().background_keys().filter_map(|key| self.pipeline(&key)) {
            self.sets.bind(encoder, pipeline);
            let (list, both, front) =
                (vk::PrimitiveTopology::TRIANGLE_LIST, vk::CullModeFlags::NONE, vk::FrontFace::COUNTER_CLOCKWISE);
            encoder.set_raster(list, both, front);
            encoder.draw(3);
        }
    }

    /// Makes one color from the samples of each pixel.
    fn weigh(&self, encoder: &mut Encoder, pipeline: &Arc<Pipeline>) {
        encoder.begin_rendering(&Attachments::of(&self.targets.color));
        if let Some(only) = self.only {
            encoder.set_scissor(only);
        }
        self.sets.bind(encoder, pipeline);
        encoder.draw(3);
        encoder.end_rendering();
    }

    /// Adds the newest frame to the accumulation buffer, and leaves that in [`Use::Sampled`].
    pub(super) fn accumulate(&self, encoder: &mut Encoder, index: u32) {
        let Some(mean) = &self.targets.mean else { return };
        let Some(pipeline) = self.request().average_key().and_then(|key| self.pipeline(&key)) else { return };
        encoder.pass("accumulate", |encoder| self.add_to_mean(encoder, mean, pipeline, index));
    }

    fn add_to_mean(&self, encoder: &mut Encoder, mean: &Arc<Image>, pipeline: &Arc<Pipeline>, index: u32) {
        encoder.transition(mean, if index == 0 { Use::Undefined } else { Use::Sampled }, Use::Color);
        let clear = (index == 0).then_some([0.0; 4]);
        encoder.begin_rendering(&Attachments { clear, ..Attachments::of(mean) });
        if let Some(only) = self.only {
            encoder.set_scissor(only);
        }
        self.sets.bind(encoder, pipeline);
        encoder.set_weight(1.0 / (index as f32 + 1.0));
        encoder.draw(3);
        encoder.end_rendering();
        encoder.transition(mean, Use::Color, Use::Sampled);
    }

    /// Tone maps the HDR image in `sets` to `rect` of `output`. The rest of `output` becomes black.
    pub(super) fn tone_map(&self, encoder: &mut Encoder, sets: &PassSets, output: &Arc<Image>, rect: Rect) {
        let key = self.request().tonemap_key();
        self.tone_map_with(encoder, key.as_ref(), sets, output, rect);
    }

    /// [`Passes::tone_map`] with the pipeline of one of several modes.
    pub(super) fn tone_map_with(
        &self,
        encoder: &mut Encoder,
        key: Option<&PipelineKey>,
        sets: &PassSets,
        output: &Arc<Image>,
        rect: Rect,
    ) {
        encoder.begin_rendering(&cleared(output));
        if let Some(pipeline) = key.and_then(|key| self.pipeline(key)) {
            encoder.set_viewport(rect);
            // After a resize, the previous frame may be larger than its output.
            encoder.set_scissor(self.only.unwrap_or(within(rect, whole(output))));
            sets.bind(encoder, pipeline);
            encoder.draw(3);
        }
        encoder.end_rendering();
    }

    fn request(&self) -> &PipelineRequest {
        &self.frame.state.pipelines
    }

    fn pipeline(&self, key: &PipelineKey) -> Option<&Arc<Pipeline>> {
        self.frame.pipelines.get(key)
    }

    /// Attachments of the HDR target, or of the rows of a part, cleared.
    fn hdr(&self) -> Attachments<'_> {
        let targets = self.targets;
        let area = self.part.map_or(whole(&targets.color), |part| part.rows);
        let (color, resolve) = match &targets.multisampled {
            Some(multisampled) => (multisampled, Some(&targets.color)),
            None => (&targets.color, None),
        };
        Attachments { clear: Some([0.0; 4]), resolve, depth: Some(&targets.depth), area, ..Attachments::of(color) }
    }

    pub(super) fn model_draws<'p>(&'p self, pass: &'p Arc<GraphPass>, instances: u32) -> ModelDraws<'p> {
        let Self { layouts, frame, placed, sets, .. } = self;
        ModelDraws { layouts, frame, placed: *placed, sets, instances, pass }
    }

    /// Draws surfaces with the pipelines that `key` selects.
    pub(super) fn draw(
        &self,
        encoder: &mut Encoder,
        sorted: &SortedDraws,
        runs: &[Run],
        key: fn(&PipelineRequest, MaterialVariant) -> Option<PipelineKey>,
    ) {
        let Some(pass) = self.request().model_pass() else { return };
        let model = self.model_draws(pass, instances(self.frame, pass));
        let draws = Draws { runs, commands: &sorted.commands, buffer: sorted.buffer.as_ref() };
        model.draw(encoder, &draws, |material| key(self.request(), material));
    }

    /// The draws of the scene that the camera may see, in the order that blending and depth require.
    pub(super) fn sorted(&self) -> SortedDraws {
        let Some(placed) = self.placed else { return SortedDraws::default() };
        let (state, request) = (&self.frame.state, self.request());
        // Bounds say nothing about vertices that the stages move.
        let frustum = request.keeps_vertices.then(|| Frustum::new(state.camera.clip_from_world(), state.size));
        let instances = request.model_pass().map_or(1, |pass| instances(self.frame, pass));
        placed.sorted(state.camera.eye, frustum.as_ref(), instances, |variant| match variant {
            v if v.alpha == ALPHA_BLEND => Layer::Blended,
            v if request.is_transmissive(v) => Layer::Transmissive,
            _ => Layer::Opaque,
        })
    }

    /// Gives back what [`Passes::sorted`] gave.
    pub(super) fn take_back(&self, sorted: SortedDraws) {
        if let Some(placed) = self.placed {
            placed.scene.take_back(sorted);
        }
    }
}

fn whole(image: &Image) -> Rect {
    Rect { x: 0, y: 0, width: image.desc().width, height: image.desc().height }
}

/// The part of `rect` inside `area`, which starts at 0, 0.
fn within(rect: Rect, area: Rect) -> Rect {
    Rect {
        width: rect.width.min(area.width.saturating_sub(rect.x)),
        height: rect.height.min(area.height.saturating_sub(rect.y)),
        ..rect
    }
}
