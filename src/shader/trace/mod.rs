//! Values that every statement of a stage computes at a pixel.
//!
//! A stage of the picture (the one that draws the pixel, the vertices of its triangle, a pass, a compute stage) is compiled once more with line information, and its module is instrumented (`spirv/trace/`), not its
//! text: types are exact, and macros, `#if`, headers of loops and `out` arguments need no guessing. The module writes a log to a buffer by
//! its address, which stands in it as a constant, so no contract changes. Only the chosen invocations write; the other pixels of a
//! quad run along, so derivatives and mip levels are the picture's. Values are bits, never floats, on their way.
//!
//! The set of pipelines is that of the picture except for this stage (`PipelineSet::variant`), so light and tables are the picture's.
//! The color with which the log of the visible fragment ends is compared with the picture's, bit by bit; that of a pass with its image.

mod around;
mod assertion;
mod calls;
mod conditions;
mod elements;
mod events;
mod history;
mod invocations;
mod lights;
pub mod log;
mod numbered;
mod report;
#[cfg(test)]
pub(crate) mod sample;
mod samples;
mod stage;
mod statement;
mod value;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::Serialize;

use super::graph::PreRasterization;
use super::{Compiler, ShaderSet, Source, StageKind};
pub use around::{Neighborhood, Which};
pub use assertion::Assertion;
pub use calls::{is_related, last_call, light_of, paths_to};
pub use history::FragmentState;
use invocations::color_of;
pub use invocations::{Invocations, Target, TraceableStage};
pub use lights::TracedLight;
pub use log::EXTENSIONS;
pub use numbered::Numbered;
pub use report::{Done, LineOfTrace, Once};
pub use stage::{Listener, ListeningStage, TracedStage, compile_listening};
pub use statement::Site;
pub use value::TracedValue;

/// Most log points of a module once all calls are inlined, unless a single file has more. Drivers inline every call, and each copy of a
/// log point takes some 20 ms to compile on a software device.
const MOST_INSTANCES: usize = 400;

/// A stage whose log is written to a buffer. A module in which every statement of every file logs would take a driver minutes to compile,
/// so several modules log a few files each.
pub struct LoggingStage {
    stage: ListeningStage,
    /// With the statements of all files.
    whole: TracedStage,
    listener: Listener,
    address: u64,
}

