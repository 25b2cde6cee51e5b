//! The passes that a tree declares with `//@pass`, in the order in which they are drawn.
//!
//! A pass reads an image by its name. `uniform sampler2D glow;` is the image of the pass `glow`, `before_glow` the same
//! image one frame ago, `picture` the picture so far, and `depth` the depth of the model. A pass with `to=picture`
//! replaces the picture. A pass follows the passes whose images it reads, and the pass that its `after=` names. Names
//! break ties.

mod inputs;
mod order;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use super::annotation::Annotations;
use super::annotation::pass::{Dispatch, PassFormat, PassNote, PassSize, TextureNote, Wrap};
use super::compile::StageKind;
use super::contract::{INTERFACE_FILE, Texts};
use super::diagnostic::Diagnostic;
use super::source::snapshot::Snapshot;
use super::source::text::{find_word, lines};
use super::source::{SourceError, TreePath};
use super::spirv::reflect::Reflection;

/// The resource that a pass reads or writes at a binding of `interface::SET_PASS`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Input {
    /// The picture before this pass.
    Picture,
    /// Depth of the model: 1 near, 0 at infinity or where there is nothing.
    Depth,
    /// The image of another pass.
    Image(String),
    /// The image of a pass one frame ago.
    Before(String),
    /// A texture of the tree.
    Texture(String),
    /// The image of this pass, written by a compute shader.
    Output,
    /// A storage buffer that all passes share by the name of its block, with its size in bytes. It lasts from frame to frame.
    Buffer(String, u32),
    /// The block `Pass` of pass.glsl.
    Size,
    /// The pass's own uniform block: its size in bytes, and its members with their offsets.
    Parameters(u32, Vec<(u32, String)>),
}

/// A pass in its place in the [`Graph`].
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct GraphPass {
    /// The parsed `//@pass`.
    pub note: PassNote,
    /// Whether its stage is a compute shader. Otherwise it is a fragment shader over the whole image.
    pub is_compute: bool,
    /// Whether it runs after the tone map, on the displayed picture.
    pub after_tonemap: bool,
    /// The resource at each binding, from 0 on.
    pub inputs: Vec<Input>,
    /// The workgroup size of a compute pass.
    pub local_size: [u32; 3],
    /// Whether its image may change while nothing else does: the pass reads the time, the previous frame, or a buffer.
    pub moves: bool,
}

impl GraphPass {
    /// The name of the pass and its image.
    pub fn name(&self) -> &str {
        &self.note.name
    }

    /// Whether its own uniform block has a member of this name.
    pub fn has_parameter(&self, name: &str) -> bool {
        self.inputs.iter().any(|input| match input {
            Input::Parameters(_, members) => members.iter().any(|(_, member)| member == name),
            _ => false,
        })
    }

    /// The slug of the debug mode that shows its image.
    pub fn slug(&self) -> String {
        format!("pass:{}", self.note.name)
    }
}

/// An image file of the tree that passes sample.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    /// Name in GLSL.
    pub name: String,
    /// Path in the tree.
    pub path: String,
    /// Whether its colors are sRGB-encoded.
    pub srgb: bool,
    /// Addressing mode.
    pub wrap: Wrap,
    /// Whether it has mip levels.
    pub mips: bool,
    /// The content of the file.
    pub bytes: Arc<[u8]>,
    /// The parsed `//@texture`.
    pub note: TextureNote,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Texture").field("name", &self.name).field("path", &self.path).finish_non_exhaustive()
    }
}

