//! The passes that a tree declares with `//@pass`, in the order in which they are drawn.
//!
//! A pass reads an image by its name. `uniform sampler2D glow;` is the image of the pass `glow`, `before_glow` the same
//! image one frame ago, `picture` the picture so far, and `depth` the depth of the model. A pass with `to=picture`
//! replaces the picture, or adds to it if it draws the model or the background. A pass follows the passes whose images it reads,
//! and the pass that its `after=` names. Names break ties.
//!
//! Any `.frag` or `.comp` file of the tree that says `//@pass` is a stage (`Library::find_passes`), compiled, checked
//! and swapped in with the others: all or nothing. One file is one pass, so its name, its images and its errors have
//! one place. A pass says what it reads by declaring it, and nothing else: `uniform sampler2D glow;` needs no binding.
//! `compile/unbound.rs` finds such names in the text, and `spirv::bindings` moves them to `SET_PASS`; the binding of
//! each is its place among the sorted names, so that it does not change when an edit compiles a part of the stage.
//! Bindings of pre-rasterization stages begin at multiples of `VERTEX_BINDINGS`, so the stages of a pipeline share a
//! set. The pipeline layout holds what its specialized modules use (`gpu::PassLayout`): what a constant switches off is
//! not bound. The graph looks up the names (`inputs.rs`), orders the passes (`order.rs`), and refuses what is unknown
//! or waits for itself, with its line.
//!
//! **The picture itself is declared in the same way**, at the top of its stages; no stage of a picture is named in
//! Rust:
//!
//! | pass | stage | annotation |
//! |---|---|---|
//! | `model` | `pbr.frag` | `draw=model to=picture` |
//! | `debug`, `paths` | `debug.frag`, `paths.frag` | `draw=model to=picture instead=model`: draws the model in modes that say `stage=debug`, `stage=paths` |
//! | `background` | `sky.frag` | `draw=background to=picture` |
//! | `peel` | `peel.frag` | `to=peel`: the depth of the next layer of blended surfaces, if `view.blend_layers` is not 0 |
//! | `resolve` | `resolve.frag` | `to=resolve`: one color from the samples of a pixel, where the mode is tone mapped |
//! | `mean` | `average.frag` | `to=mean`: the accumulation buffer |
//! | `tonemap` | `tonemap.frag` | `to=display` |
//!
//! A tree must have `model` and `tonemap`; `roles.rs` says what is required of them. A tree without `peel` sorts
//! blended surfaces by primitives. One without `resolve` gets
//! plain averages, as data, accumulated frames, thumbnails and files of linear light do (`TargetFormat::weighs`).
//!
//! Order and phases:
//!
//! - What is drawn with the model shares its multisampled target and its depth (`RenderPhase::Model`): further passes
//!   with `draw=model to=picture` add shells, hulls or copies to it. Opaque ones follow the opaque surfaces, so
//!   transmissive surfaces show them; blended ones come last.
//! - A pass whose image the model or the background reads is drawn before the model (`RenderPhase::BeforeModel`), so it
//!   cannot read `picture` or `depth`. A compute pass that writes a buffer which the model, the background or quads
//!   only read (`readonly`) is drawn before them, with the compute passes that share its buffers, unless one of these
//!   needs their picture.
//! - The picture goes through the passes with `to=picture` one after the other: those before the tone map in the HDR
//!   format, those after it (`after=tonemap`, or after such a pass) in the display's format. A pass that reads
//!   `picture` sees it as it is at its place, which is just before the first pass that needs it.
//! - `Graph::active` keeps only what the picture, or the shown pass, needs, so a pass that is off, or that nobody
//!   reads, is never bound. Passes that are on but that nobody reads are compiled after the first picture, like those
//!   that are off (`Library::passes_off`). An image of a pass that is off reads as 0.
//! - A pass whose image is read as `before_NAME` keeps it, with or without `keep`. Passes of the tree
//!   (`passes/surface/last_picture.frag`) copy `picture` and `depth` when a pass reads `before_picture` or
//!   `before_depth`.
//! - A pass with `draw=background` covers what the model does not, at the model's samples and behind its blended
//!   surfaces. One that also has `blend` lies over the others, and over a plain or missing background too, as `ground`
//!   does. A window starts with `passes.ground=true` and the blurred environment (`Settings::of_window`); commands
//!   start with neither, so that `render` gives the model alone.

