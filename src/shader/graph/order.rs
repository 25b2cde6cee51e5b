//! The drawing order of passes.

use std::collections::{BTreeMap, BTreeSet};

use super::{GraphPass, Input, Inputs, RenderPhase};
use crate::message::did_you_mean;
use crate::shader::annotation::pass::TONEMAP;
use crate::shader::diagnostic::Diagnostic;

/// The passes in drawing order.
///
/// # Errors
/// An unknown name after `after=`, a cycle, or an image that is read before it is drawn.
pub fn ordered(mut passes: Vec<GraphPass>) -> Result<Vec<GraphPass>, Vec<Diagnostic>> {
    passes.sort_by(|a, b| a.name().cmp(b.name()));
    let index: BTreeMap<String, usize> =
        passes.iter().enumerate().flat_map(|(index, pass)| names(pass).map(move |name| (name, index))).collect();
    let unknown: Vec<Diagnostic> = passes.iter().filter_map(|pass| unknown_after(pass, &index)).collect();
    if !unknown.is_empty() {
        return Err(unknown);
    }
    put_on_display(&mut passes, &index);
    put_before_model(&mut passes, &index)?;
    put_writers_before_model(&mut passes, &index);
    let too_early: Vec<Diagnostic> = passes.iter().filter_map(|pass| after_later(pass, &passes, &index)).collect();
    if !too_early.is_empty() {
        return Err(too_early);
    }
    let mut order =
        Order { passes: &passes, index: &index, state: vec![VisitState::New; passes.len()], done: Vec::new() };
    for phase in [
        RenderPhase::BeforeModel,
        RenderPhase::Model,
        RenderPhase::Peel,
        RenderPhase::Resolve,
        RenderPhase::Mean,
        RenderPhase::Light,
        RenderPhase::Tonemap,
        RenderPhase::Display,
    ] {
        let in_phase = |at: &usize| passes[*at].phase == phase;
        let (makers, others): (Vec<usize>, Vec<usize>) =
            (0..passes.len()).filter(in_phase).partition(|at| passes[*at].desc.to_picture());
        for at in makers.into_iter().chain(others) {
            order.emit(at, &mut Vec::new()).map_err(|error| vec![*error])?;
        }
    }
    let done = put_beside_host(order.done, &passes, &index);
    let mut passes: Vec<Option<GraphPass>> = passes.into_iter().map(Some).collect();
    Ok(done.into_iter().filter_map(|at| passes[at].take()).collect())
}

/// Puts the pass that shows an expression just before the pass whose stage it copies, so that both read the same picture.
fn put_beside_host(mut order: Vec<usize>, passes: &[GraphPass], index: &BTreeMap<String, usize>) -> Vec<usize> {
    let place = |order: &[usize], pass: usize| order.iter().position(|at| *at == pass);
    let watch = passes.iter().position(|pass| pass.desc.watches.is_some());
    let host = watch.and_then(|watch| index.get(passes[watch].desc.watches.as_deref()?));
    if let (Some(watch), Some(host)) = (watch, host)
        && passes[watch].phase == passes[*host].phase
    {
        order.retain(|at| *at != watch);
        let at = place(&order, *host).unwrap_or(order.len());
        order.insert(at, watch);
    }
    order
}

/// The names of a pass and of its images.
fn names(pass: &GraphPass) -> impl Iterator<Item = String> {
    std::iter::once(pass.name().to_owned()).chain(pass.desc.also.iter().map(|(name, _)| name.clone()))
}

/// A pass that follows the tone map, or reads the image of such a pass, is drawn after the tone map.
fn put_on_display(passes: &mut [GraphPass], index: &BTreeMap<String, usize>) {
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for at in 0..passes.len() {
            let follows = |name: &str| {
                name == TONEMAP || index.get(name).is_some_and(|at| passes[*at].phase == RenderPhase::Display)
            };
            let reads = images(&passes[at].inputs).any(follows);
            let after = passes[at].desc.after.as_deref().is_some_and(follows);
            let reads_picture = || passes[at].inputs.values().any(|input| *input == Input::Picture);
            let beside = passes[at].desc.watches.as_deref().filter(|host| *host != TONEMAP && reads_picture());
            let after = after || beside.is_some_and(follows);
            if (reads || after) && passes[at].phase == RenderPhase::Light {
                passes[at].phase = RenderPhase::Display;
                changed = true;
            }
        }
    }
}

