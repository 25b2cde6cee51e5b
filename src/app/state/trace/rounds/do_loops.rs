//! The rounds of `do ... while`. A round begins with the body, which no condition announces, and ends with the condition, or by `break`, `return` or `discard`.

use super::loops::{Loop, TracedLoop, label};
use crate::shader::trace::{Doing, Event, is_related, paths_to};

/// A round that is under way.
struct UnderWay<'a> {
    /// The call of the loop.
    calls: &'a str,
    /// The events so far.
    events: Vec<usize>,
    /// The first statement of the body.
    first: &'a Doing,
}

impl Loop<'_> {
    /// Divides the events of a fragment. A round has the number of the evaluation of the condition that ends it, and one that ends
    /// without it a number behind all of those.
    pub(super) fn traced_do(self, events: &[Option<&Event>], call: Option<&str>) -> TracedLoop {
        let mut owners: Vec<Option<u32>> = vec![None; events.len()];
        let mut rounds: Vec<(u32, String)> = Vec::new();
        let is_wanted = |calls: &str| call.is_none_or(|call| is_related(calls, call));
        let leave = |left: &UnderWay<'_>, owners: &mut Vec<Option<u32>>, rounds: &mut Vec<(u32, String)>| {
            if left.events.is_empty() {
                return;
            }
            let number = u32::MAX - rounds.len() as u32;
            left.events.iter().for_each(|at| owners[*at] = Some(number));
            if is_wanted(left.calls) {
                rounds.push((number, label(&[], events, rounds.len() + 1)));
            }
        };
        let mut now: Option<UnderWay<'_>> = None;
        let mut last = 0;
        for (at, event) in events.iter().enumerate().filter_map(|(at, event)| Some((at, (*event)?))) {
            if let Some(left) = now.take_if(|now| !self.is_inside(event, now.calls)) {
                leave(&left, &mut owners, &mut rounds);
            }
            if now.is_none() && self.lines.contains(&event.doing.line) {
                let calls = &*event.calls;
                now = Some(UnderWay { calls, events: called_before(events, at, calls), first: &event.doing });
            }
            let Some(round) = &mut now else { continue };
            round.events.push(at);
            if !self.is_condition(event) || *event.calls != *round.calls {
                continue;
            }
            // Behind rounds that were not logged, this one begins where the body did last.
            let is_first = |at: &usize| events[*at].is_some_and(|event| *event.doing == *round.first);
            let begin = match event.time > last + 1 {
                true => round.events.iter().rposition(is_first).unwrap_or(round.events.len() - 1),
                false => 0,
            };
            last = event.time;
            round.events[..begin].iter().for_each(|at| owners[*at] = Some(0));
            round.events[begin..].iter().for_each(|at| owners[*at] = Some(event.time));
            if is_wanted(round.calls) {
                rounds.push((event.time, label(&[], events, rounds.len() + 1)));
            }
            round.events.clear();
            if event.value.is_none_or(|value| value.numbers().all(|number| number == 0.0)) {
                now = None;
            }
        }
        // The last statement of all was in the loop.
        if let Some(left) = now {
            leave(&left, &mut owners, &mut rounds);
        }
        TracedLoop { line: *self.lines.start(), code: self.code, rounds, owners }
    }
}

/// The events of calls that a call made directly before an event: of the first statement of a body.
fn called_before(events: &[Option<&Event>], at: usize, calls: &str) -> Vec<usize> {
    let is_below = |of: &str| calls.is_empty() || paths_to(of).any(|path| path == calls);
    let is_called = |event: &Event| *event.calls != *calls && is_below(&event.calls);
    let before = events[..at].iter().enumerate().rev().filter_map(|(at, event)| Some((at, (*event)?)));
    let mut found: Vec<usize> = before.take_while(|(_, event)| is_called(event)).map(|(at, _)| at).collect();
    found.reverse();
    found
}

#[cfg(test)]
mod tests {
    use super::super::loops::{ends_of_do, loops};
    use super::*;
    use crate::shader::trace::Act;
    use crate::shader::trace::sample::{called, trace};

    const TEXT: &str = "float f(float x) {\n    float s = g(x);\n    do {\n        s = g(s);\n        if (s > 5.0)\n            break;\n    \
        } while (s < 9.0);\n    return s;\n}\nfloat g(float x) {\n    return x + 1.0;\n}\n";

    /// The return of `g`, the store of its result, and whether the loop breaks.
    fn body(calls: &str, s: f32, breaks: bool) -> [Event; 3] {
        let of_g = called(&format!("{calls} > g"), 11, Act::Return, "", &[s]);
        [of_g, called(calls, 4, Act::Store, "s", &[s]), called(calls, 5, Act::Condition, "", &[f32::from(breaks)])]
    }

