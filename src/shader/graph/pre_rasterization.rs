//! The stages of a pass before the rasterizer: which files they are, and whether they fit together.
//!
//! A pass has pre-rasterization stages of its own or those of the model: with any of the files `NAME.vert`, `.geom`,
//! `.tesc`, `.tese`, `.mesh`, `.task` beside `NAME.frag` it takes these, and the model's vertex stage if it has none.
//! So `pbr.tese` moves the picture, its debug modes and all passes without such files. The contract compares the
//! outputs of each stage with the inputs of the next, without the array of vertices. Materials on points or lines get
//! no pipeline in a pass whose stages take triangles. With `draw=quads` the vertex stage must not read `draw.vertices`,
//! whose address would be 0, so that word, and the material, are refused in any file that its stages include.
//!
//! Limits: the output limit of a geometry stage (1024 numbers on every device, `max_vertices` times its outputs) is
//! left to the driver. Shadow maps have a vertex stage of their own, so geometry and tessellation stages beside
//! `pbr.frag` do not change shadows; path tracing, framing and picking use the mesh as it was loaded.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::{FULL_SCREEN, PassStage};
use crate::shader::annotation::pass::PassDesc;
use crate::shader::compile::StageKind;
use crate::shader::contract::{Texts, check_pair};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};
use crate::shader::spirv::primitive::Primitive;

/// The pre-rasterization stages of a pass, by their paths.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct PreRasterization {
    /// Its own vertex stage, that of the model, or [`FULL_SCREEN`]. It does not run if there is a mesh stage.
    pub vertex: String,
    /// Tessellation control and tessellation evaluation.
    pub tessellation: Option<[String; 2]>,
    /// The geometry stage.
    pub geometry: Option<String>,
    /// The stages that run in place of all of these.
    pub mesh: Option<MeshStages>,
    /// The only primitives of the model that the stages accept; `None` for all.
    pub takes: Option<Primitive>,
}

/// The stages of a mesh pipeline, by their paths, and how the triangles of the model are divided among their workgroups.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct MeshStages {
    /// The task stage.
    pub task: Option<String>,
    /// The mesh stage.
    pub mesh: String,
    /// Triangles of a group: as many as a workgroup of the mesh stage has invocations.
    pub triangles: u32,
    /// Groups of each workgroup that a draw starts: as many as a workgroup of the task stage has invocations, or 1 without one.
    pub groups: u32,
}

impl PreRasterization {
    /// The paths, in the order in which the stages run.
    pub fn stages(&self) -> impl Iterator<Item = &str> {
        let between = self.tessellation.iter().flatten().chain(&self.geometry);
        let vertex = std::iter::once(&self.vertex).chain(between).filter(|_| self.mesh.is_none());
        let mesh = self.mesh.iter().flat_map(|mesh| mesh.task.iter().chain([&mesh.mesh]));
        vertex.chain(mesh).map(String::as_str)
    }

    /// The stages of a full-screen pass.
    fn full_screen() -> Self {
        Self { vertex: FULL_SCREEN.to_owned(), ..Self::default() }
    }