mod contradiction;
mod inputs;
mod order;
mod pass;
mod pre_rasterization;
mod roles;
mod stage;
mod textures;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::annotation::Annotations;
use super::annotation::pass::{MODEL, PassDesc, PassTarget};
use super::compile::StageKind;
use super::diagnostic::Diagnostic;
use super::source::snapshot::Snapshot;
use super::source::{SourceError, TreePath, embedded};
use super::spirv::primitive::Primitive;
use crate::interface::VERTEX_BINDINGS;
use contradiction::contradiction;
pub use inputs::read_later;
pub use pass::{GraphPass, Input, Inputs, RenderPhase};
pub use pre_rasterization::{MeshStages, PreRasterization, at_main, stage_beside, unlike_neighbors};
pub use roles::missing_passes;
pub use stage::{FULL_SCREEN, PassStage};
use textures::read_texture;
pub use textures::{Texture, TextureFile, TextureKind};

/// How to get the constant that `when=` names.
const DECLARE_A_CONSTANT: &str =
    "declare it: layout(constant_id = USER_CONSTANTS + 30) const bool NAME = true; //@ui \"Label\"";

/// The declared passes in order, and their textures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// In the order in which they are drawn.
    pub passes: Vec<Arc<GraphPass>>,
    /// The textures that the stages read, by name and kind.
    pub textures: BTreeMap<(String, TextureKind), Arc<Texture>>,
    /// The names of the passes that only work for others: they do not change the picture, and another pass needs them or may need
    /// them.
    pub internal: BTreeSet<String>,
}