/// Moves the passes whose images the model or the background reads before the model, with all passes that they read.
fn put_before_model(passes: &mut [GraphPass], index: &BTreeMap<String, usize>) -> Result<(), Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let is_reader = |pass: &&GraphPass| {
        matches!(pass.phase, RenderPhase::Model | RenderPhase::Resolve | RenderPhase::Mean | RenderPhase::Tonemap)
    };
    let readers: Vec<GraphPass> = passes.iter().filter(is_reader).cloned().collect();
    for reader in readers {
        let is_model = reader.phase <= RenderPhase::Mean;
        let path = &reader.desc.stage;
        let mut open: Vec<usize> = images(&reader.inputs).filter_map(|name| index.get(name).copied()).collect();
        while let Some(at) = open.pop() {
            let pass = &mut passes[at];
            let refusal = if pass.phase == RenderPhase::Display {
                Some("it comes after the tone map")
            } else if is_model && pass.desc.to_picture() {
                Some("the model is drawn after it, so it cannot change the picture")
            } else if is_model && pass.inputs.values().any(|input| matches!(input, Input::Picture | Input::Depth)) {
                Some("the model is drawn after it, so there is no `picture` and no `depth` yet")
            } else {
                None
            };
            if let Some(reason) = refusal {
                let message = format!("{path} needs the image of the pass `{}`, but {reason}", pass.name());
                let error = pass.desc.place.error_at(pass.name(), message);
                errors.push(error.with_help("a pass with draw=model can draw depth and normals before the model"));
                continue;
            }
            if is_model && pass.phase != RenderPhase::BeforeModel {
                pass.phase = RenderPhase::BeforeModel;
                open.extend(needs(pass, index));
            }
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Moves the compute passes whose buffers the model, the background or quads read before the model, with the passes that they
/// need, unless one of them reads the picture of this frame: then the model reads what they wrote in the previous frame.
fn put_writers_before_model(passes: &mut [GraphPass], index: &BTreeMap<String, usize>) {
    let is_read = |at: &usize| {
        let mut readers = passes
            .iter()
            .filter(|pass| matches!(pass.phase, RenderPhase::Model | RenderPhase::Resolve | RenderPhase::Mean));
        readers.any(|reader| writes_buffer_of(&passes[*at], reader))
    };
    let writers: Vec<usize> = (0..passes.len()).filter(is_read).collect();
    for writer in writers {
        // Compute passes with a common buffer stay together.
        let beside = |at: usize| -> Vec<usize> {
            let shares = |other: &usize| {
                let [one, other] = [&passes[at], &passes[*other]];
                one.is_compute && other.is_compute && !buffers(one, |_| true).is_disjoint(&buffers(other, |_| true))
            };
            (0..passes.len()).filter(shares).collect()
        };
        let needed = reached(writer, |at| [needs(&passes[at], index), beside(at)].concat());
        let can_be_first = |at: &usize| {
            let pass = &passes[*at];
            let reads_picture = pass.inputs.values().any(|input| matches!(input, Input::Picture | Input::Depth));
            pass.phase == RenderPhase::BeforeModel
                || (pass.phase == RenderPhase::Light && !pass.desc.to_picture() && !reads_picture)
        };
        if needed.iter().all(can_be_first) {
            needed.into_iter().for_each(|at| passes[at].phase = RenderPhase::BeforeModel);
        }
    }
}

/// The names of the buffers of a pass for which `is_wanted` returns true when called with whether the pass may write them.
fn buffers(pass: &GraphPass, is_wanted: impl Fn(bool) -> bool) -> BTreeSet<&str> {
    let name = |input| match input {
        &Input::Buffer(ref name, _, is_written) if is_wanted(is_written) => Some(name.as_str()),
        _ => None,
    };
    pass.inputs.values().filter_map(name).collect()
}

/// Whether a compute pass writes a buffer that another pass only reads.
fn writes_buffer_of(pass: &GraphPass, reader: &GraphPass) -> bool {
    pass.is_compute && !buffers(pass, |is_written| is_written).is_disjoint(&buffers(reader, |is_written| !is_written))
}

/// A pass, and all passes that `next` reaches from it.
fn reached(from: usize, next: impl Fn(usize) -> Vec<usize>) -> BTreeSet<usize> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(at) = open.pop() {
        if found.insert(at) {
            open.extend(next(at));
        }
    }
    found
}

/// The passes that a pass depends on: those of the images that it reads, and that of `after=`.
fn needs(pass: &GraphPass, index: &BTreeMap<String, usize>) -> Vec<usize> {
    let names = pass.desc.after.as_deref().into_iter().chain(images(&pass.inputs));
    names.filter_map(|name| index.get(name).copied()).collect()
}

/// The names of the images of this frame that are read.
fn images(inputs: &Inputs) -> impl Iterator<Item = &str> {
    inputs.values().filter_map(|input| match input {
        Input::Image(name) => Some(name.as_str()),
        _ => None,
    })
}

fn unknown_after(pass: &GraphPass, index: &BTreeMap<String, usize>) -> Option<Diagnostic> {
    let name = pass.desc.after.as_deref()?;
    if name == pass.name() {
        let error = pass.desc.place.error_at("after=", format!("the pass `{name}` cannot come after itself"));
        return Some(error.with_help("leave out after=: the order follows from what a pass reads"));
    }
    if name == TONEMAP || index.contains_key(name) {
        return None;
    }
    let known: Vec<&str> = index.keys().map(String::as_str).filter(|known| *known != pass.name()).collect();
    let hint = did_you_mean(name, known.iter().copied());
    let error = pass.desc.place.error_at("after=", format!("no pass is named `{name}`.{hint}"));
    Some(error.with_help(format!("there are {}", known.join(", "))))
}

/// An error if a pass is drawn in an earlier phase than the pass that its `after=` names.
fn after_later(pass: &GraphPass, passes: &[GraphPass], index: &BTreeMap<String, usize>) -> Option<Diagnostic> {
    let other = &passes[*index.get(pass.desc.after.as_deref()?)?];
    if other.phase <= pass.phase {
        return None;
    }
    let when = match pass.phase {
        RenderPhase::BeforeModel => "before the model, which reads its image",
        RenderPhase::Model => "with the model",
        _ => "before the tone map",
    };
    let message = format!("`{}` is drawn {when}, so it cannot come after `{}`", pass.name(), other.name());
    Some(pass.desc.place.error_at("after=", message))
}

#[derive(Clone, Copy, PartialEq)]
enum VisitState {
    New,
    Open,
    Done,
}

struct Order<'a> {
    passes: &'a [GraphPass],
    index: &'a BTreeMap<String, usize>,
    state: Vec<VisitState>,
    done: Vec<usize>,
}

