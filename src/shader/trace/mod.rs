//! What every statement of a stage computes at a pixel.
//!
//! The stage that draws the pixel is compiled once more with line information, and its module is instrumented (`spirv/trace.rs`), not its
//! text: types are exact, and macros, `#if`, headers of loops and `out` arguments need no guessing. The module writes a log to a buffer by
//! its address, which stands in it as a constant, so no contract changes. Only the fragments of the pixel write; the other pixels of its
//! quad run along, so derivatives and mip levels are the picture's. Values are bits, never floats, on their way.
//!
//! The set of pipelines is that of the picture except for this stage (`PipelineSet::variant`), so light and tables are the picture's.
//! The color with which the log of the visible fragment ends is compared with the picture's, bit by bit.

mod calls;
pub mod log;
mod report;
mod stage;
mod statement;
mod value;

use std::collections::BTreeMap;

use serde::Serialize;

use super::spirv::trace::Purpose;
use super::{Compiler, PixelValue, ShaderSet, Source};
use calls::Calls;
pub use report::{Assertion, LineOfTrace};
pub use stage::{Listener, ListeningStage, TracedStage};
pub use statement::Site;
pub use value::TracedValue;

/// A stage whose log is written to a buffer. Drivers put functions in place of their calls, so a module in which every statement calls the log
/// would take minutes to compile: each of its files is traced for itself.
pub struct LoggingStage<'a> {
    stage: ListeningStage<'a>,
    listener: Listener,
    address: u64,
}

impl<'a> LoggingStage<'a> {
    /// Compiles the fragment stage `stage` of `shaders` so that it writes a log to the buffer at `address`.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn new(
        shaders: &'a ShaderSet,
        stage: &str,
        tools: (&Compiler, &'a Source),
        address: u64,
    ) -> Result<Self, String> {
        let listener = log::listener();
        let stage = ListeningStage::new(shaders, stage, tools, &listener)?;
        Ok(Self { stage, listener, address })
    }

    /// The files with statements that can be traced.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn files(&self) -> Result<Vec<String>, String> {
        Ok(self.stage.traced(&self.listener, None, Some)?.files())
    }

    /// The stage with a log of what the statements of a file do.
    ///
    /// # Errors
    /// A message why the stage cannot be traced.
    pub fn of(&self, file: &str) -> Result<TracedStage<'_>, String> {
        self.stage.traced(&self.listener, Some(file), |words| log::with_address(&words, self.address))
    }
}

/// What happened at a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The fragments, the nearest first.
    pub fragments: Vec<Fragment>,
    /// Fragments that were left out.
    pub left_out: u32,
    /// The color of the pixel without the log: its bits.
    pub picture: [u32; 4],
    /// The text of the lines that were reached.
    code: BTreeMap<(String, u32), String>,
}

/// What one fragment did.
#[derive(Clone, Debug, PartialEq)]
pub struct Fragment {
    /// Depth: 1 near, 0 at infinity.
    pub depth: f32,
    /// The bits of its color; `None` if it was discarded.
    pub color: Option<[u32; 4]>,
    /// Its events, in order.
    pub events: Vec<Event>,
    /// Events that were left out.
    pub left_out: u32,
}

/// Something that a statement did.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The file, as the tree names it.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// What it did.
    pub act: Act,
    /// The variable or parameter that got the value, with the part of it: `lights[2].color`; empty for others.
    pub name: String,
    /// The value; none for a discard.
    pub value: Option<TracedValue>,
    /// The calls that led to it, outermost first: `shade > add_light [2]`.
    pub calls: std::sync::Arc<str>,
}

/// What a statement does.
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
}

impl Trace {
    /// The trace of a log that `stage` has written. `plain`: the pixel without the log.
    pub fn new(stage: &TracedStage<'_>, words: &[u32], plain: &PixelValue) -> Self {
        let bits = |pixel: &PixelValue| pixel.value.map(f32::to_bits);
        let (logged, left_out) = log::decode(words);
        let fragment = |logged: log::LoggedFragment| {
            let mut calls = Calls::default();
            let events = logged.events.iter().filter_map(|(number, bits)| event(stage, *number, *bits, &mut calls));
            let events = events.collect();
            // As the pixel is read: without flags in alpha.
            let color = logged.color.map(|color| bits(&PixelValue::decode(color.map(f32::from_bits))));
            Fragment { depth: logged.depth, color, events, left_out: logged.left_out }
        };
        let fragments: Vec<Fragment> = logged.into_iter().map(fragment).collect();
        let mut fragments = fragments;
        // A device may draw them in any order.
        fragments.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        let mut code = BTreeMap::new();
        for Event { file, line, .. } in fragments.iter().flat_map(|fragment| &fragment.events) {
            code.entry((file.clone(), *line)).or_insert_with(|| stage.line(file, *line));
        }
        Self { fragments, left_out, picture: bits(plain), code }
    }

    /// The fragment that is seen: the last one with the color of the picture, or else the nearest one that was not discarded. `None`
    /// where nothing was drawn.
    pub fn visible(&self) -> Option<usize> {
        let kept = || self.fragments.iter().enumerate().filter(|(_, fragment)| fragment.color.is_some());
        let is_seen = |(_, fragment): &(usize, &Fragment)| fragment.color == Some(self.picture);
        let nearest = || kept().max_by(|(_, a), (_, b)| a.depth.total_cmp(&b.depth));
        kept().filter(is_seen).last().or_else(nearest).map(|(index, _)| index)
    }

    /// Adds what the statements of another file did. The fragments of both are in the order of their depth.
    ///
    /// # Errors
    /// A message: the second draw had other fragments.
    pub fn add(&mut self, other: Self) -> Result<(), String> {
        let same = |(a, b): (&Fragment, &Fragment)| (a.depth.to_bits(), a.color) == (b.depth.to_bits(), b.color);
        if self.fragments.len() != other.fragments.len() || !self.fragments.iter().zip(&other.fragments).all(same) {
            return Err("the pixel changes from one draw to the next, so it cannot be traced".to_owned());
        }
        for (fragment, more) in self.fragments.iter_mut().zip(other.fragments) {
            fragment.events.extend(more.events);
            fragment.left_out += more.left_out;
        }
        self.code.extend(other.code);
        Ok(())
    }

    /// Whether a fragment ends with the color of the picture, bit by bit.
    pub fn is_proven(&self, fragment: usize) -> bool {
        self.fragments.get(fragment).is_some_and(|fragment| fragment.color == Some(self.picture))
    }
}

/// An event of a log. `None` for the begin and the end of a function, which change `calls`.
fn event(stage: &TracedStage<'_>, number: u32, bits: [u32; 4], calls: &mut Calls) -> Option<Event> {
    let telling = stage.telling(number)?;
    let place = stage.place(telling);
    let (act, name) = match &place.purpose {
        Purpose::Enter(name) => {
            calls.enter(name);
            return None;
        }
        Purpose::Leave => {
            calls.leave();
            return None;
        }
        Purpose::Argument(name) => (Act::Argument, name.as_str()),
        Purpose::Store(name) => (Act::Store, name.as_str()),
        Purpose::Condition => (Act::Condition, ""),
        Purpose::Return => (Act::Return, ""),
        Purpose::Discard => (Act::Discard, ""),
        Purpose::Input(_) | Purpose::Use => return None,
    };
    let value = (telling.count > 0).then(|| TracedValue::new(telling.kind, &bits[..telling.count as usize]));
    let (file, line) = (place.file.clone(), place.line);
    Some(Event { file, line, act, name: format!("{name}{}", telling.part), value, calls: calls.path() })
}
