//! A trace by lines of its sources, as text and JSON.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde_json::{Value, json};

use super::samples::{numbers, ulps};
use super::{Act, Doing, Event, Fragment, Numbered, Trace, TracedValue};

/// Values that are kept of each place from the begin, and from the end.
const MOST_KEPT: usize = 16;

/// A line of a source file, with what its statements did.
#[derive(Clone, Debug, PartialEq)]
pub struct LineOfTrace {
    /// The file, as the tree names it.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// The line itself, without the space around it.
    pub code: String,
    /// The actions, in order.
    pub done: Vec<Done>,
}

/// An action of a statement, once or more often.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// The kind of action.
    pub act: Act,
    /// The variable or parameter; empty for others.
    pub name: String,
    /// How often.
    pub count: usize,
    /// How often between the first and the last times that were logged.
    pub not_logged: usize,
    /// The first times.
    pub first: Vec<Once>,
    /// The last times, as far as they are not among the first.
    pub last: Vec<Once>,
}

/// One time that a statement did something.
#[derive(Clone, Debug, PartialEq)]
pub struct Once {
    /// The value; none for a discard and a return without one.
    pub value: Option<TracedValue>,
    /// The calls that led to it.
    pub calls: Arc<str>,
    /// Which time, from 1.
    pub time: u32,
}

impl Trace {
    /// The lines of a fragment, file by file in the order in which they were reached.
    pub fn lines(&self, fragment: usize) -> Vec<LineOfTrace> {
        self.lines_where(fragment, |_| true)
    }

    /// The same of the events that `is_shown` accepts. Those that were not logged count between two of these.
    pub fn lines_where(&self, fragment: usize, mut is_shown: impl FnMut(&Event) -> bool) -> Vec<LineOfTrace> {
        let Some(fragment) = self.fragments.get(fragment) else { return Vec::new() };
        let mut statements: Vec<Statement<'_>> = Vec::new();
        let mut shown: Vec<usize> = Vec::new();
        let mut numbered = Numbered::default();
        for event in &fragment.events {
            let (number, is_new) = numbered.of(&event.doing);
            if is_new {
                statements.push(Statement { doing: &event.doing, done: None, last: None });
            }
            let is_shown = is_shown(event);
            let statement = &mut statements[number];
            let last = std::mem::replace(&mut statement.last, is_shown.then_some(event.time));
            if !is_shown {
                continue;
            }
            let not_logged = last.map_or(0, |last| event.time.saturating_sub(last + 1));
            let done = statement.done.get_or_insert_with(|| {
                shown.push(number);
                Done::new(&event.doing)
            });
            done.add(event, not_logged as usize);
        }
        let mut files: Vec<&str> = Vec::new();
        let mut lines: BTreeMap<(usize, u32), LineOfTrace> = BTreeMap::new();
        for number in shown {
            let Statement { doing, done, .. } = &mut statements[number];
            let (file, line) = (doing.file.as_str(), doing.line);
            let place = files.iter().position(|known| *known == file).unwrap_or_else(|| {
                files.push(file);
                files.len() - 1
            });
            let of_line = lines.entry((place, line)).or_insert_with(|| LineOfTrace {
                file: file.to_owned(),
                line,
                code: self.code.get(&(file.to_owned(), line)).cloned().unwrap_or_default(),
                done: Vec::new(),
            });
            of_line.done.extend(done.take());
        }
        lines.into_values().collect()
    }

