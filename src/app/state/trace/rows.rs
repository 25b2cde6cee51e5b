//! The lines of a file with what their statements do at a pixel, now and in the version before.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use serde_json::{Value, json};

use super::choice::Choice;
use super::rounds::{Round, ends_of_do};
use crate::shader::expression::lines_before;
use crate::shader::trace::{Act, Done, LineOfTrace, Trace, TracedValue, is_related};

/// The mark of a new line, before its first value.
pub(in crate::app) const NEW: &str = "new: ";

/// A trace and the text of its file.
pub(in crate::app) struct Side<'a> {
    pub(in crate::app) trace: &'a Trace,
    pub(in crate::app) text: Arc<str>,
}

/// The input of the rows.
pub(in crate::app) struct Sources<'a> {
    /// The text that is shown.
    pub(in crate::app) text: &'a str,
    pub(in crate::app) now: Option<Side<'a>>,
    pub(in crate::app) before: Option<Side<'a>>,
}

/// Whether the pixel reaches a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum Reach {
    /// The line has no statements, or nothing is known.
    #[default]
    Unknown,
    Reached,
    Missed,
}

/// A line with its values.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::app) struct Row {
    /// From 1.
    pub(in crate::app) line: u32,
    /// The same line of the text that was traced, from 1.
    pub(in crate::app) traced: Option<u32>,
    pub(in crate::app) reach: Reach,
    /// The values and decisions of its statements, in order.
    pub(in crate::app) notes: Vec<Note>,
    /// Whether this is the first line, in the order of execution, that is new or whose values differ from the version before.
    pub(in crate::app) is_first_change: bool,
}

/// A value or a decision of a statement.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Note {
    pub(in crate::app) done: Done,
    /// The text before the values: `a2 = `; may be empty.
    pub(in crate::app) label: String,
    pub(in crate::app) values: String,
    /// The values in the version before, if they differ.
    pub(in crate::app) before: Option<String>,
    /// Whether it is the first of a line that the version before does not have.
    pub(in crate::app) is_new: bool,
    /// Whether a value is NaN or infinite.
    pub(in crate::app) is_bad: bool,
}

impl Note {
    /// The text that is shown, on one line.
    pub(in crate::app) fn text(&self) -> String {
        let Self { label, values, before, is_new, .. } = self;
        let new = if *is_new { NEW } else { "" };
        let before = before.as_ref().map(|before| format!("{before} → ")).unwrap_or_default();
        format!("{new}{label}{before}{values}")
    }

    /// Whether the last edit has made or changed it.
    pub(in crate::app) fn is_changed(&self) -> bool {
        self.is_new || self.before.is_some()
    }
}

impl Row {
    /// The values that differ from the version before, which is null for those of new lines.
    pub(super) fn changes_json(&self) -> impl Iterator<Item = Value> {
        self.notes.iter().filter(|note| note.is_changed()).map(|note| {
            json!({ "line": self.line, "name": note.done.name, "act": note.done.act, "before": note.before,
                "now": note.values, "first": self.is_first_change })
        })
    }
}

/// The rows of a text, one for each of its lines.
pub(in crate::app) fn rows(sources: &Sources<'_>, choice: &Choice) -> Vec<Row> {
    let Sources { text, now, before } = sources;
    let texts: Vec<&str> = text.lines().collect();
    let mut rows: Vec<Row> = (1..).zip(&texts).map(|(line, _)| Row { line, ..Row::default() }).collect();
    let Some(now) = now else { return rows };
    let lines = by_line(choice.lines(now.trace, &now.text));
    let earlier = before.as_ref().map(|before| {
        let lines_before = lines_before(&before.text, &now.text);
        let line_before = |line: u32| lines_before.get((line as usize).checked_sub(1)?).copied().flatten();
        // The number of a fragment of one version may be that of another in the other version.
        let fragment = choice.fragment_of(before.trace).and(choice.fragment);
        let round = choice.round.map(|round| Round { line: line_before(round.line).unwrap_or(0), ..round });
        let choice = Choice { fragment, round, ..choice.clone() };
        (by_line(choice.lines(before.trace, &before.text)), lines_before)
    });
    let file = lines.values().next().map(|line| line.file.clone());
    let file = file.or_else(|| now.trace.files().next().map(str::to_owned)).unwrap_or_default();
    let statements: BTreeSet<u32> = now.trace.statement_lines(&file).collect();
    let traced = lines_before(&now.text, text);
    let ends = ends_of_do(&now.text);
    let mut changed = Vec::new();
    for (at, row) in rows.iter_mut().enumerate() {
        let Some(line) = traced.get(at).copied().flatten() else { continue };
        row.traced = Some(line);
        let line_before = earlier.as_ref().map(|(_, before)| before.get(line as usize - 1).copied().flatten());
        let earlier = earlier.as_ref().and_then(|(of, _)| of.get(&line_before??));
        let decides = match texts.get(at) {
            _ if ends.contains(&line) => Decides::Again,
            Some(text) if is_loop(text) => Decides::Round,
            _ => Decides::Branch,
        };
        row.notes = lines.get(&line).map(|line| notes(line, earlier, decides)).unwrap_or_default();
        row.notes.iter_mut().take(1).for_each(|note| note.is_new = line_before == Some(None));
        row.reach = match (statements.contains(&line), lines.contains_key(&line)) {
            (_, true) => Reach::Reached,
            (true, false) => Reach::Missed,
            (false, false) => Reach::Unknown,
        };
        let differs = row.notes.iter().filter(|note| note.is_changed());
        changed.extend(differs.map(|note| Changed { line, act: note.done.act, name: note.done.name.clone(), row: at }));
    }
    if let Some(first) = first_change(now.trace, choice, &changed) {
        rows[first].is_first_change = true;
    }
    spread(&mut rows);
    rows
}