/// The declared passes in order, and their textures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// In the order in which they are drawn. The tone map comes before the first pass with `after_tonemap`.
    pub passes: Vec<Arc<GraphPass>>,
    /// The textures that the passes sample, by name.
    pub textures: BTreeMap<String, Arc<Texture>>,
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
            if let Some(message) = contradiction(note, stage.kind) {
                errors.push(note.place.error(message));
                continue;
            }
            match inputs::inputs(note, stage, &names) {
                Ok(inputs) => passes.push(GraphPass {
                    moves: inputs.iter().any(|input| matches!(input, Input::Before(_) | Input::Buffer(..)))
                        || reads_clock(&stage.texts),
                    note: note.clone(),
                    is_compute: stage.kind == StageKind::Compute,
                    after_tonemap: false,
                    inputs,
                    local_size: stage.reflection.local_size,
                }),
                Err(found) => errors.extend(found),
            }
        }
        errors.extend(different_buffers(&passes));
        let used: BTreeSet<&str> = passes.iter().flat_map(|pass| &pass.inputs).filter_map(texture_name).collect();
        let mut textures = BTreeMap::new();
        for note in annotations.textures.iter().filter(|note| used.contains(note.name.as_str())) {
            match read_texture(note, snapshot) {
                Ok(texture) => {
                    textures.insert(note.name.clone(), Arc::new(texture));
                }
                Err(error) => errors.push(*error),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let passes = order::ordered(passes)?.into_iter().map(Arc::new).collect();
        Ok(Self { passes, textures })
    }

    /// The paths of the image files, which are watched with the tree.
    pub fn texture_paths(&self) -> impl Iterator<Item = &str> {
        self.textures.values().map(|texture| texture.path.as_str())
    }

    /// The pass of this name.
    pub fn pass(&self, name: &str) -> Option<&Arc<GraphPass>> {
        self.passes.iter().find(|pass| pass.name() == name)
    }

    /// The passes to draw, in order. Without `shown`: all passes with `to=picture`, and all passes whose images or
    /// buffers these use. With `shown`: the pass of that name, and what it needs. Passes for which `is_on` returns
    /// false are left out, except `shown` itself. A pass that nothing uses costs nothing.
    pub fn active(&self, is_on: impl Fn(&GraphPass) -> bool, shown: Option<&str>) -> Vec<Arc<GraphPass>> {
        let last = shown.and_then(|name| self.passes.iter().position(|pass| pass.name() == name));
        let mut needed: BTreeSet<usize> = BTreeSet::new();
        let mut open: Vec<usize> = (0..self.passes.len())
            .filter(|index| match last {
                Some(last) => *index == last || (*index < last && self.makes_picture(*index, &is_on)),
                None => self.makes_picture(*index, &is_on),
            })
            .collect();
        while let Some(index) = open.pop() {
            if !needed.insert(index) {
                continue;
            }
            for input in &self.passes[index].inputs {
                let shares = |pass: &GraphPass| match input {
                    Input::Image(name) | Input::Before(name) => pass.name() == name,
                    Input::Buffer(name, _) => {
                        pass.inputs.iter().any(|other| matches!(other, Input::Buffer(other, _) if other == name))
                    }
                    _ => false,
                };
                let found = self.passes.iter().enumerate().filter(|(_, pass)| shares(pass) && is_on(pass));
                open.extend(found.map(|(index, _)| index));
            }
        }
        needed.into_iter().map(|index| self.passes[index].clone()).collect()
    }

    fn makes_picture(&self, index: usize, is_on: impl Fn(&GraphPass) -> bool) -> bool {
        self.passes[index].note.to_picture && is_on(&self.passes[index])
    }
}

/// Whether the code of a text reads the clock: the time, the frame's number or the mouse.
pub fn text_reads_clock(text: &str) -> bool {
    const CLOCK: [&str; 4] = ["frame.time_s", "frame.delta_s", "frame.frame_index", "frame.mouse_px"];
    CLOCK.iter().any(|member| text.contains(member))
        && lines(text).iter().any(|line| CLOCK.iter().any(|member| find_word(&line.code, member).is_some()))
}

/// Whether any file of a stage, except the contract, reads the clock.
fn reads_clock(texts: &Texts<'_>) -> bool {
    let files = texts.dependencies.iter().filter(|path| path.as_str() != INTERFACE_FILE);
    files.filter_map(|path| texts.snapshot.read(path).ok()).any(|text| text_reads_clock(&text))
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
    (!is_compute && note.dispatch != Dispatch::Size).then_some("only a compute pass (.comp) has dispatch=")
}

/// An error for each pass that declares a buffer with another size than an earlier pass does.
fn different_buffers(passes: &[GraphPass]) -> Vec<Diagnostic> {
    let mut first: BTreeMap<&str, (u32, &GraphPass)> = BTreeMap::new();
    let mut errors = Vec::new();
    for pass in passes {
        for input in &pass.inputs {
            let Input::Buffer(name, bytes) = input else { continue };
            let (size, other) = *first.entry(name).or_insert((*bytes, pass));
            if size != *bytes {
                let message = format!(
                    "the buffer `{name}` has {bytes} bytes here and {size} in the pass `{}`; both share it",
                    other.name()
                );
                errors.push(pass.note.place.error(message).with_help("declare it once, in a file that both include"));
            }
        }
    }
    errors
}

fn texture_name(input: &Input) -> Option<&str> {
    match input {
        Input::Texture(name) => Some(name),
        _ => None,
    }
}

fn read_texture(note: &TextureNote, snapshot: &Snapshot<'_>) -> Result<Texture, Box<Diagnostic>> {
    let source = snapshot.source();
    let beside = TreePath::from(note.declared_in.as_str()).sibling(&note.image);
    let mut candidates: Vec<TreePath> = beside.into_iter().chain(TreePath::parse(&note.image)).collect();
    candidates.dedup();
    let refuse = |message: String| Err(Box::new(note.place.error(message)));
    if candidates.is_empty() {
        return refuse(format!("\"{}\" leaves the shader tree; images must stay inside its root", note.image));
    }
    for path in &candidates {
        match source.read_bytes(path) {
            Ok(bytes) => {
                let TextureNote { name, srgb, wrap, mips, .. } = note.clone();
                return Ok(Texture {
                    name,
                    path: path.to_string(),
                    srgb,
                    wrap,
                    mips,
                    bytes: bytes.into(),
                    note: note.clone(),
                });
            }
            Err(SourceError::Missing) => {}
            Err(error) => return refuse(format!("{} {error}", snapshot.display_path(path))),
        }
    }
    let looked: Vec<String> = candidates.iter().map(|path| snapshot.display_path(path)).collect();
    refuse(format!("\"{}\" not found; looked for {}", note.image, looked.join(" and ")))
}
