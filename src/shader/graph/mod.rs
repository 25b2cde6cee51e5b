//! The passes that a tree declares with `//@pass`, in the order in which they are drawn.
//!
//! A pass reads an image by its name. `uniform sampler2D glow;` is the image of the pass `glow`, `before_glow` the same
//! image one frame ago, `picture` the picture so far, and `depth` the depth of the model. A pass with `to=picture`
//! replaces the picture. A pass follows the passes whose images it reads, and the pass that its `after=` names. Names
//! break ties.

mod inputs;
mod order;
mod textures;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use super::annotation::Annotations;
use super::annotation::pass::{Dispatch, PassFormat, PassNote, PassSize};
use super::compile::StageKind;
use super::contract::Texts;
use super::diagnostic::Diagnostic;
use super::source::snapshot::Snapshot;
use super::source::{SourceError, TreePath};
use super::spirv::reflect::Reflection;
use crate::interface::VERTEX_BINDINGS;
use textures::read_texture;
pub use textures::{Texture, TextureFile, TextureKind};

/// The resource that a pass reads or writes at a binding of `interface::SET_PASS`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Input {
    /// The picture before this pass.
    Picture,
    /// The opaque surfaces, which transmissive surfaces look up.
    Behind,
    /// Depth of the model: 1 near, 0 at infinity or where there is nothing.
    Depth,
    /// The image of another pass.
    Image(String),
    /// The image of a pass one frame ago.
    Before(String),
    /// A texture of the tree, as the kind that the stage declares.
    Texture(String, TextureKind),
    /// The image of this pass, written by a compute shader.
    Output,
    /// A storage buffer that all passes share by the name of its block, with its size in bytes. It lasts from frame to frame.
    Buffer(String, u32),
    /// The block `Pass` of pass.glsl and toy.glsl: its size in bytes, and its members with their offsets.
    Pass(u32, Vec<(u32, String)>),
    /// The pass's own uniform block: its size in bytes, and its members with their offsets.
    Parameters(u32, Vec<(u32, String)>),
}

/// The vertex stage of stages that cover an image.
pub const FULL_SCREEN: &str = "fullscreen.vert";
/// The vertex stage of the model.
pub const MODEL: &str = "pbr.vert";

/// How to get the constant that `when=` names.
const DECLARE_A_CONSTANT: &str =
    "declare it: layout(constant_id = USER_CONSTANTS + 30) const bool NAME = true; //@ui \"Label\"";

/// Inputs by their binding in `interface::SET_PASS`.
pub type Inputs = BTreeMap<u32, Input>;

/// The part of a frame in which a pass is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Part {
    /// Before the model, which reads its image.
    BeforeModel,
    /// Between the model and the tone map: the picture is linear light.
    #[default]
    Light,
    /// After the tone map: the picture is as the display shows it.
    Display,
}

/// A pass in its place in the [`Graph`].
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct GraphPass {
    /// The parsed `//@pass`.
    pub note: PassNote,
    /// Whether its stage is a compute shader. Otherwise it is a fragment shader over the whole image.
    pub is_compute: bool,
    /// The vertex stage of its own, if it has one.
    pub vertex: Option<String>,
    /// When it is drawn.
    pub part: Part,
    /// The images, textures and buffers that it reads and writes.
    pub inputs: Inputs,
    /// Invocations of a workgroup, of a compute pass.
    pub local_size: [u32; 3],
    /// Whether its image may change while the settings do not: it reads the previous frame, a buffer, or the clock in the block
    /// `Pass`. The clock in the block `Frame` does not count: the compiled modules tell which pipelines read that.
    pub moves: bool,
}

impl GraphPass {
    /// The name of the pass and its image.
    pub fn name(&self) -> &str {
        &self.note.name
    }

    /// The vertex stage of a pass that is no compute pass.
    pub fn vertex_stage(&self) -> &str {
        let default = if self.note.model.is_some() { MODEL } else { FULL_SCREEN };
        self.vertex.as_deref().unwrap_or(default)
    }

    /// Whether its own uniform block has a member of this name.
    pub fn has_parameter(&self, name: &str) -> bool {
        self.inputs.values().any(|input| match input {
            Input::Parameters(_, members) => members.iter().any(|(_, member)| member == name),
            _ => false,
        })
    }

    /// Whether it makes a displayed picture without reading the one before.
    pub fn covers(&self) -> bool {
        let reads_picture = || self.inputs.values().any(|input| *input == Input::Picture);
        self.note.to_picture && self.part == Part::Display && !reads_picture()
    }

    /// Whether the user wants the pass. `switched`: the passes that she switched on or off, by name.
    pub fn is_wanted(&self, switched: &BTreeMap<String, bool>) -> bool {
        switched.get(self.name()).copied().unwrap_or(self.note.on)
    }

    /// The slug of the debug mode that shows its image.
    pub fn slug(&self) -> String {
        format!("pass:{}", self.note.name)
    }
}