fn by_line(lines: Vec<LineOfTrace>) -> BTreeMap<u32, LineOfTrace> {
    lines.into_iter().map(|line| (line.line, line)).collect()
}

/// A statement that is new, or whose values differ from the version before.
struct Changed {
    /// The traced line, from 1.
    line: u32,
    act: Act,
    name: String,
    /// The index of its row.
    row: usize,
}

/// The row of the changed statement that ran first.
fn first_change(trace: &Trace, choice: &Choice, changed: &[Changed]) -> Option<usize> {
    let fragment = choice.fragment_of(trace)?;
    let call = choice.call_of(trace, fragment);
    let events = trace.fragments.get(fragment)?.events.iter();
    let mut of_choice = events.filter(|event| call.is_none_or(|call| is_related(&event.calls, call)));
    let first = changed.first()?.row;
    let rows: HashMap<(u32, Act, &str), usize> =
        changed.iter().rev().map(|of| ((of.line, of.act, of.name.as_str()), of.row)).collect();
    let found = of_choice.find_map(|event| rows.get(&(event.doing.line, event.doing.act, event.doing.name.as_str())));
    Some(found.copied().unwrap_or(first))
}

/// Lines without statements between lines that are not reached belong to them.
fn spread(rows: &mut [Row]) {
    let known: Vec<Reach> = rows.iter().map(|row| row.reach).collect();
    let mut above = Reach::Unknown;
    for at in 0..rows.len() {
        if known[at] != Reach::Unknown {
            above = known[at];
        } else if above == Reach::Missed {
            let below = known[at..].iter().find(|reach| **reach != Reach::Unknown);
            if below == Some(&Reach::Missed) {
                rows[at].reach = Reach::Missed;
            }
        }
    }
}

fn is_loop(line: &str) -> bool {
    ["for", "while", "do"].iter().any(|word| {
        let rest = line.trim_start().trim_start_matches('}').trim_start().strip_prefix(word);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })
}

/// The decision of the conditions of a line.
#[derive(Clone, Copy)]
enum Decides {
    /// Whether a branch is taken.
    Branch,
    /// Whether a round of a loop follows.
    Round,
    /// The same, behind a round.
    Again,
}

fn notes(line: &LineOfTrace, earlier: Option<&LineOfTrace>, decides: Decides) -> Vec<Note> {
    let note = |done: &Done| {
        let is_same = |of: &&Done| (of.act, &of.name) == (done.act, &done.name);
        let before = earlier.and_then(|line| line.done.iter().find(is_same));
        let values = values(done, decides);
        let before = before.map(|before| self::values(before, decides)).filter(|before| *before != values);
        let label = match done.act {
            Act::Store | Act::Argument => format!("{} = ", done.name),
            Act::Return => format!("return{} ", done.name),
            Act::Condition | Act::Discard | Act::Leave => String::new(),
        };
        let is_bad = done.values().any(|value| !value.is_finite());
        Note { done: done.clone(), label, values, before, is_new: false, is_bad }
    };
    line.done.iter().map(note).collect()
}

/// The values in words. A condition says whether its branch was taken, or how many rounds its loop had.
fn values(done: &Done, decides: Decides) -> String {
    let count = done.count;
    match done.act {
        Act::Discard | Act::Leave => {
            let name = if done.act == Act::Discard { "discard" } else { "return" };
            if count > 1 { format!("{name} ×{count}") } else { name.to_owned() }
        }
        Act::Condition if done.values().count() == count => {
            let is_true = |value: TracedValue| value.numbers().any(|number| number != 0.0);
            let taken = done.values().filter(|value| is_true(*value)).count();
            let rounds = match decides {
                Decides::Branch => None,
                Decides::Round => Some(taken),
                // Behind the last condition that was true, a round ended without one.
                Decides::Again => Some(count + usize::from(done.values().last().is_some_and(is_true))),
            };
            match (rounds, taken) {
                (Some(1), _) => "1 round".to_owned(),
                (Some(rounds), _) => format!("{rounds} rounds"),
                (None, taken) if taken == count && count == 1 => "taken".to_owned(),
                (None, taken) if taken == count => format!("taken ×{count}"),
                (None, 0) if count == 1 => "not taken".to_owned(),
                (None, 0) => format!("not taken ×{count}"),
                (None, taken) => format!("taken {taken} of {count}"),
            }
        }
        _ => done.values_text(),
    }
}
