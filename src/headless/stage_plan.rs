//! Which stage of a frame is traced, which of its invocations, and which image holds their result.

use super::HeadlessError;
use crate::frame::FrameState;
use crate::frame::stages::{DEFORM, bake_stages};
use crate::scene;
use crate::shader::annotation::pass::{PassDesc, PassFormat, PassTarget};
use crate::shader::graph::{Input, RenderPhase};
use crate::shader::trace::{Invocations, Target, TraceableStage};
use crate::shader::{GraphPass, ShaderSet, Stage, StageKind, TreePath};

/// The part of a scene that is drawn for a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    /// The instances near the pixel.
    Near,
    /// One instance.
    Instance(usize),
    /// All.
    All,
}

/// The stages that can be traced, for a reader.
pub const UNTRACED: &str = "Fragment stages, the vertex stages of the model and of quads, and the compute stages of a picture are traced; those of \
    tessellation, geometry, tasks and meshes are not, and neither are those that bake light";

/// How a stage is traced.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StagePlan {
    /// The path of the stage.
    pub(super) stage: String,
    /// The invocations that are logged.
    pub(super) of: Invocations,
    /// The image that holds their result.
    pub(super) target: Target,
    /// The part of the scene that is drawn.
    pub(super) extent: Extent,
    /// Whether all pixels are drawn, and not only the one.
    pub(super) is_whole: bool,
    /// The samples of a pixel of that image.
    pub(super) samples: u32,
    /// Whether the depth test leaves out fragments.
    pub(super) hides: bool,
}

impl StagePlan {
    /// Why nothing was logged at a pixel of the picture.
    pub(super) fn nothing(&self, shaders: &ShaderSet, (x, y): (u32, u32)) -> String {
        let stage = shaders.name_of(&self.stage);
        match self.of {
            Invocations::Pixel(..) if !self.is_whole => {
                format!("the model does not cover the pixel {x},{y}: no fragment is drawn there")
            }
            Invocations::Pixel(x, y) => format!("{stage} draws nothing at the pixel {x},{y} of its image"),
            Invocations::Triangle(_) => format!("{stage} draws no vertex of the triangle at the pixel {x},{y}"),
            Invocations::Quad(quad) => format!("{stage} places no quad {quad}"),
            Invocations::Compute([x, y, z]) => format!("{stage} has no invocation {x},{y},{z}"),
        }
    }
}

/// The stages of a frame that can be traced: those of the model, of its passes, of its joints.
pub(super) fn traceable(state: &FrameState) -> Vec<TraceableStage> {
    let request = &state.pipelines;
    let mut all: Vec<TraceableStage> = Vec::new();
    let mut add = |path: &str, label: &str| {
        let is_new = !path.is_empty() && all.iter().all(|known| known.path != *path);
        if is_new && state.shaders.stages.contains_key(path) {
            let name = state.shaders.name_of(path).to_owned();
            all.push(TraceableStage { path: path.to_owned(), name, label: label.to_owned() });
        }
    };
    if let Some(pass) = shown_pass(state) {
        add(&pass.desc.stage, &pass.desc.label);
    }
    if request.draws_model {
        add(&request.stage, "Surfaces of the model");
        add(vertex_stage(state), "Vertices of the model");
    }
    for pass in &request.passes {
        add(&pass.desc.stage, &pass.desc.label);
        if pass_of_vertices(state, &pass.pre_rasterization.vertex).is_some() {
            add(&pass.pre_rasterization.vertex, &format!("Vertices of {}", pass.desc.label));
        }
    }
    if request.deforms {
        add(DEFORM, "Joints and morph targets");
    }
    all
}

/// The pass whose image is shown, or which makes the picture without a model.
fn shown_pass(state: &FrameState) -> Option<&GraphPass> {
    let request = &state.pipelines;
    let passes = || request.passes.iter().rev();
    let covering = || passes().find(|pass| pass.covers()).or_else(|| passes().find(|pass| !pass.desc.is_built_in()));
    let shown = request.shown().or_else(|| covering().filter(|_| !request.draws_model));
    shown.map(|pass| &**pass)
}

/// The vertex stage that draws the model; empty if another kind of stage does.
fn vertex_stage(state: &FrameState) -> &str {
    let before = state.pipelines.model_pass().map(|pass| &pass.pre_rasterization);
    before.filter(|before| before.mesh.is_none()).map_or("", |before| before.vertex.as_str())
}

/// The pass with a vertex stage of its own for the model or for quads.
fn pass_of_vertices<'a>(state: &'a FrameState, stage: &str) -> Option<&'a GraphPass> {
    let is_it = |pass: &&GraphPass| {
        let before = &pass.pre_rasterization;
        before.vertex == stage && before.mesh.is_none() && pass.desc.model.is_some()
    };
    let passes = || state.pipelines.passes.iter().map(|pass| &**pass);
    passes().find(is_it).filter(|_| stage != vertex_stage(state))
}