/// The declared passes in order, and their textures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// In the order in which they are drawn.
    pub passes: Vec<Arc<GraphPass>>,
    /// The inputs of the stages that come with Specula, by path.
    pub readers: BTreeMap<String, Inputs>,
    /// The textures that the stages read, by name and kind.
    pub textures: BTreeMap<(String, TextureKind), Arc<Texture>>,
}

/// A stage that declares a pass.
pub struct PassStage<'a> {
    /// Vertex, fragment or compute.
    pub kind: StageKind,
    /// The declarations of its module.
    pub reflection: &'a Reflection,
    /// Its source text.
    pub texts: Texts<'a>,
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
        let notes: Vec<&PassNote> = annotations.passes.iter().filter(|note| stages.contains_key(&note.stage)).collect();
        let names = inputs::Names { passes: &annotations.passes, textures: &annotations.textures };
        let mut passes = Vec::new();
        for note in notes {
            let stage = &stages[&note.stage];
            let vertex = vertex_of(&note.stage);
            let has_vertex = stage.kind != StageKind::Compute
                && snapshot.read(&TreePath::from(vertex.as_str())) != Err(SourceError::Missing);
            // It is still to be compiled.
            if has_vertex && !stages.contains_key(&vertex) {
                continue;
            }
            if let Some(message) = note.when.as_deref().and_then(|name| annotations.unknown_constant(name)) {
                errors.push(note.place.error(message).with_help(DECLARE_A_CONSTANT));
            }
            if let Some(message) = contradiction(note, stage.kind) {
                errors.push(note.place.error(message));
                continue;
            }
            let own_vertex = has_vertex.then(|| inputs::inputs(note, &stages[&vertex], &names));
            match inputs::inputs(note, stage, &names).and_then(|inputs| with(inputs, own_vertex)) {
                Ok(inputs) => passes.push(GraphPass {
                    moves: inputs.values().any(moves),
                    note: note.clone(),
                    is_compute: stage.kind == StageKind::Compute,
                    vertex: has_vertex.then_some(vertex),
                    part: Part::default(),
                    inputs,
                    local_size: stage.reflection.local_size,
                }),
                Err(found) => errors.extend(found),
            }
        }
        let mut readers = BTreeMap::new();
        for (path, stage) in stages.iter().filter(|(path, _)| inputs::is_built_in(path)) {
            match inputs::built_in(path, stage, &names) {
                Ok(inputs) => {
                    readers.insert(path.clone(), inputs);
                }
                Err(found) => errors.extend(found),
            }
        }
        for pass in passes.iter_mut().filter(|pass| pass.vertex.is_none() && !pass.is_compute) {
            let shared = readers.get(pass.vertex_stage()).cloned().unwrap_or_default();
            pass.moves |= shared.values().any(moves);
            pass.inputs.extend(shared);
        }
        errors.extend(different_buffers(&passes, &readers));
        // The model shows how it was one frame ago.
        let is_before =
            |name: &str| readers.values().flat_map(BTreeMap::values).any(|i| *i == Input::Before(name.into()));
        passes.iter_mut().for_each(|pass| pass.moves |= is_before(&pass.note.name));
        let inputs = passes.iter().map(|pass| &pass.inputs).chain(readers.values());
        let used: BTreeSet<(&str, TextureKind)> = inputs.flat_map(BTreeMap::values).filter_map(texture_of).collect();
        let mut textures = BTreeMap::new();
        for (name, kind) in used {
            let Some(note) = annotations.textures.iter().find(|note| note.name == name) else { continue };
            match read_texture(note, kind, snapshot) {
                Ok(texture) => {
                    textures.insert((name.to_owned(), kind), Arc::new(texture));
                }
                Err(error) => errors.push(*error),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let passes = order::ordered(passes, &readers)?.into_iter().map(Arc::new).collect();
        Ok(Self { passes, readers, textures })
    }

    /// The inputs of a pipeline's stages, as far as they come with Specula.
    pub fn reads(&self, stages: &[&str]) -> Inputs {
        let inputs = stages.iter().filter_map(|stage| self.readers.get(*stage));
        inputs.flatten().map(|(binding, input)| (*binding, input.clone())).collect()
    }

    /// The pass of this name.
    pub fn pass(&self, name: &str) -> Option<&Arc<GraphPass>> {
        self.passes.iter().find(|pass| pass.name() == name)
    }

    /// Whether another pass reads the image of the pass with this name.
    pub fn is_read(&self, name: &str) -> bool {
        let inputs = self.passes.iter().flat_map(|pass| pass.inputs.values());
        inputs.into_iter().any(|input| matches!(input, Input::Image(read) if read == name))
    }

    /// The passes to draw, in order: those whose images or buffers `stages` read, with `is_picture` those that change the
    /// picture, and what these need. With `shown`: the pass of that name, and what it needs. Passes for whose
    /// index `is_on` returns false are left out, except `shown` itself, and so are those whose picture a later one covers. A pass that nothing uses costs nothing.
    pub fn active(
        &self,
        stages: &[&str],
        is_picture: bool,
        is_on: impl Fn(usize) -> bool,
        shown: Option<&str>,
    ) -> Vec<Arc<GraphPass>> {
        let last = shown.and_then(|name| self.passes.iter().position(|pass| pass.name() == name));
        let cover = if is_picture && last.is_none() { self.cover(&is_on).unwrap_or(0) } else { 0 };
        let mut open: Vec<usize> = (0..self.passes.len())
            .filter(|index| match last {
                Some(last) => *index == last || (*index < last && self.makes_picture(*index, &is_on)),
                None => is_picture && *index >= cover && self.makes_picture(*index, &is_on),
            })
            .collect();
        for input in stages.iter().filter_map(|stage| self.readers.get(*stage)).flat_map(BTreeMap::values) {
            open.extend(self.makers(input).filter(|index| is_on(*index)));
        }
        let needed = self.with_inputs(open, is_on);
        needed.into_iter().map(|index| self.passes[index].clone()).collect()
    }

    /// The last pass that makes a displayed picture without reading the one before.
    fn cover(&self, is_on: impl Fn(usize) -> bool) -> Option<usize> {
        (0..self.passes.len()).rev().find(|index| self.passes[*index].covers() && is_on(*index))
    }

    /// Indices of the pass `name` and of all passes whose images and buffers it needs.
    pub fn needed_by(&self, name: &str) -> BTreeSet<usize> {
        let shown = self.passes.iter().position(|pass| pass.name() == name);
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
        let shares = move |pass: &GraphPass| match input {
            Input::Image(name) | Input::Before(name) => pass.name() == name,
            // Vertex stages only read.
            Input::Buffer(name, _) => {
                let mut inputs = pass.inputs.range(..VERTEX_BINDINGS);
                inputs.any(|(_, other)| matches!(other, Input::Buffer(other, _) if other == name))
            }
            _ => false,
        };
        self.passes.iter().enumerate().filter(move |(_, pass)| shares(pass)).map(|(index, _)| index)
    }

    fn makes_picture(&self, index: usize, is_on: impl Fn(usize) -> bool) -> bool {
        self.passes[index].note.to_picture && is_on(index)
    }
}