impl Order<'_> {
    /// Appends a pass to the order, after all passes that it depends on. `path`: the passes that wait for it.
    fn emit(&mut self, at: usize, path: &mut Vec<usize>) -> Result<(), Box<Diagnostic>> {
        match self.state[at] {
            VisitState::Done => return Ok(()),
            VisitState::Open => return Err(self.cycle(at, path)),
            VisitState::New => self.state[at] = VisitState::Open,
        }
        path.push(at);
        let pass = &self.passes[at];
        for need in needs(pass, self.index) {
            self.emit(need, path)?;
        }
        // Compute passes that write a buffer come before its readers, except those that wait for the reader.
        let writers = (0..self.passes.len()).filter(|other| self.passes[*other].phase == pass.phase);
        for writer in writers.filter(|writer| *writer != at && writes_buffer_of(&self.passes[*writer], pass)) {
            let waits = reached(writer, |at| needs(&self.passes[at], self.index));
            if waits.iter().all(|need| self.state[*need] != VisitState::Open) {
                self.emit(writer, path)?;
            }
        }
        path.pop();
        self.state[at] = VisitState::Done;
        self.done.push(at);
        Ok(())
    }

    fn cycle(&self, at: usize, path: &[usize]) -> Box<Diagnostic> {
        let start = path.iter().position(|open| *open == at).unwrap_or(0);
        let names: Vec<&str> = path[start..].iter().chain([&at]).map(|at| self.passes[*at].name()).collect();
        let pass = &self.passes[at];
        let message = format!("each of these passes waits for the next: {}", names.join(" -> "));
        let error = pass.desc.place.error_at(pass.name(), message);
        let help = format!("let one of them read an image of the frame before, `before_{}`", pass.name());
        Box::new(error.with_help(help))
    }
}
