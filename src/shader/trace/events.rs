//! The trace of a log: its events as what statements did.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

use super::calls::Calls;
use super::elements::Elements;
use super::log::{LoggedEvent, LoggedFragment};
use super::{Act, Doing, Event, Fragment, Invocations, Target, Trace, TracedStage, TracedValue};
use crate::shader::PixelValue;
use crate::shader::spirv::trace::{INDEX, Purpose};

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
        Purpose::Leave => (Act::Leave, ""),
        Purpose::Enter(..) | Purpose::Input(_) | Purpose::Use => return None,
    };
    Some(Doing { file: place.file.clone(), line: place.line, act, name: format!("{name}{}", point.part) })
}

/// The numbers of the events of a statement.
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
fn of_fragment(stage: &TracedStage, logged: &LoggedFragment) -> (Vec<Event>, u32) {
    let calls = Calls::new(&logged.calls, |number| match &stage.place(stage.point(number)?).purpose {
        Purpose::Enter(name, list) => Some((name.as_str(), *list)),
        _ => None,
    });
    let elements = Elements::new(stage, &logged.events);
    let mut times: HashMap<Arc<Doing>, Times> = HashMap::new();
    let mut points: HashMap<u32, Option<Arc<Doing>>> = HashMap::new();
    let mut shared: HashSet<Arc<Doing>> = HashSet::new();
    let mut share = |doing: Doing| {
        let known = shared.get(&doing).cloned();
        known.unwrap_or_else(|| {
            let doing = Arc::new(doing);
            shared.insert(doing.clone());
            doing
        })
    };
    let event = |logged: &LoggedEvent| {
        let of_point = points.entry(logged.point).or_insert_with(|| Some(share(doing(stage, logged.point)?)));
        let mut doing = of_point.clone()?;
        if doing.name.contains(INDEX) {
            let mut named = Doing::clone(&doing);
            elements.complete(&mut named.name, logged);
            doing = share(named);
        }
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

impl Trace {
    /// The trace of a log that `stage` has written of these invocations. `picture` and `redrawn`: see the members.
    pub fn new(
        stage: &TracedStage,
        (of, target, samples): (Invocations, Target, u32),
        words: &[u32],
        picture: &PixelValue,
        redrawn: &PixelValue,
    ) -> Self {
        let bits = |pixel: &PixelValue| pixel.value.map(f32::to_bits);
        let (logged, left_out) = stage.layout().decode(words);
        let fragment = |logged: LoggedFragment| {
            let (events, not_logged) = of_fragment(stage, &logged);
            // As the pixel is read: without flags in alpha.
            let color = logged.color.map(|color| match target {
                Target::Picture => bits(&PixelValue::decode(color.map(f32::from_bits))),
                _ => color,
            });
            let (depth, vertex) = match of {
                Invocations::Pixel(..) => (f32::from_bits(logged.number), None),
                Invocations::Triangle(_) | Invocations::Quad(_) => (0.0, Some(logged.number)),
                Invocations::Compute(_) => (0.0, None),
            };
            let LoggedFragment { samples, primitive, .. } = logged;
            Fragment { depth, vertex, samples, primitive, color, events, not_logged }
        };
        let mut fragments: Vec<Fragment> = logged.into_iter().map(fragment).collect();
        // A device may draw them in any order.
        match of {
            Invocations::Triangle(corners) => sort_vertices(&mut fragments, &corners),
            Invocations::Quad(_) => sort_vertices(&mut fragments, &[0, 1, 2, 3, 4, 5]),
            Invocations::Pixel(..) | Invocations::Compute(_) => sort_fragments(&mut fragments),
        }
        let is_shown = |purpose: &Purpose| !matches!(purpose, Purpose::Enter(..));
        let places = stage.places().filter(|place| is_shown(&place.purpose));
        let lines: BTreeSet<(&str, u32)> = places.map(|place| (place.file.as_str(), place.line)).collect();
        let code = lines.into_iter().map(|(file, line)| ((file.to_owned(), line), stage.line(file, line)));
        Self {
            stage: stage.path().to_owned(),
            kind: stage.kind(),
            fragments,
            left_out,
            target,
            samples,
            picture: bits(picture),
            redrawn: bits(redrawn),
            lights: Vec::new(),
            endless_loop: None,
            begins_anew: false,
            code: code.collect(),
        }
    }

    /// Adds the fragments that the depth test has left out, from a draw of the pixel without that test.
    pub fn add_hidden(&mut self, all: Self) {
        if all.left_out > 0 {
            // Which of them the log has is a matter of chance, so they are only counted.
            let count = all.fragments.len() as u32 + all.left_out;
            self.left_out = self.left_out.max(count.saturating_sub(self.fragments.len() as u32));
            return;
        }
        let key = |of: &Fragment| (of.depth.to_bits(), of.primitive);
        let mut drawn: Vec<_> = self.fragments.iter().map(key).collect();
        let is_hidden = |of: &Fragment| match drawn.iter().position(|drawn| *drawn == key(of)) {
            Some(at) => {
                drawn.swap_remove(at);
                false
            }
            None => true,
        };
        self.fragments.extend(all.fragments.into_iter().filter(is_hidden));
        sort_fragments(&mut self.fragments);
    }
}

/// Sorts fragments by depth, the nearest first.
fn sort_fragments(fragments: &mut [Fragment]) {
    let order = |of: &Fragment| (of.color, of.primitive, of.samples);
    fragments.sort_by(|a, b| b.depth.total_cmp(&a.depth).then_with(|| order(a).cmp(&order(b))));
}

/// Sorts vertices by the corners of their triangle. A vertex is run again for each triangle that has it, with the same values.
fn sort_vertices(fragments: &mut Vec<Fragment>, corners: &[u32]) {
    let corner = |fragment: &Fragment| corners.iter().position(|corner| Some(*corner) == fragment.vertex);
    let mut kept: Vec<Fragment> = Vec::new();
    for fragment in std::mem::take(fragments) {
        if !kept.contains(&fragment) {
            kept.push(fragment);
        }
    }
    kept.sort_by_key(corner);
    *fragments = kept;
}
