//! Which of a pixel's fragments, calls, rounds and times the values are of.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::rounds::{Round, TracedLoop, traced_loops};
use crate::shader::trace::{
    Act, Doing, Done, Event, LineOfTrace, Numbered, Trace, Which, is_related, last_call, light_of, paths_to,
};

/// The choice among what happened at a pixel.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::app) struct Choice {
    /// From 0 for the nearest; `None` for the one that is seen.
    pub(in crate::app) fragment: Option<usize>,
    /// The path of a call, as `shade > add_light [light 2]`: it, the calls that led to it, and those that it makes. `None` for all.
    pub(in crate::app) call: Option<String>,
    /// The round of a loop, of those in the traced file. What is outside of the loop stays. `None` for all.
    pub(in crate::app) round: Option<Round>,
    /// Of a statement that ran more than once, the time that counts, from 1. `None` for all.
    pub(in crate::app) time: Option<usize>,
}

impl Choice {
    /// The fragment of a trace.
    pub(in crate::app) fn fragment_of(&self, trace: &Trace) -> Option<usize> {
        self.fragment.filter(|fragment| *fragment < trace.fragments.len()).or_else(|| trace.visible())
    }

    /// The chosen call, if the fragment has it.
    pub(in crate::app) fn call_of(&self, trace: &Trace, fragment: usize) -> Option<&str> {
        let call = self.call.as_deref()?;
        calls(trace, fragment).iter().any(|of| paths_to(of).any(|path| path == call)).then_some(call)
    }

    /// The chosen round, if the fragment has it.
    fn round_of(&self, trace: &Trace, fragment: usize, text: &str) -> Option<(TracedLoop, u32)> {
        let Round { line, number } = self.round?;
        let found = traced_loops(trace, fragment, text, None).into_iter().find(|of| of.line == line)?;
        found.rounds.iter().any(|(of, _)| *of == number).then_some((found, number))
    }

    /// The lines of the chosen fragment, call, round and time. `text`: that of the traced file.
    pub(in crate::app) fn lines(&self, trace: &Trace, text: &str) -> Vec<LineOfTrace> {
        let Some(fragment) = self.fragment_of(trace) else { return Vec::new() };
        let call = self.call_of(trace, fragment);
        let round = self.round_of(trace, fragment, text);
        // The time of the first event of each statement in the chosen call and round.
        let mut first: HashMap<Arc<Doing>, u32> = HashMap::new();
        let mut events = 0..;
        trace.lines_where(fragment, |event| {
            let at = events.next().unwrap_or_default();
            let is_of_round = round.as_ref().is_none_or(|(of, number)| of.is_shown(at, *number));
            if !is_of_round || call.is_some_and(|call| !is_related(&event.calls, call)) {
                return false;
            }
            let Some(chosen) = self.time else { return true };
            let first = *first.entry(event.doing.clone()).or_insert(event.time);
            chosen == (event.time - first + 1) as usize
        })
    }
}

impl Choice {
    /// Which of the values of a statement counts at any pixel, as long as it has the chosen call.
    pub(in crate::app) fn which(&self) -> Which<'_> {
        Which { call: self.call.as_deref(), time: self.time }
    }

    /// The number of the evaluation, from 1, whose value is shown last for a statement. 0 without a choice: the last one counts.
    pub(in crate::app) fn evaluation(&self, shown: &Done) -> u32 {
        let is_chosen = self.call.is_some() || self.round.is_some() || self.time.is_some();
        let last = shown.last.last().or(shown.first.last()).filter(|_| is_chosen);
        last.map_or(0, |once| once.time)
    }
}

/// The events of a line's statements in a fragment for which `is_it` holds, in order.
fn events_of<'a>(
    trace: &'a Trace,
    fragment: usize,
    (file, line): (&'a str, u32),
    is_it: impl Fn(&Doing) -> bool + 'a,
) -> impl Iterator<Item = &'a Event> {
    let events = trace.fragments.get(fragment).into_iter().flat_map(|fragment| &fragment.events);
    events.filter(move |event| event.doing.file == file && event.doing.line == line && is_it(&event.doing))
}

