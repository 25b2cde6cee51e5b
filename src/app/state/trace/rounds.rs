//! The rounds of a file's loops at a pixel: one can be chosen, so that its values stand beside the code.

mod do_loops;
mod loops;

use crate::shader::trace::{Act, Event, Trace, is_related};
pub(in crate::app) use loops::TracedLoop;
pub(super) use loops::ends_of_do;
use loops::{Loop, label, loops};

/// A round of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) struct Round {
    /// The first line of the loop in the traced text, from 1.
    pub(in crate::app) line: u32,
    /// Which evaluation of the loop's condition begins the round, from 1. See [`do_loops`] for loops that begin with their body.
    pub(in crate::app) number: u32,
}

/// The loops of the traced file, whose text this is, in a fragment. `call`: only rounds of this call, of those that led to it, and of those
/// that it makes.
pub(in crate::app) fn traced_loops(trace: &Trace, fragment: usize, text: &str, call: Option<&str>) -> Vec<TracedLoop> {
    let (Some(fragment), Some(file)) = (trace.fragments.get(fragment), trace.files().next()) else { return Vec::new() };
    let events: Vec<Option<&Event>> = fragment.events.iter().map(|of| (of.doing.file == file).then_some(of)).collect();
    let traced =
        loops(text).into_iter().map(|of| if of.is_do { of.traced_do(&events, call) } else { of.traced(&events, call) });
    traced.filter(|traced| !traced.rounds.is_empty()).collect()
}

