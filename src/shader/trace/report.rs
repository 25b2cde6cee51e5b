//! A trace by lines of its sources, as text and JSON, and assertions about values.

use std::sync::Arc;

use serde_json::{Value, json};

use super::{Act, Event, Fragment, Trace, TracedValue};

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
    /// What was done, in order.
    pub done: Vec<Done>,
}

/// What a statement did, once or more often.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// What it was.
    pub act: Act,
    /// The variable or parameter; empty for others.
    pub name: String,
    /// How often.
    pub count: usize,
    /// The first times.
    pub first: Vec<Once>,
    /// The last times, as far as they are not among the first.
    pub last: Vec<Once>,
}

/// One time that a statement did something.
#[derive(Clone, Debug, PartialEq)]
pub struct Once {
    /// The value; none for a discard.
    pub value: Option<TracedValue>,
    /// The calls that led to it.
    pub calls: Arc<str>,
}

impl Trace {
    /// The lines of a fragment, file by file in the order in which they were reached.
    pub fn lines(&self, fragment: usize) -> Vec<LineOfTrace> {
        let Some(fragment) = self.fragments.get(fragment) else { return Vec::new() };
        let mut files: Vec<&str> = Vec::new();
        let mut lines: Vec<LineOfTrace> = Vec::new();
        for event in &fragment.events {
            if !files.contains(&event.file.as_str()) {
                files.push(&event.file);
            }
            let known = lines.iter().position(|line| (&line.file, line.line) == (&event.file, event.line));
            let at = known.unwrap_or_else(|| {
                let (file, line) = (event.file.clone(), event.line);
                let code = self.code.get(&(file.clone(), line)).cloned().unwrap_or_default();
                lines.push(LineOfTrace { file, line, code, done: Vec::new() });
                lines.len() - 1
            });
            add(&mut lines[at].done, event);
        }
        let order = |line: &LineOfTrace| (files.iter().position(|file| *file == line.file), line.line);
        lines.sort_by_key(|line| order(line));
        lines
    }

    /// The whole trace for programs. `fragment`: the one whose lines are given.
    pub fn json(&self, fragment: Option<usize>) -> Value {
        let floats = |bits: [u32; 4]| {
            let one = |bits: u32| TracedValue::float(f32::from_bits(bits)).json();
            Value::Array(bits.map(one).to_vec())
        };
        let of = |(index, found): (usize, &Fragment)| {
            json!({ "depth": found.depth, "color": found.color.map(floats), "discarded": found.color.is_none(),
                "visible": self.visible() == Some(index), "events": found.events.len(), "left_out": found.left_out })
        };
        let proof = fragment.map(|fragment| {
            json!({ "equal": self.is_proven(fragment), "traced": self.fragments[fragment].color.map(floats),
                "picture": floats(self.picture) })
        });
        let lines: Vec<Value> =
            fragment.map(|fragment| self.lines(fragment)).unwrap_or_default().iter().map(LineOfTrace::json).collect();
        json!({ "fragments": self.fragments.iter().enumerate().map(of).collect::<Vec<_>>(), "left_out": self.left_out,
            "fragment": fragment, "proof": proof, "lines": lines })
    }

    /// How the color of a fragment compares with the picture's, in words.
    pub fn proof_text(&self, fragment: usize) -> String {
        let color = self.fragments.get(fragment).and_then(|fragment| fragment.color);
        let Some(color) = color else { return "it was discarded".to_owned() };
        if color == self.picture {
            return "equal to the picture".to_owned();
        }
        if self.visible() != Some(fragment) {
            return "it is hidden or blended over".to_owned();
        }
        let steps = color.iter().zip(self.picture).map(|(traced, shown)| traced.abs_diff(shown)).max().unwrap_or(0);
        format!(
            "{steps} ulp from the picture: another surface is blended with it, or the driver computes it in another order"
        )
    }
}

fn add(list: &mut Vec<Done>, event: &Event) {
    let known = list.iter_mut().find(|done| (done.act, &done.name) == (event.act, &event.name));
    let once = Once { value: event.value, calls: event.calls.clone() };
    let Some(done) = known else {
        let (act, name) = (event.act, event.name.clone());
        list.push(Done { act, name, count: 1, first: vec![once], last: Vec::new() });
        return;
    };
    done.count += 1;
    if done.first.len() < MOST_KEPT {
        return done.first.push(once);
    }
    if done.last.len() == MOST_KEPT {
        done.last.remove(0);
    }
    done.last.push(once);
}