impl Graph {
    /// Orders the passes that `annotations` declare. `stages`: the compiled stages by path. A pass is left out if its
    /// stage is not among them.
    ///
    /// # Errors
    /// An unknown name, an image of the wrong type, a cycle, a texture that cannot be read: each with its line.
    pub fn new(
        annotations: &Annotations,
        stages: &BTreeMap<String, PassStage<'_>>,
        snapshot: &Snapshot<'_>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut errors = Vec::new();
        let kept = with_kept_images(&annotations.passes, stages);
        let descs: Vec<&PassDesc> = kept.iter().filter(|desc| stages.contains_key(&desc.stage)).collect();
        let names = inputs::Names { passes: &kept, textures: &annotations.textures };
        errors.extend(roles::misplaced(annotations));
        // Without it, the stages are not those of a picture.
        if stages.contains_key(FULL_SCREEN) {
            errors.extend(missing_passes(&annotations.passes, &snapshot.source().name()));
            errors.extend(roles::undrawn_modes(annotations));
            errors.extend(roles::no_mean(annotations));
        }
        let model = annotations.passes.iter().find(|desc| desc.name == MODEL).map(|desc| desc.stage.as_str());
        let mut passes = Vec::new();
        for desc in descs {
            let stage = &stages[&desc.stage];
            let is_compute = stage.kind == StageKind::Compute;
            let mut pre_rasterization = match PreRasterization::find(desc, model, snapshot) {
                Ok(pre_rasterization) => pre_rasterization,
                Err(error) => {
                    errors.push(*error);
                    continue;
                }
            };
            if !is_compute && !pre_rasterization.stages().all(|path| stages.contains_key(path)) {
                // If it is there, it is still to be compiled.
                let vertex = &pre_rasterization.vertex;
                if snapshot.read(&TreePath::from(vertex.as_str())) == Err(SourceError::Missing) {
                    let message =
                        format!("the pass `{}` needs the vertex stage {vertex}, which does not exist", desc.name);
                    errors.push(desc.place.error(message));
                }
                continue;
            }
            if let Some(message) = desc.when.as_deref().and_then(|name| annotations.unknown_constant(name)) {
                errors.push(desc.place.error_at("when=", message).with_help(DECLARE_A_CONSTANT));
            }
            if let Some((word, message)) = contradiction(desc, stage.kind) {
                errors.push(desc.place.error_at(word, message));
                continue;
            }
            errors.extend(pre_rasterization.connect(stages).err().map(|error| *error));
            if desc.quads && !matches!(pre_rasterization.takes, None | Some(Primitive::Triangles)) {
                let message = format!("the pass `{}` draws quads of two triangles each", desc.name);
                errors.push(
                    desc.place
                        .error_at("draw=", message)
                        .with_help("write `layout(triangles) in;` in its geometry stage"),
                );
                continue;
            }
            errors.extend(roles::wrong_outputs(desc, stage));
            let pre_rasterization_stages = pre_rasterization.stages().filter(|_| !is_compute).map(|path| &stages[path]);
            let inputs = inputs::inputs_of(desc, pre_rasterization_stages.chain([stage]), &names);
            match inputs.map(|inputs| inputs::without_dead(inputs, desc, stage)) {
                Ok(inputs) => passes.push(GraphPass {
                    moves: inputs.values().any(moves),
                    desc: desc.clone(),
                    is_compute,
                    pre_rasterization,
                    phase: roles::phase(desc),
                    inputs,
                    local_size: stage.reflection.local_size,
                }),
                Err(found) => errors.extend(found),
            }
        }
        errors.extend(inputs::different_buffers(&passes));
        let inputs = passes.iter().flat_map(|pass| pass.inputs.values());
        let used: BTreeSet<(&str, TextureKind)> = inputs.filter_map(texture_of).collect();
        let mut textures = BTreeMap::new();
        for (name, kind) in used {
            let Some(desc) = annotations.textures.iter().find(|desc| desc.name == name) else { continue };
            match read_texture(desc, kind, snapshot) {
                Ok(texture) => {
                    textures.insert((name.to_owned(), kind), Arc::new(texture));
                }
                Err(error) => errors.push(*error),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let passes = order::ordered(passes)?.into_iter().map(Arc::new).collect();
        let graph = Self { passes, textures, internal: BTreeSet::new() };
        Ok(Self { internal: graph.find_internal(), ..graph })
    }

    /// The pass of this name.
    pub fn pass(&self, name: &str) -> Option<&Arc<GraphPass>> {
        self.passes.iter().find(|pass| pass.name() == name)
    }

    /// The pass that draws this image.
    pub fn maker(&self, image: &str) -> Option<&Arc<GraphPass>> {
        self.passes.iter().find(|pass| pass.desc.draws(image))
    }

    /// The passes to draw, in order: the built-in ones for which `is_base` returns true, with `is_picture` those that change the
    /// picture, and what these need. With `shown`: the pass of that name, and what it needs. Passes for whose
    /// index `is_on` returns false are left out, except `shown` itself, and so are those whose picture a later one covers. A pass
    /// that nothing uses costs nothing.
    pub fn active(
        &self,
        is_base: impl Fn(&GraphPass) -> bool,
        is_picture: bool,
        is_on: impl Fn(usize) -> bool,
        shown: Option<&str>,
    ) -> Vec<Arc<GraphPass>> {
        let last = shown.and_then(|name| self.passes.iter().position(|pass| pass.is_called(name)));
        let cover = if is_picture && last.is_none() { self.cover(&is_on).unwrap_or(0) } else { 0 };
        let mut open: Vec<usize> = (0..self.passes.len())
            .filter(|index| match last {
                Some(last) => *index == last || (*index < last && self.makes_picture(*index, &is_on)),
                None => is_picture && *index >= cover && self.makes_picture(*index, &is_on),
            })
            .collect();
        open.extend((0..self.passes.len()).filter(|index| is_base(&self.passes[*index])));
        let needed = self.with_inputs(open, is_on);
        needed.into_iter().map(|index| self.passes[index].clone()).collect()
    }

    /// The last pass that makes a displayed picture without reading the one before.
    fn cover(&self, is_on: impl Fn(usize) -> bool) -> Option<usize> {
        (0..self.passes.len()).rev().find(|index| self.passes[*index].covers() && is_on(*index))
    }

    /// Whether a pass for whose index `is_on` returns true covers the picture, so that it shows no model.
    pub fn is_covered(&self, is_on: impl Fn(usize) -> bool) -> bool {
        self.cover(is_on).is_some()
    }

    /// See [`Graph::internal`].
    fn find_internal(&self) -> BTreeSet<String> {
        let mut needed = BTreeSet::new();
        for pass in &self.passes {
            let all = self.needed_by(pass.name()).into_iter().map(|index| &self.passes[index]);
            let others = all.filter(|other| other.name() != pass.name() && !other.desc.to_picture());
            needed.extend(others.map(|other| other.name()));
        }
        // The surface's images are there for passes that the user may write.
        let is_offer = |pass: &GraphPass| pass.desc.to == PassTarget::Image && embedded::has(&pass.desc.stage);
        let is_internal = |pass: &&Arc<GraphPass>| {
            pass.name() == MODEL || pass.desc.watches.is_some() || needed.contains(pass.name()) || is_offer(pass)
        };
        self.passes.iter().filter(is_internal).map(|pass| pass.name().to_owned()).collect()
    }

    /// Indices of the pass `name` and of all passes whose images and buffers it needs.
    pub fn needed_by(&self, name: &str) -> BTreeSet<usize> {
        let shown = self.passes.iter().position(|pass| pass.is_called(name));
        self.with_inputs(shown.into_iter().collect(), |_| true)
    }

    /// The passes `open` and those whose images and buffers they need, as far as `is_on`.
    fn with_inputs(&self, mut open: Vec<usize>, is_on: impl Fn(usize) -> bool) -> BTreeSet<usize> {
        let mut needed = BTreeSet::new();
        while let Some(index) = open.pop() {
            if needed.insert(index) {
                let inputs = self.passes[index].inputs.values();
                open.extend(inputs.flat_map(|input| self.makers(input)).filter(|index| is_on(*index)));
            }
        }
        needed
    }

    /// The passes that write an input.
    fn makers(&self, input: &Input) -> impl Iterator<Item = usize> {
        // The built-in steps and the passes that add to the model are drawn for their own sake, not for a buffer that they declare.
        let is_maker = |pass: &GraphPass| !pass.desc.is_built_in() && !pass.desc.is_drawn_with_model();
        let shares = move |pass: &GraphPass| match input {
            Input::Image(name) | Input::Before(name) => pass.desc.draws(name),
            // Stages before the rasterizer only read.
            Input::Buffer(name, ..) => {
                let mut inputs = pass.inputs.range(..VERTEX_BINDINGS);
                inputs.any(|(_, other)| matches!(other, Input::Buffer(other, ..) if other == name))
            }
            _ => false,
        };
        self.passes.iter().enumerate().filter(move |(_, pass)| is_maker(pass) && shares(pass)).map(|(index, _)| index)
    }

    fn makes_picture(&self, index: usize, is_on: impl Fn(usize) -> bool) -> bool {
        let pass = &self.passes[index];
        let is_own = !pass.desc.is_drawn_with_model() || pass.adds_to_model();
        pass.desc.to_picture() && is_own && is_on(index)
    }
}

/// The passes, of which those keep their images that a stage reads one frame later, whether they say so or not.
fn with_kept_images(passes: &[PassDesc], stages: &BTreeMap<String, PassStage<'_>>) -> Vec<PassDesc> {
    let is_read_later = |desc: &PassDesc| {
        let mut found = stages.values().flat_map(|stage| &stage.reflection.descriptors);
        found.any(|found| read_later(&found.name).is_some_and(|image| desc.draws(image)))
    };
    passes.iter().map(|desc| PassDesc { keep: desc.keep || is_read_later(desc), ..desc.clone() }).collect()
}

/// The texture that an input reads.
fn texture_of(input: &Input) -> Option<(&str, TextureKind)> {
    match input {
        Input::Texture(name, kind) => Some((name, *kind)),
        _ => None,
    }
}

/// Whether an input may change while nothing else does.
fn moves(input: &Input) -> bool {
    match input {
        Input::Before(_) | Input::Buffer(..) => true,
        Input::Pass(_, members) => members.iter().any(|(_, name)| name != "size_px"),
        _ => false,
    }
}