    fn condition(calls: &str, goes_on: bool) -> Event {
        called(calls, 7, Act::Condition, "", &[f32::from(goes_on)])
    }

    /// The rounds of the only loop of a text. The events follow each other, with times.
    fn traced(text: &str, events: Vec<Event>, call: Option<&str>) -> TracedLoop {
        let trace = trace(events, &[]);
        let events: Vec<Option<&Event>> = trace.fragments[0].events.iter().map(Some).collect();
        let [of] = loops(text).try_into().unwrap_or_else(|_| panic!("{text} has another number of loops"));
        of.traced_do(&events, call)
    }

    #[test]
    fn a_round_begins_with_the_body_and_ends_with_the_condition_or_by_break() {
        let mut events = Vec::new();
        for calls in ["f", "f [2]"] {
            events.push(called(calls, 2, Act::Store, "s", &[0.0]));
            events.extend(body(calls, 1.0, false));
            events.push(condition(calls, true));
            events.extend(body(calls, 2.0, calls == "f"));
            if calls != "f" {
                events.push(condition(calls, false));
            }
            events.push(called(calls, 8, Act::Return, "", &[2.0]));
        }
        let found = traced(TEXT, events.clone(), None);
        assert_eq!((found.line, found.code.as_str()), (3, "do … while (s < 9.0)"));
        let numbers: Vec<u32> = found.rounds.iter().map(|(number, _)| *number).collect();
        assert_eq!(numbers, [1, u32::MAX - 1, 2, 3]);
        assert_eq!(
            found.rounds.iter().map(|(_, label)| label.as_str()).collect::<Vec<_>>(),
            ["round 1", "round 2", "round 3", "round 4"]
        );
        let broken = Some(u32::MAX - 1);
        let first = [None, Some(1), Some(1), Some(1), Some(1), broken, broken, broken, None];
        assert_eq!(found.owners[..9], first);
        let second = [None, Some(2), Some(2), Some(2), Some(2), Some(3), Some(3), Some(3), Some(3), None];
        assert_eq!(found.owners[9..], second);
        let of_call = traced(TEXT, events, Some("f [2]"));
        assert_eq!(of_call.rounds.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(ends_of_do(TEXT), [7]);
    }

    /// Rounds 3 to 7 were not logged, but a statement that ran in round 5 alone was.
    #[test]
    fn what_ran_in_rounds_that_were_not_logged_belongs_to_none() {
        let text = "float f(float x) {\n    do {\n        x += 1.0;\n        if (x > 2.0) rare = 1.0;\n    } while (x < 9.0);\n    return x;\n}\n";
        let of = |line: u32, act: Act, name: &str, time: u32| Event { time, ..called("f", line, act, name, &[1.0]) };
        let round = |time: u32| [of(3, Act::Store, "x", time), of(5, Act::Condition, "", time)];
        let mut events = [round(1), round(2)].concat();
        events.push(of(4, Act::Store, "rare", 1));
        events.extend([round(8), round(9)].concat());
        let found = traced(text, events, None);
        assert_eq!(found.rounds.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [1, 2, 8, 9]);
        let owners = [1, 1, 2, 2, 0, 8, 8, 9, 9].map(Some);
        assert_eq!(found.owners, owners);
    }

    /// A `return` in a loop of `main`, behind which nothing was logged, after a call that nothing came before.
    #[test]
    fn a_round_ends_with_the_last_statement_of_all() {
        let text = "void main() {\n    do {\n        s = g(s);\n        if (s > 2.0) return;\n    } while (true);\n}\nfloat g(float x) {\n    \
            return x;\n}\n";
        let of_g = |calls: &str| called(calls, 8, Act::Return, "", &[1.0]);
        let own = |line: u32, act: Act, name: &str| called("", line, act, name, &[1.0]);
        let round = |calls: &str| [of_g(calls), own(3, Act::Store, "s"), own(4, Act::Condition, "")];
        let mut events = round("g").to_vec();
        events.push(own(5, Act::Condition, ""));
        events.extend(round("g [2]"));
        let found = traced(text, events, None);
        let left = u32::MAX - 1;
        assert_eq!(found.rounds.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [1, left]);
        assert_eq!(found.owners, [1, 1, 1, 1, left, left, left].map(Some));
    }

    #[test]
    fn a_condition_on_the_line_of_the_loops_own_hides_its_rounds() {
        for (text, count) in [
            ("void f() { do { if (a) b(); } while (c); }", 0),
            ("void f() {\n do {\n a();\n } while (c); if (d) e();\n}", 0),
            ("void f() {\n if (a) b(); for (;;)\n c();\n}", 0),
            ("void f() {\n do\n  for (;;) a();\n while (c); }", 2),
        ] {
            assert_eq!(loops(text).len(), count, "{text}");
        }
    }
}