impl LineOfTrace {
    fn json(&self) -> Value {
        let once = |once: &Once| json!({ "value": once.value.map(|value| value.json()), "calls": *once.calls });
        let done = |done: &Done| {
            let kind = done.first.first().and_then(|once| once.value).map(|value| value.type_name());
            json!({ "act": done.act, "name": done.name, "type": kind, "count": done.count,
                "first": done.first.iter().map(once).collect::<Vec<_>>(), "last": done.last.iter().map(once).collect::<Vec<_>>() })
        };
        json!({ "file": self.file, "line": self.line, "code": self.code,
            "done": self.done.iter().map(done).collect::<Vec<_>>() })
    }

    /// What the statements did, on one line.
    pub fn text(&self) -> String {
        self.done.iter().map(Done::text).collect::<Vec<_>>().join("   ")
    }
}

impl Done {
    /// The values that are kept, in order.
    pub fn values(&self) -> impl Iterator<Item = TracedValue> {
        self.first.iter().chain(&self.last).filter_map(|once| once.value)
    }

    /// As `alpha2 = 0.0625 ×3` or `alpha2 = 0.0625, 0.25, 1`: at most three different values.
    pub fn text(&self) -> String {
        const MOST_SHOWN: usize = 3;
        let mut texts: Vec<String> = self.values().map(|value| value.text()).collect();
        texts.dedup();
        let more = if texts.len() > MOST_SHOWN { ", …" } else { "" };
        let times = if self.count > 1 { format!(" ×{}", self.count) } else { String::new() };
        let values = texts[..texts.len().min(MOST_SHOWN)].join(", ");
        match self.act {
            Act::Store | Act::Argument => format!("{} = {values}{more}{times}", self.name),
            Act::Return => format!("return{} {values}{more}{times}", self.name),
            Act::Condition => format!("? {values}{more}{times}"),
            Act::Discard => format!("discard{times}"),
        }
    }
}

/// A condition that the values at a line must fulfill: `FILE:LINE NAME > NUMBER`. `NAME` may end in a component, as `n.x`, or be `return`.
#[derive(Clone, Debug, PartialEq)]
pub struct Assertion {
    text: String,
    file: String,
    line: u32,
    name: String,
    comparison: Comparison,
    limit: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

impl Comparison {
    const ALL: [(&str, Self); 6] = [
        ("<", Self::Less),
        ("<=", Self::LessOrEqual),
        (">", Self::Greater),
        (">=", Self::GreaterOrEqual),
        ("==", Self::Equal),
        ("!=", Self::NotEqual),
    ];

    fn holds(self, number: f64, limit: f64) -> bool {
        match self {
            Self::Less => number < limit,
            Self::LessOrEqual => number <= limit,
            Self::Greater => number > limit,
            Self::GreaterOrEqual => number >= limit,
            Self::Equal => number == limit,
            Self::NotEqual => number != limit,
        }
    }
}

impl Assertion {
    /// Reads an assertion.
    ///
    /// # Errors
    /// A message with the form that was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected =
            || format!("'{text}' is no assertion: expected FILE:LINE NAME > NUMBER, as 'brdf/ndf.glsl:24 spread > 0'");
        let words: Vec<&str> = text.split_whitespace().collect();
        let [place, name, comparison, limit] = words.as_slice() else { return Err(expected()) };
        let (file, line) = place.rsplit_once(':').ok_or_else(expected)?;
        let comparison = Comparison::ALL.iter().find(|(sign, _)| sign == comparison).ok_or_else(expected)?.1;
        let number = match *limit {
            "true" => Ok(1.0),
            "false" => Ok(0.0),
            limit => limit.parse(),
        };
        Ok(Self {
            text: text.to_owned(),
            file: file.to_owned(),
            line: line.parse().map_err(|_| expected())?,
            name: (*name).to_owned(),
            comparison,
            limit: number.map_err(|_| expected())?,
        })
    }

