//! The drawing order of passes.

use std::collections::BTreeMap;

use super::{GraphPass, Input};
use crate::message::did_you_mean;
use crate::shader::annotation::pass::TONEMAP;
use crate::shader::diagnostic::Diagnostic;

/// Sorts passes into the order in which they are drawn.
///
/// # Errors
/// An unknown name in `after=`, or a cycle.
pub fn ordered(mut passes: Vec<GraphPass>) -> Result<Vec<GraphPass>, Vec<Diagnostic>> {
    passes.sort_by(|a, b| a.name().cmp(b.name()));
    let index: BTreeMap<String, usize> =
        passes.iter().enumerate().map(|(index, pass)| (pass.name().to_owned(), index)).collect();
    let unknown: Vec<Diagnostic> = passes.iter().filter_map(|pass| unknown_after(pass, &index)).collect();
    if !unknown.is_empty() {
        return Err(unknown);
    }
    // A pass that reads the image of a pass after the tone map, or follows such a pass, also runs after the tone map.
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for at in 0..passes.len() {
            let follows = |name: &str| name == TONEMAP || index.get(name).is_some_and(|at| passes[*at].after_tonemap);
            let reads = passes[at].inputs.iter().any(|input| matches!(input, Input::Image(name) if follows(name)));
            let after = passes[at].note.after.as_deref().is_some_and(follows);
            if (reads || after) && !passes[at].after_tonemap {
                passes[at].after_tonemap = true;
                changed = true;
            }
        }
    }
    let mut order = Order { passes: &passes, index: &index, state: vec![State::New; passes.len()], done: Vec::new() };
    for after_tonemap in [false, true] {
        let in_part = |at: &usize| passes[*at].after_tonemap == after_tonemap;
        let (makers, others): (Vec<usize>, Vec<usize>) =
            (0..passes.len()).filter(in_part).partition(|at| passes[*at].note.to_picture);
        for at in makers.into_iter().chain(others) {
            order.emit(at, &mut Vec::new()).map_err(|error| vec![*error])?;
        }
    }
    let done = order.done;
    let mut passes: Vec<Option<GraphPass>> = passes.into_iter().map(Some).collect();
    Ok(done.into_iter().filter_map(|at| passes[at].take()).collect())
}

fn unknown_after(pass: &GraphPass, index: &BTreeMap<String, usize>) -> Option<Diagnostic> {
    let name = pass.note.after.as_deref()?;
    if name == TONEMAP || index.contains_key(name) {
        return None;
    }
    let known: Vec<&str> = index.keys().map(String::as_str).chain([TONEMAP]).collect();
    let hint = did_you_mean(name, known.iter().copied());
    let error = pass.note.place.error(format!("no pass is named `{name}`.{hint}"));
    Some(error.with_help(format!("there are {}", known.join(", "))))
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done,
}

struct Order<'a> {
    passes: &'a [GraphPass],
    index: &'a BTreeMap<String, usize>,
    state: Vec<State>,
    done: Vec<usize>,
}

impl Order<'_> {
    /// Appends a pass to the order, after all passes that it needs. `path`: the passes that wait for it.
    fn emit(&mut self, at: usize, path: &mut Vec<usize>) -> Result<(), Box<Diagnostic>> {
        match self.state[at] {
            State::Done => return Ok(()),
            State::Open => return Err(self.cycle(at, path)),
            State::New => self.state[at] = State::Open,
        }
        path.push(at);
        let pass = &self.passes[at];
        let read = pass.inputs.iter().filter_map(|input| match input {
            Input::Image(name) => Some(name.as_str()),
            _ => None,
        });
        let needs: Vec<usize> = pass
            .note
            .after
            .as_deref()
            .into_iter()
            .chain(read)
            .filter_map(|name| self.index.get(name).copied())
            .collect();
        for need in needs {
            self.emit(need, path)?;
        }
        path.pop();
        self.state[at] = State::Done;
        self.done.push(at);
        Ok(())
    }

    fn cycle(&self, at: usize, path: &[usize]) -> Box<Diagnostic> {
        let start = path.iter().position(|open| *open == at).unwrap_or(0);
        let names: Vec<&str> = path[start..].iter().chain([&at]).map(|at| self.passes[*at].name()).collect();
        let pass = &self.passes[at];
        let error = pass.note.place.error(format!("each of these passes waits for the next: {}", names.join(" -> ")));
        let help = format!(
            "let one of them read an image of the frame before: `keep` in its //@pass, and `before_{}`",
            pass.name()
        );
        Box::new(error.with_help(help))
    }
}