    /// The files with statements that log.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let files: BTreeSet<&str> = self.code.keys().map(|(file, _)| file.as_str()).collect();
        files.into_iter()
    }

    /// The lines of a file that have statements.
    pub fn statement_lines<'a>(&'a self, file: &'a str) -> impl Iterator<Item = u32> + 'a {
        self.code.keys().filter(move |(of, _)| of == file).map(|(_, line)| *line)
    }

    /// The lines with statements that a fragment did not reach, by file.
    pub fn not_reached(&self, fragment: usize) -> BTreeMap<&str, Vec<u32>> {
        let Some(fragment) = self.fragments.get(fragment) else { return BTreeMap::new() };
        let all = fragment.events.iter().map(|event| &event.doing);
        let reached: BTreeSet<(&str, u32)> = all.map(|doing| (doing.file.as_str(), doing.line)).collect();
        let mut found: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
        for (file, line) in self.code.keys().map(|(file, line)| (file.as_str(), *line)) {
            if !reached.contains(&(file, line)) {
                found.entry(file).or_default().push(line);
            }
        }
        found
    }

    /// The trace of a fragment for programs.
    pub fn json(&self, fragment: usize) -> Value {
        let of = |(index, found): (usize, &Fragment)| {
            let not_logged = found.not_logged;
            let mut json = json!({ "depth": found.depth, "color": found.color.map(floats),
                "discarded": found.color.is_none(), "visible": self.visible() == Some(index), "not_logged": not_logged });
            if let Some(state) = self.state(index) {
                (json["state"], json["covered_by"]) = (json!(state.name()), json!(state.covered_by()));
            }
            json["samples"] = json!(found.samples.map(|samples| numbers(samples).collect::<Vec<_>>()));
            json["primitive"] = json!(found.primitive);
            if let Some(vertex) = found.vertex {
                json = json!({ "vertex": vertex, "position": found.color.map(floats), "not_logged": not_logged });
            }
            json
        };
        let color = self.fragments.get(fragment).and_then(|fragment| fragment.color);
        let traced = if self.has_color() { color } else { Some(self.redrawn) };
        let proof = json!({ "equal": self.is_proven(fragment), "ulp": traced.map(|color| ulps(color, self.picture)),
            "with": self.target.name(), "traced": traced.map(floats), "picture": floats(self.picture),
            "redrawn": floats(self.redrawn), "begins_anew": self.begins_anew, "blended_ulp": self.together(fragment).map(|color| ulps(color, self.picture)) });
        json!({ "fragments": self.fragments.iter().enumerate().map(of).collect::<Vec<_>>(), "left_out": self.left_out, "samples": self.samples,
            "stage": self.stage, "fragment": fragment, "proof": proof,
            "lights": (1..).zip(&self.lights).map(|(number, light)| light.json(number)).collect::<Vec<_>>(),
            "lines": self.lines(fragment).iter().map(LineOfTrace::json).collect::<Vec<_>>(),
            "not_reached": self.not_reached(fragment) })
    }
}

fn floats(bits: [u32; 4]) -> Value {
    Value::Array(bits.map(|bits| TracedValue::float(f32::from_bits(bits)).json()).to_vec())
}

/// A statement of a fragment.
struct Statement<'a> {
    doing: &'a Doing,
    /// The events that are shown.
    done: Option<Done>,
    /// The time of the last event, if it is shown.
    last: Option<u32>,
}

impl LineOfTrace {
    fn json(&self) -> Value {
        let once = |once: &Once| json!({ "value": once.value.map(|value| value.json()), "calls": *once.calls, "time": once.time });
        let done = |done: &Done| {
            let kind = done.first.first().and_then(|once| once.value).map(|value| value.type_name());
            json!({ "act": done.act, "name": done.name, "type": kind, "text": done.text(), "count": done.count, "left_out": done.left_out(), "not_logged": done.not_logged,
                "first": done.first.iter().map(once).collect::<Vec<_>>(), "last": done.last.iter().map(once).collect::<Vec<_>>() })
        };
        json!({ "file": self.file, "line": self.line, "code": self.code, "text": self.text(),
            "done": self.done.iter().map(done).collect::<Vec<_>>() })
    }

    /// The actions of the statements, on one line.
    pub fn text(&self) -> String {
        self.done.iter().map(Done::text).collect::<Vec<_>>().join("   ")
    }
}

impl Done {
    fn new(doing: &Doing) -> Self {
        let (act, name) = (doing.act, doing.name.clone());
        Self { act, name, count: 0, not_logged: 0, first: Vec::new(), last: Vec::new() }
    }

