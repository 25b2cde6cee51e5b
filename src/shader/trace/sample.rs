//! Traces for tests.

use std::collections::{HashMap, HashSet};
use std::hash::Hash;
use std::sync::Arc;

use super::{Act, Doing, Event, Fragment, Target, Trace, TracedValue};
use crate::shader::StageKind;

/// An event in the file `a.glsl`, in the call `f`.
pub(crate) fn event(line: u32, act: Act, name: &str, numbers: &[f32]) -> Event {
    called("f", line, act, name, numbers)
}

/// An event in the file `a.glsl`, in a call.
pub(crate) fn called(calls: &str, line: u32, act: Act, name: &str, numbers: &[f32]) -> Event {
    let value = match numbers {
        [] => None,
        [number] => Some(TracedValue::float(*number)),
        numbers => Some(TracedValue::floats(numbers)),
    };
    let doing = Doing { file: "a.glsl".into(), line, act, name: name.into() };
    Event { doing: doing.into(), value, calls: calls.into(), time: 0 }
}

/// The value in a set that is the same; a new one is put there.
fn shared<T: ?Sized + Eq + Hash>(set: &mut HashSet<Arc<T>>, value: &Arc<T>) -> Arc<T> {
    let known = set.get(value).cloned();
    known.unwrap_or_else(|| {
        set.insert(value.clone());
        value.clone()
    })
}

/// A trace of one fragment, whose color is the picture's. These lines of `a.glsl` have statements. Events without a time follow the one before.
pub(crate) fn trace(mut events: Vec<Event>, statements: &[u32]) -> Trace {
    let (mut last, mut not_logged) = (HashMap::new(), 0);
    let (mut doings, mut calls): (HashSet<Arc<Doing>>, HashSet<Arc<str>>) = Default::default();
    for event in &mut events {
        // As a log has them.
        event.doing = shared(&mut doings, &event.doing);
        event.calls = shared(&mut calls, &event.calls);
        let last = last.entry(event.doing.clone()).or_insert(0);
        event.time = if event.time == 0 { *last + 1 } else { event.time };
        not_logged += event.time - *last - 1;
        *last = event.time;
    }
    let code = statements.iter().map(|line| (("a.glsl".to_owned(), *line), format!("line {line};")));
    let fragment =
        Fragment { depth: 0.5, vertex: None, samples: None, primitive: None, color: Some([0; 4]), events, not_logged };
    Trace {
        stage: "a.frag".into(),
        kind: StageKind::Fragment,
        fragments: vec![fragment],
        left_out: 0,
        target: Target::Picture,
        samples: 1,
        picture: [0; 4],
        redrawn: [0; 4],
        lights: Vec::new(),
        endless_loop: None,
        begins_anew: false,
        code: code.collect(),
    }
}