impl LoggingStage {
    /// Compiles the stage `stage` of `shaders` so that it writes a log to the buffer at `address`.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn new(
        shaders: &Arc<ShaderSet>,
        stage: &str,
        tools: (&Compiler, &Source),
        address: u64,
    ) -> Result<Self, String> {
        let kind = shaders.stages.get(stage).map_or(StageKind::Fragment, |of| of.kind);
        let color = shaders.stages.get(stage).and_then(|of| color_of(of));
        let listener = log::listener(kind, color, has_primitives(shaders, stage), places_quads(shaders, stage))
            .ok_or_else(|| format!("{stage} is not traced: only fragment, vertex and compute stages are"))?;
        let stage = ListeningStage::new(shaders, stage, tools, &listener)?;
        let whole = stage.traced(&listener, None, |words, _| Some(words))?;
        Ok(Self { stage, whole, listener, address })
    }

    /// Groups of files that a module each can log. `wanted` names files; if it is empty, all are logged that the stage keeps with one of
    /// these lists of constants.
    ///
    /// # Errors
    /// A message why the stage cannot be traced, or that it has no statement of a wanted file.
    pub fn groups(&self, wanted: &[&str], constants: &[&[(u32, u32)]]) -> Result<Vec<BTreeSet<String>>, String> {
        let files: BTreeSet<&str> = self.whole.places().map(|place| place.file.as_str()).collect();
        if let Some(unknown) = wanted.iter().find(|file| !files.contains(**file)) {
            let list: Vec<&str> = files.into_iter().collect();
            return Err(format!("no statement of {unknown} is in the stage, which has those of {}", list.join(", ")));
        }
        if let [file] = wanted {
            return Ok(vec![BTreeSet::from([(*file).to_owned()])]);
        }
        let mut instances = self.instances(constants);
        instances.retain(|file, _| wanted.is_empty() || wanted.contains(&file.as_str()));
        wanted.iter().for_each(|file| _ = instances.entry((*file).to_owned()).or_default());
        let (mut groups, mut used): (Vec<BTreeSet<String>>, usize) = (Vec::new(), 0);
        for (file, count) in instances {
            used += count;
            match groups.last_mut().filter(|_| used <= MOST_INSTANCES) {
                Some(group) => _ = group.insert(file),
                None => {
                    groups.push(BTreeSet::from([file]));
                    used = count;
                }
            }
        }
        match groups.is_empty() {
            true => Err("the stage has no statements that could be traced".to_owned()),
            false => Ok(groups),
        }
    }

    /// The files whose statements the stage keeps with one of these lists of constants.
    pub fn files(&self, constants: &[&[(u32, u32)]]) -> Vec<String> {
        let kept = self.instances(constants).into_iter().filter(|(_, count)| *count > 0);
        kept.map(|(file, _)| file).collect()
    }

    /// How many log points of each file are in the stage at most, with one of these lists of constants.
    fn instances(&self, constants: &[&[(u32, u32)]]) -> BTreeMap<String, usize> {
        let mut all: BTreeMap<String, usize> = BTreeMap::new();
        for (file, count) in constants.iter().flat_map(|of| self.whole.instances(self.listener.function, of)) {
            let most = all.entry(file).or_default();
            *most = count.max(*most);
        }
        all
    }

    /// The stage with a log of what the statements of these files do.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn of(&self, files: &BTreeSet<String>) -> Result<TracedStage, String> {
        let finish = |words: Vec<u32>, points: usize| log::Layout::new(points).finish(&words, self.address);
        let traced = self.stage.traced(&self.listener, Some(files), finish)?;
        let names = || files.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
        match traced.point_count() < log::MOST_POINTS as usize {
            true => Ok(traced),
            false => Err(format!("{} has too many statements to be traced", names())),
        }
    }
}

/// Whether a stage draws the model alone, and gets the numbers of its primitives. A geometry or mesh stage may not pass them on.
fn has_primitives(shaders: &ShaderSet, stage: &str) -> bool {
    let passes_on = |before: &PreRasterization| {
        let last = before.mesh.as_ref().map(|mesh| &mesh.mesh).or(before.geometry.as_ref());
        last.is_none_or(|last| shaders.stages.get(last).is_some_and(|stage| stage.reflection.writes_primitive_id))
    };
    let mut passes = shaders.graph.passes.iter().filter(|pass| pass.desc.stage == stage).peekable();
    passes.peek().is_some() && passes.all(|pass| pass.desc.draws_model() && passes_on(&pass.pre_rasterization))
}

/// Whether a stage places the corners of quads.
fn places_quads(shaders: &ShaderSet, stage: &str) -> bool {
    shaders.graph.passes.iter().any(|pass| pass.desc.quads && pass.pre_rasterization.vertex == stage)
}

/// The invocations of a stage at a pixel, with all that they did.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The stage.
    pub stage: String,
    /// Its kind.
    pub kind: StageKind,
    /// The fragments, the nearest first. Of a vertex stage, the vertices of the triangle, each as often as it was drawn differently; of
    /// a compute stage, the invocation.
    pub fragments: Vec<Fragment>,
    /// Fragments that were left out.
    pub left_out: u32,
    /// The image that holds the result of the fragments.
    pub target: Target,
    /// The samples of a pixel of that image.
    pub samples: u32,
    /// The color of the pixel there: its bits.
    pub picture: [u32; 4],
    /// The same where the traced stage draws.
    pub redrawn: [u32; 4],
    /// The lights of the frame, which calls number from 1. Suns of the environment are not among them.
    pub lights: Vec<TracedLight>,
    /// The words of a loop that did not end in the picture: pixels where its rounds ran out are magenta there.
    pub endless_loop: Option<[u32; 2]>,
    /// Whether the stage reads earlier frames which the picture on screen has, and both draws of the trace have not.
    pub begins_anew: bool,
    /// The text of the lines with statements that log.
    code: BTreeMap<(String, u32), String>,
}