    /// The file that it is about.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Checks the values of all times that are in the lines. NaN fulfills nothing but `!=`.
    ///
    /// # Errors
    /// The values that do not fulfill it, or no value was computed there.
    pub fn check(&self, lines: &[LineOfTrace]) -> Result<(), String> {
        let here = || lines.iter().filter(|line| line.file == self.file && line.line == self.line);
        let (whole, component) = match self.name.rsplit_once('.') {
            Some((whole, part)) if here().flat_map(|line| &line.done).all(|done| done.name != self.name) => {
                (whole, part.chars().next().and_then(|part| "xyzw rgba".find(part)).map(|at| at % 5))
            }
            _ => (self.name.as_str(), None),
        };
        let is_named = |done: &&Done| match done.act {
            Act::Return => whole == "return",
            Act::Condition => whole == "condition",
            _ => done.name == whole,
        };
        let all = || here().flat_map(|line| &line.done).filter(is_named);
        let values: Vec<TracedValue> = all().flat_map(Done::values).collect();
        if values.is_empty() {
            let known: Vec<String> = here().flat_map(|line| &line.done).map(Done::text).collect();
            let known = if known.is_empty() { "nothing".to_owned() } else { known.join("   ") };
            return Err(format!(
                "{}: no value of `{}` was computed at this pixel; the line has {known}",
                self.text, self.name
            ));
        }
        let fails = |value: &TracedValue| match component {
            Some(at) => value.numbers().nth(at).is_none_or(|number| !self.comparison.holds(number, self.limit)),
            None => !value.numbers().all(|number| self.comparison.holds(number, self.limit)),
        };
        let failed: Vec<String> = values.iter().filter(|value| fails(value)).map(TracedValue::text).collect();
        match failed.first() {
            None => Ok(()),
            Some(first) => Err(format!(
                "{}: failed for {} of {} values; the first is {first}",
                self.text,
                failed.len(),
                values.len()
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(line: u32, act: Act, name: &str, numbers: &[f32]) -> Event {
        let value = match numbers {
            [] => None,
            [number] => Some(TracedValue::float(*number)),
            numbers => Some(TracedValue::floats(numbers)),
        };
        Event { file: "a.glsl".into(), line, act, name: name.into(), value, calls: "f".into() }
    }

    fn trace(events: Vec<Event>) -> Trace {
        let color = Some([0; 4]);
        let fragment = Fragment { depth: 0.5, color, events, left_out: 0 };
        Trace { fragments: vec![fragment], left_out: 0, picture: [0; 4], code: Default::default() }
    }

    #[test]
    fn events_are_gathered_by_line() {
        let mut events = vec![event(9, Act::Return, "", &[2.0]), event(3, Act::Store, "n", &[0.0, 1.0, 0.5])];
        events.extend((0..40).map(|round| event(5, Act::Store, "i", &[round as f32])));
        let lines = trace(events).lines(0);
        let texts: Vec<(u32, String)> = lines.iter().map(|line| (line.line, line.text())).collect();
        assert_eq!(texts[0], (3, "n = (0, 1, 0.5)".to_owned()));
        assert_eq!(texts[1], (5, "i = 0, 1, 2, … ×40".to_owned()));
        assert_eq!(texts[2], (9, "return 2".to_owned()));
        let done = &lines[1].done[0];
        let ends = [done.first[0].value, done.first[15].value, done.last[0].value, done.last[15].value];
        assert_eq!(ends.map(|value| value.unwrap().text()), ["0", "15", "24", "39"]);
    }

    #[test]
    fn assertions_name_what_fails() {
        let lines = trace(vec![
            event(3, Act::Store, "n", &[0.0, 1.0]),
            event(4, Act::Store, "d", &[0.5]),
            event(4, Act::Store, "d", &[-1.0]),
            event(5, Act::Return, "", &[f32::NAN]),
        ])
        .lines(0);
        let check = |text: &str| Assertion::parse(text).unwrap().check(&lines);
        for text in
            ["a.glsl:3 n >= 0", "a.glsl:3 n.y > 0.5", "a.glsl:3 n.x == 0", "a.glsl:4 d < 1", "a.glsl:5 return != 0"]
        {
            assert_eq!(check(text), Ok(()));
        }
        for (text, words) in [
            ("a.glsl:3 n > 0", "failed for 1 of 1 values; the first is (0, 1)"),
            ("a.glsl:4 d > 0", "failed for 1 of 2 values; the first is -1"),
            ("a.glsl:5 return >= 0", "the first is NaN"),
            ("a.glsl:4 e > 0", "no value of `e` was computed at this pixel; the line has d = 0.5, -1 ×2"),
            ("a.glsl:7 e > 0", "the line has nothing"),
        ] {
            let error = check(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
        for text in ["a.glsl:3 n", "a.glsl n > 0", "a.glsl:x n > 0", "a.glsl:3 n ~ 0", "a.glsl:3 n > much", ""] {
            assert!(Assertion::parse(text).unwrap_err().contains("expected FILE:LINE NAME > NUMBER"), "{text}");
        }
    }
}