    /// Finds the files of a pass. Stages beside its own stage belong to it. A pass that draws the model takes the rest from
    /// `model`, the stage of the model's pass: all stages if it has none of its own, otherwise the vertex stage. A mesh stage
    /// takes precedence over a vertex stage.
    ///
    /// # Errors
    /// - A pass that draws quads has no vertex stage, or a stage that reads what only a model has.
    /// - One that draws neither has another stage than a vertex stage.
    /// - A stage lacks the one that it needs beside it, or has one beside it that a mesh pipeline does not have.
    pub(super) fn find(desc: &PassDesc, model: Option<&str>, snapshot: &Snapshot<'_>) -> Result<Self, Box<Diagnostic>> {
        let own = |stage: &str, kind| Some(stage_beside(stage, kind)).filter(|path| exists(path, snapshot));
        let has_own = StageKind::PRE_RASTERIZATION.iter().any(|kind| own(&desc.stage, *kind).is_some());
        let (stage, model) = match (desc.draws_model(), model) {
            (true, Some(model)) => (if has_own { &desc.stage } else { model }, Some(model)),
            _ => (desc.stage.as_str(), None),
        };
        let [vertex, control, evaluation, geometry, task, mesh] =
            StageKind::PRE_RASTERIZATION.map(|kind| own(stage, kind));
        if desc.model.is_none()
            && let Some(path) = [&control, &evaluation, &geometry, &task, &mesh].into_iter().flatten().next()
        {
            let (name, kind) = (&desc.name, stage_name(path));
            let message = format!("the pass `{name}` draws no model, so it has no {kind} stage");
            let help = format!("write draw=model in the //@pass of {}, or delete this file", desc.stage);
            return Err(Box::new(at_main(path, message, snapshot).with_help(help)));
        }
        if desc.quads {
            check_quads(desc, vertex.as_deref(), mesh.as_deref().or(task.as_deref()), snapshot)?;
        }
        let vertex = vertex.or_else(|| model.map(|model| stage_beside(model, StageKind::Vertex)));
        let tessellation = match (control, evaluation) {
            (Some(control), Some(evaluation)) => Some([control, evaluation]),
            (None, None) => None,
            (Some(found), None) => return Err(half(&found, StageKind::TessellationEvaluation, snapshot)),
            (None, Some(found)) => return Err(half(&found, StageKind::TessellationControl, snapshot)),
        };
        let vertex = vertex.unwrap_or(Self::full_screen().vertex);
        let mesh = match (task, mesh) {
            (task, Some(mesh)) => Some(MeshStages { task, mesh, ..MeshStages::default() }),
            (Some(task), None) => return Err(half(&task, StageKind::Mesh, snapshot)),
            (None, None) => None,
        };
        let found = Self { vertex, tessellation, geometry, mesh, takes: None };
        let unused = found.tessellation.iter().flatten().chain(&found.geometry).next();
        match found.mesh.as_ref().zip(unused) {
            Some((MeshStages { mesh, .. }, path)) => {
                let message = format!("{mesh} replaces this {} stage", stage_name(path));
                Err(Box::new(at_main(path, message, snapshot).with_help("delete one of the two files")))
            }
            None => Ok(found),
        }
    }

    /// Sets which primitives the stages accept, and how many. `stages`: the compiled stages.
    ///
    /// # Errors
    /// The geometry stage takes other primitives than it gets, or the message of the task stage is not that of the mesh stage.
    pub(super) fn connect(&mut self, stages: &BTreeMap<String, PassStage<'_>>) -> Result<(), Box<Diagnostic>> {
        if let Some(mesh) = &mut self.mesh {
            self.takes = Some(Primitive::Triangles);
            return mesh.connect(stages);
        }
        let geometry = self.geometry.as_ref().and_then(|path| stages.get(path));
        let taken = geometry.and_then(|stage| stage.reflection.takes);
        let given = self.tessellation.as_ref().and_then(|[_, path]| stages.get(path)?.reflection.gives.zip(Some(path)));
        self.takes = if self.tessellation.is_some() { Some(Primitive::Triangles) } else { taken };
        let evaluation = self.tessellation.as_ref().and_then(|[_, path]| stages.get(path));
        if let Some(last) = geometry.or(evaluation).filter(|stage| !has_point_size(stage)) {
            let message = "the stage gives points of no size".to_owned();
            return Err(Box::new(last.texts.error(&["main", "void"], message).with_help("write gl_PointSize")));
        }
        let (Some(stage), Some(taken)) = (geometry, taken) else { return Ok(()) };
        let refuse =
            |message: String, help: &str| Err(Box::new(stage.texts.error(&["in", "layout"], message).with_help(help)));
        match given {
            Some((given, path)) if given != taken => {
                let message = format!("the geometry stage takes {}, but {path} gives {}", taken.glsl(), given.glsl());
                refuse(message, &format!("write `layout({}) in;`", given.glsl()))
            }
            None if taken == Primitive::WithNeighbors => refuse(
                "the model is drawn without the neighbors of its primitives".to_owned(),
                "write `layout(triangles) in;`, or `points` or `lines` for models of points or lines",
            ),
            _ => Ok(()),
        }
    }
}

impl MeshStages {
    fn connect(&mut self, stages: &BTreeMap<String, PassStage<'_>>) -> Result<(), Box<Diagnostic>> {
        let Some(mesh) = stages.get(&self.mesh) else { return Ok(()) };
        let task = self.task.as_ref().and_then(|path| stages.get(path));
        let invocations = |stage: &PassStage<'_>| stage.reflection.local_size.iter().product::<u32>().max(1);
        (self.triangles, self.groups) = (invocations(mesh), task.map_or(1, invocations));
        let gives = task.is_some_and(|task| task.reflection.has_payload);
        let (message, help) = match (gives, mesh.reflection.has_payload) {
            (true, false) => (
                format!("the stage does not read what {} gives", self.task.as_deref().unwrap_or_default()),
                "write `#define AFTER_TASK` before including common/model.mesh.glsl",
            ),
            (false, true) => (
                format!("the stage reads what a task stage gives, {}", stage_beside(&self.mesh, StageKind::Task)),
                "write that file, or delete `#define AFTER_TASK`",
            ),
            _ => return Ok(()),
        };
        Err(Box::new(mesh.texts.error(&["main", "void"], message).with_help(help)))
    }
}