    /// `not_logged`: how many events were not, between the last one and this.
    fn add(&mut self, event: &Event, not_logged: usize) {
        let once = Once { value: event.value, calls: event.calls.clone(), time: event.time };
        self.count += 1 + not_logged;
        self.not_logged += not_logged;
        if self.first.len() < MOST_KEPT {
            return self.first.push(once);
        }
        if self.last.len() == MOST_KEPT {
            self.last.remove(0);
        }
        self.last.push(once);
    }

    /// How often between the first and the last times.
    pub fn left_out(&self) -> usize {
        self.count.saturating_sub(self.first.len() + self.last.len())
    }

    /// The first and the last values, in order.
    pub fn values(&self) -> impl Iterator<Item = TracedValue> {
        self.first.iter().chain(&self.last).filter_map(|once| once.value)
    }

    /// As `alpha2 = 0.0625 ×3`, `alpha2 = 0.0625, 0.25, 1 ×3` or, of more than three values, `i = 0, 1, …, 39 ×40`.
    pub fn text(&self) -> String {
        let values = self.values_text();
        match self.act {
            Act::Store | Act::Argument => format!("{} = {values}", self.name),
            Act::Return => format!("return{} {values}", self.name),
            Act::Condition => format!("? {values}"),
            Act::Discard => format!("discard{values}"),
            Act::Leave => format!("return{values}"),
        }
    }

    /// The values in [`Self::text`].
    pub fn values_text(&self) -> String {
        let mut texts: Vec<String> = self.values().map(|value| value.text()).collect();
        texts.dedup();
        let values = match texts.as_slice() {
            [first, second, _, .., last] => format!("{first}, {second}, …, {last}"),
            few => few.join(", "),
        };
        let times = if self.count > 1 { format!(" ×{}", self.count) } else { String::new() };
        let not_logged = match self.not_logged {
            0 => String::new(),
            count => format!(" ({count} of them not logged)"),
        };
        format!("{values}{times}{not_logged}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample::{event, trace};
    use super::*;

    #[test]
    fn events_are_gathered_by_line() {
        let mut events = vec![event(9, Act::Return, "", &[2.0]), event(3, Act::Store, "n", &[0.0, 1.0, 0.5])];
        events.extend((0..40).map(|round| event(5, Act::Store, "i", &[round as f32])));
        // A log keeps the first and the last events of a long loop, and those behind it.
        let ends = (1..=20).chain(9981..=10_000);
        events.extend(ends.map(|time| Event { time, ..event(6, Act::Store, "k", &[time as f32]) }));
        events.push(event(8, Act::Store, "sum", &[4.0]));
        let trace = trace(events, &[3, 5, 6, 7, 8, 9]);
        let lines = trace.lines(0);
        let texts: Vec<(u32, String)> = lines.iter().map(|line| (line.line, line.text())).collect();
        assert_eq!(texts[0], (3, "n = (0, 1, 0.5)".to_owned()));
        assert_eq!(texts[1], (5, "i = 0, 1, …, 39 ×40".to_owned()));
        assert_eq!(texts[2], (6, "k = 1, 2, …, 10000 ×10000 (9960 of them not logged)".to_owned()));
        assert_eq!(texts[3..], [(8, "sum = 4".to_owned()), (9, "return 2".to_owned())]);
        let kept = |done: &Done| {
            let ends = [&done.first[0], &done.first[15], &done.last[0], &done.last[15]];
            (ends.map(|once| once.value.unwrap().text()), ends.map(|once| once.time), done.left_out())
        };
        let of = |texts: [&str; 4], times, left_out| (texts.map(str::to_owned), times, left_out);
        assert_eq!(kept(&lines[1].done[0]), of(["0", "15", "24", "39"], [1, 16, 25, 40], 8));
        assert_eq!(kept(&lines[2].done[0]), of(["1", "16", "9985", "10000"], [1, 16, 9985, 10_000], 9968));
        // Between events that are not shown, none count.
        let chosen = trace.lines_where(0, |event| event.time == 2 || event.time == 9999);
        assert_eq!(chosen[1].text(), "k = 2, 9999 ×2");
        assert_eq!(trace.not_reached(0), BTreeMap::from([("a.glsl", vec![7])]));
    }
}
