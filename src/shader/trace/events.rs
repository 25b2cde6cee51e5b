//! The events of a log as what statements did.

use std::collections::HashMap;

use super::calls::Calls;
use super::elements::Elements;
use super::log::{LoggedEvent, LoggedFragment};
use super::{Act, Doing, Event, TracedStage, TracedValue};
use crate::shader::spirv::trace::Purpose;

/// The action of the statement of a log point. `None` for the begin of a function.
fn doing(stage: &TracedStage, number: u32) -> Option<Doing> {
    let point = stage.point(number)?;
    let place = stage.place(point);
    if place.line == 0 {
        return None;
    }
    let (act, name) = match &place.purpose {
        Purpose::Argument(name) => (Act::Argument, name.as_str()),
        Purpose::Store(name) => (Act::Store, name.as_str()),
        Purpose::Condition => (Act::Condition, ""),
        Purpose::Constant { .. } => return None,
        Purpose::Return => (Act::Return, ""),
        Purpose::Discard => (Act::Discard, ""),
        Purpose::Enter(..) | Purpose::Input(_) | Purpose::Use => return None,
    };
    Some(Doing { file: place.file.clone(), line: place.line, act, name: format!("{name}{}", point.part) })
}

/// What is known of the events of a statement.
#[derive(Default)]
struct Times {
    /// Those that were kept.
    kept: u32,
    /// Those that were not.
    lost: u32,
    /// How many were kept before the first that was not.
    before_lost: Option<u32>,
}

/// The events of a log, and how many between them were not logged.
pub(super) fn of(stage: &TracedStage, logged: &LoggedFragment) -> (Vec<Event>, u32) {
    let calls = Calls::new(&logged.calls, |number| match &stage.place(stage.point(number)?).purpose {
        Purpose::Enter(name, list) => Some((name.as_str(), *list)),
        _ => None,
    });
    let elements = Elements::new(stage, &logged.events);
    let mut times: HashMap<Doing, Times> = HashMap::new();
    let mut points: HashMap<u32, Option<Doing>> = HashMap::new();
    let event = |logged: &LoggedEvent| {
        let mut doing = points.entry(logged.point).or_insert_with(|| doing(stage, logged.point)).clone()?;
        elements.complete(&mut doing.name, logged);
        let of = times.entry(doing.clone()).or_default();
        of.kept += 1;
        if logged.lost > 0 {
            of.lost += logged.lost;
            of.before_lost.get_or_insert(of.kept);
        }
        let point = stage.point(logged.point)?;
        let value =
            (point.count > 0).then(|| TracedValue::new(point.kind, &logged.bits[..(point.count as usize).min(4)]));
        Some(Event { doing, value, calls: calls.path(logged.call), time: of.kept })
    };
    let mut events: Vec<Event> = logged.events.iter().filter_map(event).collect();
    for event in &mut events {
        if let Some(Times { lost, before_lost: Some(before), .. }) = times.get(&event.doing)
            && event.time > *before
        {
            event.time += lost;
        }
    }
    (events, times.values().map(|times| times.lost).sum())
}