/// The evaluations of an expression in a fragment, in order, with their numbers from 1: the values that a line gave to a variable, or returned
/// for `return`.
pub(in crate::app) fn evaluations<'a>(
    trace: &'a Trace,
    fragment: usize,
    place: (&'a str, u32),
    expression: &'a str,
) -> Vec<(u32, &'a Event)> {
    let is_it = move |doing: &Doing| match doing.act {
        Act::Store | Act::Argument => doing.name == expression,
        Act::Return => expression == "return",
        Act::Condition | Act::Discard | Act::Leave => false,
    };
    // A line may give a value to an argument and store to it.
    let (mut last, mut number): (HashMap<&Doing, u32>, u32) = (HashMap::new(), 0);
    let numbered = events_of(trace, fragment, place, is_it).map(|event| {
        number += event.time - last.insert(&*event.doing, event.time).unwrap_or(0);
        (number, event)
    });
    numbered.collect()
}

/// The paths of calls in a fragment, in their order.
pub(in crate::app) fn calls(trace: &Trace, fragment: usize) -> Vec<Arc<str>> {
    let events = trace.fragments.get(fragment).into_iter().flat_map(|fragment| &fragment.events);
    let mut numbered = Numbered::default();
    let first = events.filter(|event| !event.calls.is_empty() && numbered.of(&event.calls).1);
    first.map(|event| event.calls.clone()).collect()
}

/// A call in the list of those of a fragment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct ListedCall {
    pub(in crate::app) path: String,
    /// Calls that led to it.
    pub(in crate::app) depth: usize,
    /// Its function, with the number of the call or of its light.
    pub(in crate::app) name: String,
    /// The index of the light that it is about.
    pub(in crate::app) light: Option<usize>,
    /// Whether a `return` without a value ended it before its end: it may have left out what it is for.
    pub(in crate::app) is_cut: bool,
    /// The last value that it stored or returned itself, as `irradiance = 1 2 3`; may be empty. It tells calls apart, as those for lights.
    pub(in crate::app) last: String,
}

/// The calls in a fragment and those that led to them, in the order of execution: each behind the one that made it.
pub(in crate::app) fn listed_calls(trace: &Trace, fragment: usize) -> Vec<ListedCall> {
    let mut listed: Vec<ListedCall> = Vec::new();
    let all = trace.fragments.get(fragment).into_iter().flat_map(|fragment| &fragment.events);
    let cut: HashSet<&str> =
        all.clone().filter(|event| event.doing.act == Act::Leave).map(|event| &*event.calls).collect();
    let has_value = |event: &&Event| matches!(event.doing.act, Act::Store | Act::Return);
    let last: HashMap<&str, String> =
        all.filter(has_value).filter_map(|event| Some((&*event.calls, last_text(event)?))).collect();
    for path in calls(trace, fragment).iter().flat_map(|path| paths_to(path)) {
        if listed.iter().any(|known| known.path == path) {
            continue;
        }
        let (name, depth) = last_call(path);
        let light = light_of(name).and_then(|number| number.checked_sub(1));
        let (is_cut, last) = (cut.contains(path), last.get(path).cloned().unwrap_or_default());
        let call = ListedCall { path: path.to_owned(), depth, name: name.to_owned(), light, is_cut, last };
        let caller = depth.checked_sub(1).and_then(|depth| paths_to(path).nth(depth));
        let is_within = |known: &ListedCall| caller.is_none_or(|caller| paths_to(&known.path).any(|of| of == caller));
        let end = listed.iter().rposition(is_within).map_or(0, |at| at + 1);
        listed.insert(end, call);
    }
    listed
}

fn last_text(event: &Event) -> Option<String> {
    let value = event.value?.text();
    let Doing { act, name, .. } = &*event.doing;
    Some(if *act == Act::Return { format!("returns{name} {value}") } else { format!("{name} = {value}") })
}

/// How often the statement ran that ran most often in the chosen call and round.
pub(in crate::app) fn most_times(choice: &Choice, trace: &Trace, text: &str) -> usize {
    let all = Choice { time: None, ..choice.clone() };
    all.lines(trace, text).iter().flat_map(|line| &line.done).map(|done| done.count).max().unwrap_or(0)
}