impl Loop<'_> {
    /// Divides the events of a fragment.
    fn traced(self, events: &[Option<&Event>], call: Option<&str>) -> TracedLoop {
        let mut owners: Vec<Option<u32>> = vec![None; events.len()];
        let mut rounds = Vec::new();
        // The round that is under way, and what has been stored to variables of the header since its condition.
        let (mut now, mut stored): (Option<(u32, &str)>, Vec<usize>) = (None, Vec::new());
        for (at, event) in events.iter().enumerate().filter_map(|(at, event)| Some((at, (*event)?))) {
            if self.is_condition(event) {
                let goes_on = event.value.is_some_and(|value| value.numbers().any(|number| number != 0.0));
                let number = if goes_on { event.time } else { 0 };
                stored.retain(|at| events[*at].is_some_and(|of| of.calls == event.calls));
                owners[at] = Some(number);
                for (place, at) in stored.iter().enumerate() {
                    // A later value is of a round that was not logged.
                    let name = |at: &usize| events[*at].map(|event| &event.doing);
                    let is_last = !stored[place + 1..].iter().any(|later| name(later) == name(at));
                    owners[*at] = Some(if is_last { number } else { 0 });
                }
                now = goes_on.then_some((number, &*event.calls));
                if goes_on && call.is_none_or(|call| is_related(&event.calls, call)) {
                    rounds.push((number, label(&stored, events, rounds.len() + 1)));
                }
                stored.clear();
                continue;
            }
            let is_ours = now.is_none_or(|(_, calls)| *calls == *event.calls);
            if self.is_of_header(event) && is_ours {
                stored.push(at);
                owners[at] = now.map(|_| 0);
            } else if let Some((number, calls)) = now {
                if self.is_inside(event, calls) {
                    // Behind the header, a round follows of which no condition was logged.
                    owners[at] = Some(if stored.is_empty() { number } else { 0 });
                } else {
                    (now, stored) = (None, Vec::new());
                }
            }
        }
        TracedLoop { line: *self.lines.start(), code: self.code, rounds, owners }
    }

    /// Whether an event stores to a variable of the header.
    fn is_of_header(&self, event: &Event) -> bool {
        let doing = &event.doing;
        let variable = doing.name.split(['.', '[']).next().unwrap_or_default();
        doing.act == Act::Store && self.header.contains(&doing.line) && self.words.contains(&variable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::trace::sample::{called, trace};

    const TEXT: &str = "float f(float x) {\n    for (int i = 0, k = 9; i < 9; ++i, --k) {\n        x += g(x);\n        if (x > 5.0)\n            \
        break;\n    }\n    while (x < 3.0)\n        x += 1.0;\n    for (int j = 0; j < 2; ++j) if (x > 0.0) x = 1.0;\n    return x;\n}\n\
        float g(float x) {\n    return x;\n}\n";

    /// Two rounds of the first loop, of which the second breaks, and one of the second.
    fn events(calls: &str) -> Vec<Event> {
        let event = |line: u32, act: Act, name: &str, number: f32| called(calls, line, act, name, &[number]);
        let header = |i: f32, k: f32| [event(2, Act::Store, "i", i), event(2, Act::Store, "k", k)];
        let round = |x: f32, breaks: f32| {
            let of_g = called(&format!("{calls} > g"), 13, Act::Return, "", &[x]);
            let condition = event(2, Act::Condition, "", 1.0);
            [condition, of_g, event(3, Act::Store, "x", 2.0 * x), event(4, Act::Condition, "", breaks)]
        };
        let mut all = header(0.0, 9.0).to_vec();
        all.extend(round(1.0, 0.0));
        all.extend(header(1.0, 8.0));
        all.extend(round(2.0, 1.0));
        all.extend([
            event(7, Act::Condition, "", 1.0),
            event(8, Act::Store, "x", 7.0),
            event(7, Act::Condition, "", 0.0),
        ]);
        all.extend([
            event(9, Act::Condition, "", 1.0),
            event(9, Act::Condition, "", 1.0),
            event(10, Act::Return, "", 7.0),
        ]);
        all
    }

    #[test]
    fn rounds_have_the_values_of_their_variables() {
        let trace = trace([events("f"), events("f [2]")].concat(), &[2, 3, 4, 5, 7, 8, 9, 10, 13]);
        let found = traced_loops(&trace, 0, TEXT, None);
        let told: Vec<_> = found.iter().map(|of| (of.line, of.code.as_str(), of.rounds.clone())).collect();
        let rounds =
            |all: &[(u32, &str)]| all.iter().map(|(number, label)| (*number, (*label).to_owned())).collect::<Vec<_>>();
        let first = [(1, "i = 0, k = 9"), (2, "i = 1, k = 8"), (3, "i = 0, k = 9"), (4, "i = 1, k = 8")];
        // Of the third loop, the condition cannot be told from that of its body.
        let expected = [
            (2, "for (int i = 0, k = 9; i < 9; ++i, --k)", rounds(&first)),
            (7, "while (x < 3.0)", rounds(&[(1, "round 1"), (3, "round 2")])),
        ];
        assert_eq!(told, expected);
        assert_eq!(traced_loops(&trace, 0, TEXT, Some("f [2]"))[0].rounds, rounds(&first[2..]));
        // The second round has its header, its condition, the call and what follows it, up to `break`.
        let shown: Vec<usize> = (0..17).filter(|at| found[0].is_shown(*at, 2)).collect();
        assert_eq!(shown, [6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);
        let shown: Vec<usize> = (0..17).filter(|at| found[0].is_shown(*at, 1)).collect();
        assert_eq!(shown, [0, 1, 2, 3, 4, 5, 12, 13, 14, 15, 16]);
        assert_eq!(
            (found[1].is_shown(13, 1), found[1].is_shown(13, 3), found[1].is_shown(14, 1)),
            (true, false, false)
        );
    }

    /// Rounds 3 to 7 were not logged, but a statement that ran in round 5 alone was.
    #[test]
    fn what_ran_in_rounds_that_were_not_logged_belongs_to_none() {
        let text = "float f(float x) {\n    for (int i = 0; i < 9; ++i)\n        x += 1.0;\n    return x;\n}\n";
        let of =
            |line: u32, act: Act, name: &str, time: u32| Event { time, ..called("f", line, act, name, &[time as f32]) };
        let round =
            |time: u32| [of(2, Act::Store, "i", time), of(2, Act::Condition, "", time), of(3, Act::Store, "x", time)];
        let mut events = [round(1), round(2)].concat();
        events.extend([of(2, Act::Store, "i", 3), of(3, Act::Store, "rare", 1)]);
        events.extend([round(8), round(9)].concat());
        let found = traced_loops(&trace(events, &[2, 3, 4]), 0, text, None);
        assert_eq!(found[0].rounds.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [1, 2, 8, 9]);
        assert_eq!((5..9).map(|at| found[0].owners[at]).collect::<Vec<_>>(), [Some(2), Some(0), Some(0), Some(8)]);
    }
}