/// The stage that `wanted` names; otherwise the first that has all of these files, or that of the picture.
///
/// # Errors
/// The frame has no such stage.
pub(super) fn choose(state: &FrameState, wanted: Option<&str>, files: &[&str]) -> Result<String, HeadlessError> {
    let all = traceable(state);
    let list = || all.iter().map(|stage| stage.name.as_str()).collect::<Vec<_>>().join(", ");
    if let Some(wanted) = wanted {
        let wanted = state.shaders.stage_named(wanted).unwrap_or(wanted);
        return match all.iter().any(|stage| stage.path == wanted) {
            true => Ok(wanted.to_owned()),
            false => fails(format!(
                "the picture has no stage {} that can be traced; it has {}.{}",
                state.shaders.name_of(wanted),
                list(),
                why_not(state, wanted).map(|why| format!(" {why}")).unwrap_or_default()
            )),
        };
    }
    let has = |stage: &&TraceableStage, file: &str| {
        let known = state.shaders.stages.get(&stage.path);
        known.is_some_and(|known| known.path.as_str() == file || known.dependencies.contains(&TreePath::from(file)))
    };
    let with_files = all.iter().find(|stage| files.iter().all(|file| has(stage, file)));
    let alone = |file: &&str| !all.iter().any(|stage| has(&stage, file)) && is_untraced(state, file);
    match (with_files.or(all.first()), files.iter().find(|file| alone(file))) {
        (_, Some(file)) => fails(format!("{file} is not traced. {UNTRACED}")),
        (Some(stage), None) => Ok(stage.path.clone()),
        (None, None) => fails("the picture has no stage that can be traced".to_owned()),
    }
}

/// Why a stage of the tree is not traced.
fn why_not(state: &FrameState, path: &str) -> Option<&'static str> {
    let is_known = state.shaders.stages.contains_key(path);
    (is_known && is_untraced(state, path)).then_some(UNTRACED)
}

/// Whether a file is of a stage that is not traced in any picture.
fn is_untraced(state: &FrameState, file: &str) -> bool {
    let path = TreePath::from(file);
    let has = |stage: &Stage| stage.path == path || stage.dependencies.contains(&path);
    let is_traced = |stage: &Stage| match stage.kind {
        StageKind::Fragment | StageKind::Vertex => true,
        StageKind::Compute => !bake_stages().any(|bake| bake == stage.path.as_str()),
        _ => false,
    };
    let mut with_file = state.shaders.stages.values().filter(|stage| has(stage)).peekable();
    with_file.peek().is_some() && with_file.all(|stage| !is_traced(stage))
}

/// Whether a stage reads what earlier frames have drawn, itself or through the images that it reads.
pub(super) fn reads_earlier_frames(state: &FrameState, stage: &str) -> bool {
    let graph = &state.shaders.graph;
    let reads = |input: &Input| matches!(input, Input::Before(_) | Input::Buffer(..));
    let passes = state.pipelines.passes.iter().map(|pass| &**pass);
    let mut passes = passes.filter(|pass| pass.desc.stage == stage || pass.pre_rasterization.vertex == stage);
    passes.any(|pass| graph.needed_by(pass.name()).into_iter().any(|of| graph.passes[of].inputs.values().any(reads)))
}

/// The plan to trace a stage of [`traceable`] at a pixel of the picture. `invocation` names one of a compute stage.
///
/// # Errors
/// The stage does not run for this pixel, or which invocation is meant is not known.
pub(super) fn plan(
    state: &FrameState,
    stage: &str,
    at: (u32, u32),
    invocation: Option<[u32; 3]>,
) -> Result<StagePlan, HeadlessError> {
    let request = &state.pipelines;
    let kind = state.shaders.stages.get(stage).map(|stage| stage.kind);
    let name = state.shaders.name_of(stage);
    let pass = request.passes.iter().find(|pass| pass.desc.stage == stage);
    let is_with_model = pass.is_none_or(|pass| pass.desc.is_drawn_with_model());
    let samples = if is_with_model { request.target.samples } else { 1 };
    let hides = draws_surfaces(state, stage) || pass.is_some_and(|pass| pass.desc.draws_model());
    let make = |of, target, extent, is_whole| StagePlan {
        stage: stage.to_owned(),
        of,
        target,
        extent,
        is_whole,
        samples,
        hides,
    };
    let is_of_quads = pass_of_vertices(state, stage).is_some_and(|pass| pass.desc.quads);
    if invocation.is_some() && kind != Some(StageKind::Compute) && !is_of_quads {
        return fails(format!("{name} is no compute stage and places no quads, so it has no invocation to choose"));
    }
    match kind {
        Some(StageKind::Fragment) if draws_surfaces(state, stage) => {
            let extent = if request.follows_paths() { Extent::All } else { Extent::Near };
            Ok(make(Invocations::Pixel(at.0, at.1), Target::Picture, extent, false))
        }
        Some(StageKind::Vertex) => {
            let pass = pass_of_vertices(state, stage);
            let (target, is_whole) =
                (pass.map_or(Target::Picture, |pass| target_of(&state.shaders, pass)), pass.is_some());
            if pass.is_some_and(|pass| pass.desc.quads) {
                let [quad, ..] = invocation.unwrap_or_default();
                return Ok(make(Invocations::Quad(quad), target, Extent::All, is_whole));
            }
            let (instance, triangle) = triangle(state, at)?;
            Ok(make(Invocations::Triangle(triangle), target, Extent::Instance(instance), is_whole))
        }
        Some(StageKind::Fragment) => {
            let Some(pass) = pass else { return fails(format!("no pass of the picture draws {name}")) };
            let (x, y) = place_in(&pass.desc, state.size, at);
            Ok(make(Invocations::Pixel(x, y), target_of(&state.shaders, pass), Extent::All, true))
        }
        Some(StageKind::Compute) => {
            let of_pixel = pass.filter(|pass| pass.desc.to == PassTarget::Image).map(|pass| {
                let (x, y) = place_in(&pass.desc, state.size, at);
                [x, y, 0]
            });
            let Some(of) = invocation.or(of_pixel) else {
                return fails(format!("{name} does not run for a pixel: name an invocation of it"));
            };
            Ok(make(Invocations::Compute(of), Target::Unknown, Extent::All, true))
        }
        _ => fails(format!("{name} is not traced. {UNTRACED}")),
    }
}