/// The statements and the result of one fragment, vertex or compute invocation.
#[derive(Clone, Debug, PartialEq)]
pub struct Fragment {
    /// Depth of a fragment: 1 near, 0 at infinity.
    pub depth: f32,
    /// The index of a vertex.
    pub vertex: Option<u32>,
    /// The samples of the pixel that a fragment covers, as bits; `None` if they are not known.
    pub samples: Option<u32>,
    /// The number of a fragment's primitive in its draw, from 0, as `gl_PrimitiveID`; `None` if it is not known.
    pub primitive: Option<u32>,
    /// The bits of its color, or of a vertex's position in clip space; `None` if it was discarded.
    pub color: Option<[u32; 4]>,
    /// Its events, in the order of execution for each group of files: of each statement, the first and the last.
    pub events: Vec<Event>,
    /// How many events between these were not logged.
    pub not_logged: u32,
}

/// A statement, and the kind of its effect.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Doing {
    /// The file, as the tree names it.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// Kind of what it does.
    pub act: Act,
    /// The variable or parameter that gets the value, with the part of it: `lights[2].color`; empty for others.
    pub name: String,
}

/// Something that a statement did.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The action of the statement. Events of the same one share it.
    pub doing: Arc<Doing>,
    /// The value; none for a discard and a return without one.
    pub value: Option<TracedValue>,
    /// The calls that led to it, outermost first: `shade > add_light [light 2]`.
    pub calls: Arc<str>,
    /// The time that the statement does this, from 1. Those between the first and the last times may be missing.
    pub time: u32,
}

/// The kinds of what statements do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Act {
    /// Its function gets an argument.
    Argument,
    /// Stores a value.
    Store,
    /// Decides what is next.
    Condition,
    /// Returns a value.
    Return,
    /// Discards the fragment.
    Discard,
    /// Returns without a value.
    Leave,
}

impl Trace {
    /// The fragment that is seen: the nearest one with the color of the picture, or else the one that is seen in the most samples of the
    /// pixel, the nearest of several. `None` where nothing was drawn.
    pub fn visible(&self) -> Option<usize> {
        let kept = || self.fragments.iter().enumerate().filter(|(_, fragment)| fragment.color.is_some());
        let most = || kept().rev().max_by_key(|(index, _)| self.seen_samples(*index, None).count_ones());
        let found = kept().find(|(_, fragment)| self.is_shown(fragment)).or_else(most);
        found.map(|(index, _)| index)
    }

    /// Adds what the statements of other files did, from another draw of the pixel.
    ///
    /// # Errors
    /// A message: that draw had other fragments.
    pub fn add(&mut self, other: Self) -> Result<(), String> {
        let key = |of: &Fragment| (of.depth.to_bits(), of.color, of.primitive, of.samples);
        let same = |(a, b): (&Fragment, &Fragment)| key(a) == key(b);
        if self.fragments.len() != other.fragments.len() || !self.fragments.iter().zip(&other.fragments).all(same) {
            return Err(
                "the pixel changes from one draw to the next, so only one file can be traced: name it with --file"
                    .to_owned(),
            );
        }
        for (fragment, more) in self.fragments.iter_mut().zip(other.fragments) {
            fragment.events.extend(more.events);
            fragment.not_logged += more.not_logged;
        }
        self.code.extend(other.code);
        if other.redrawn != self.picture {
            self.redrawn = other.redrawn;
        }
        Ok(())
    }

    /// Whether the result of the stage is a color that can be read.
    fn has_color(&self) -> bool {
        self.kind == StageKind::Fragment && self.target != Target::Unknown
    }

    fn is_shown(&self, fragment: &Fragment) -> bool {
        self.has_color() && fragment.color.is_some_and(|color| self.target.holds(color, self.picture))
    }
}