/// The inputs of a fragment stage, and those of its vertex stage.
fn with(mut inputs: Inputs, vertex: Option<Result<Inputs, Vec<Diagnostic>>>) -> Result<Inputs, Vec<Diagnostic>> {
    inputs.extend(vertex.transpose()?.into_iter().flatten());
    Ok(inputs)
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

/// A message if the options of an annotation contradict each other, or do not apply to this kind of stage.
fn contradiction(note: &PassNote, kind: StageKind) -> Option<&'static str> {
    let is_compute = kind == StageKind::Compute;
    if note.to_picture && is_compute {
        return Some("a compute pass writes an image of its own; read that in a fragment pass with to=picture");
    }
    let given = note.size != PassSize::Divided(1) || note.format != PassFormat::default() || note.mips || note.keep;
    if note.to_picture && given {
        return Some(
            "the picture has its own size and format, so size=, format=, mips and keep do not go with to=picture",
        );
    }
    if note.model.is_some() && is_compute {
        return Some("a compute pass cannot draw the model; draw=model is for .frag files");
    }
    if note.model.is_some() && note.to_picture {
        return Some("a pass with draw=model draws to an image of its own; read that in a pass with to=picture");
    }
    (!is_compute && note.dispatch != Dispatch::Size).then_some("only a compute pass (.comp) has dispatch=")
}

/// The path of the vertex stage that the stage of a pass may have beside it.
pub fn vertex_of(stage: &str) -> String {
    format!("{}.vert", stage.rsplit_once('.').map_or(stage, |(stem, _)| stem))
}

/// Errors of passes whose buffer another pass, or a stage that comes with Specula, declares with another size.
fn different_buffers(passes: &[GraphPass], readers: &BTreeMap<String, Inputs>) -> Vec<Diagnostic> {
    let mut first: BTreeMap<&str, (u32, String)> = BTreeMap::new();
    for (path, inputs) in readers {
        for input in inputs.values() {
            if let Input::Buffer(name, bytes) = input {
                first.entry(name).or_insert_with(|| (*bytes, format!("`{path}`")));
            }
        }
    }
    let mut errors = Vec::new();
    for pass in passes {
        for input in pass.inputs.values() {
            let Input::Buffer(name, bytes) = input else { continue };
            let (size, other) = first.entry(name).or_insert_with(|| (*bytes, format!("the pass `{}`", pass.name())));
            if *size != *bytes {
                let message =
                    format!("the buffer `{name}` has {bytes} bytes here and {size} in {other}; both share it");
                errors.push(pass.note.place.error(message).with_help("declare it once, in a file that both include"));
            }
        }
    }
    errors
}