/// The plan to run a stage of [`traceable`] for one instance, which logs no invocation. `None`: for the whole frame, as at a pixel.
///
/// # Errors
/// The stage runs for no pixel.
pub(super) fn without_log(
    state: &FrameState,
    stage: &str,
    at: (u32, u32),
    instance: Option<usize>,
) -> Result<StagePlan, HeadlessError> {
    const NONE: u32 = u32::MAX;
    let kind = state.shaders.stages.get(stage).map(|stage| stage.kind);
    let of = match kind {
        Some(StageKind::Vertex) if stage == vertex_stage(state) => Some(Invocations::Triangle([NONE; 3])),
        Some(StageKind::Fragment) if draws_surfaces(state, stage) => Some(Invocations::Pixel(NONE, NONE)),
        _ => None,
    };
    if let Some(pass) = pass_of_vertices(state, stage) {
        let (of, target, samples) =
            (Invocations::Triangle([NONE; 3]), target_of(&state.shaders, pass), state.pipelines.target.samples);
        let (stage, extent) = (stage.to_owned(), Extent::All);
        return Ok(StagePlan { stage, of, target, extent, is_whole: true, samples, hides: false });
    }
    let Some(of) = of else {
        return plan(state, stage, at, None);
    };
    let extent = instance.map_or(Extent::All, Extent::Instance);
    let (stage, samples) = (stage.to_owned(), state.pipelines.target.samples);
    Ok(StagePlan { stage, of, target: Target::Picture, extent, is_whole: false, samples, hides: false })
}

/// Whether a stage draws the surfaces of the model, each for itself: no pass and no path reads others.
pub(super) fn draws_instances(state: &FrameState, stage: &str) -> bool {
    let request = &state.pipelines;
    stage == vertex_stage(state) || draws_surfaces(state, stage) && request.is_local() && !request.follows_paths()
}

/// Whether a stage is the fragment stage of the model.
fn draws_surfaces(state: &FrameState, stage: &str) -> bool {
    let request = &state.pipelines;
    let pass = request.passes.iter().find(|pass| pass.desc.stage == stage);
    request.draws_model && request.stage == stage && pass.is_none_or(|pass| pass.desc.is_built_in())
}

/// The instance whose triangle is nearest at a pixel, and the indices of its vertices.
fn triangle(state: &FrameState, at: (u32, u32)) -> Result<(usize, [u32; 3]), HeadlessError> {
    let hit = state
        .scene
        .as_ref()
        .and_then(|scene| scene::pick(scene.model(), &state.camera, state.size, at, |instance| scene.sides(instance)));
    match hit {
        Some(hit) => Ok((hit.instance, hit.triangle)),
        None => fails(format!("no triangle of the model is at the pixel {},{}", at.0, at.1)),
    }
}

/// The pixel of a pass's image at a pixel of the picture.
fn place_in(desc: &PassDesc, size: (u32, u32), (x, y): (u32, u32)) -> (u32, u32) {
    if desc.to != PassTarget::Image {
        return (x, y);
    }
    let of = desc.size.pixels(size);
    let row = y * of.1 / size.1;
    (x * of.0 / size.0, if desc.rows_up { of.1.saturating_sub(row + 1) } else { row })
}

/// The image that a pass draws to.
fn target_of(shaders: &ShaderSet, pass: &GraphPass) -> Target {
    match (pass.desc.to, pass.phase) {
        (PassTarget::Image, _) if matches!(pass.desc.format, PassFormat::Rgba16f | PassFormat::Rgba32f) => {
            Target::Image(shaders.name_of_pass(pass).to_owned(), pass.desc.format)
        }
        (PassTarget::Image, _) => Target::Unknown,
        (_, RenderPhase::Tonemap | RenderPhase::Display) => Target::Display,
        _ => Target::Picture,
    }
}

fn fails<T>(message: String) -> Result<T, HeadlessError> {
    Err(HeadlessError::Settings(message))
}