/// Errors of stages whose inputs do not match the outputs of the previous stage. `paths`: those of a pipeline, in their order.
pub fn unlike_neighbors<'p>(
    paths: impl Iterator<Item = &'p str>,
    stages: &BTreeMap<String, PassStage<'_>>,
) -> Vec<Diagnostic> {
    let Some(all) = paths.map(|path| stages.get(path)).collect::<Option<Vec<_>>>() else { return Vec::new() };
    let mut errors = Vec::new();
    for pair in all.windows(2) {
        let [writer, reader] = [pair[0], pair[1]].map(|stage| (stage.reflection, stage.texts));
        errors.extend(check_pair(writer, reader));
        let help = match pair[0].kind {
            StageKind::Geometry => "write `gl_PrimitiveID = gl_PrimitiveIDIn;` before EmitVertex()",
            StageKind::Mesh => "write `gl_MeshPrimitivesEXT[i].gl_PrimitiveID` of each triangle",
            _ => continue,
        };
        if pair[1].reflection.reads_primitive_id && !pair[0].reflection.writes_primitive_id {
            let message = format!("{} reads gl_PrimitiveID, which this stage does not write", reader.1.stage);
            errors.push(writer.1.error(&["main", "void"], message).with_help(help));
        }
    }
    errors
}

/// The path of the stage of this kind beside another stage.
pub fn stage_beside(stage: &str, kind: StageKind) -> String {
    format!("{}.{}", stage.rsplit_once('.').map_or(stage, |(stem, _)| stem), kind.extension())
}

fn stage_name(path: &str) -> &'static str {
    StageKind::of(&TreePath::from(path)).map_or("", StageKind::name)
}

/// Whether a stage that outputs points uses `gl_PointSize`. Stages with other primitives need not.
fn has_point_size(stage: &PassStage<'_>) -> bool {
    /// SPIR-V's capabilities TessellationPointSize and GeometryPointSize.
    const POINT_SIZE: std::ops::RangeInclusive<u32> = 23..=24;
    let reflection = stage.reflection;
    reflection.gives != Some(Primitive::Points) || reflection.capabilities.iter().any(|c| POINT_SIZE.contains(c))
}

fn exists(path: &str, snapshot: &Snapshot<'_>) -> bool {
    snapshot.read(&TreePath::from(path)) != Err(SourceError::Missing)
}

/// Checks the stages of a pass with draw=quads: `vertex` and `mesh` lie beside its stage.
fn check_quads(
    desc: &PassDesc,
    vertex: Option<&str>,
    mesh: Option<&str>,
    snapshot: &Snapshot<'_>,
) -> Result<(), Box<Diagnostic>> {
    let name = &desc.name;
    if let Some(path) = mesh {
        let message = format!("the pass `{name}` draws quads, so it has no {} stage", stage_name(path));
        let help = "write draw=model in its //@pass: a mesh stage makes its own vertices";
        return Err(Box::new(at_main(path, message, snapshot).with_help(help)));
    }
    if vertex.is_none() {
        let stage = stage_beside(&desc.stage, StageKind::Vertex);
        let message = format!("the pass `{name}` draws quads, so it needs a vertex stage that places them, {stage}");
        let help = "gl_VertexIndex is 0 to 5, the corners of two triangles; gl_InstanceIndex is the number of the quad";
        return Err(Box::new(desc.place.error_at("draw=", message).with_help(help)));
    }
    Ok(())
}

/// An error about a stage whose other half of the tessellation is missing.
fn half(found: &str, missing: StageKind, snapshot: &Snapshot<'_>) -> Box<Diagnostic> {
    let (kind, other) = (missing.name(), stage_beside(found, missing));
    let message = format!("the {} stage needs a {kind} stage beside it, {other}", stage_name(found));
    Box::new(at_main(found, message, snapshot))
}

/// An error at the line of `main` of a file.
pub fn at_main(path: &str, message: String, snapshot: &Snapshot<'_>) -> Diagnostic {
    let (stage, dependencies) = (TreePath::from(path), BTreeSet::new());
    Texts { snapshot, stage: &stage, dependencies: &dependencies }.error(&["main", "void"], message)
}
