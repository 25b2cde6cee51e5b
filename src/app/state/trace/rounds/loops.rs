//! The loops of a text, and what belongs to them.

use std::ops::{Range, RangeInclusive};

use crate::shader::glsl::syntax::{Statement, StatementKind, functions, within};
use crate::shader::glsl::{Code, spelled};
use crate::shader::trace::{Act, Event, paths_to};

/// A loop whose rounds were logged.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct TracedLoop {
    /// Its first line in the traced text, from 1.
    pub(in crate::app) line: u32,
    /// Its code up to the body, on one line.
    pub(in crate::app) code: String,
    /// The number of each round, and the values that the variables of the header have in it: `i = 2`.
    pub(in crate::app) rounds: Vec<(u32, String)>,
    /// The number of the round to which each event of the fragment belongs: `None` outside of the loop, 0 where the loop ends, or in rounds
    /// that were not logged.
    pub(super) owners: Vec<Option<u32>>,
}

impl TracedLoop {
    /// Whether an event belongs to a round, or to none.
    pub(in crate::app::state::trace) fn is_shown(&self, event: usize, number: u32) -> bool {
        self.owners.get(event).copied().flatten().is_none_or(|of| of == number)
    }
}

/// A loop in the text of a file.
pub(super) struct Loop<'a> {
    pub(super) lines: RangeInclusive<u32>,
    /// The lines of its header.
    pub(super) header: RangeInclusive<u32>,
    pub(super) code: String,
    /// The words of the header of a `for`.
    pub(super) words: Vec<&'a str>,
    /// Whether it begins with its body.
    pub(super) is_do: bool,
}

/// The loops of a text. One is left out if another condition stands on the lines of its own, which cannot be told from it.
pub(super) fn loops(text: &str) -> Vec<Loop<'_>> {
    let code = Code::new(text);
    let (mut found, mut decisions) = (Vec::new(), Vec::new());
    functions(&code.tokens).iter().for_each(|function| find(&function.body, text, &code, &mut found, &mut decisions));
    let stand_on = |lines: &RangeInclusive<u32>| {
        decisions.iter().filter(|of| of.start() <= lines.end() && of.end() >= lines.start()).count()
    };
    found.retain(|of| stand_on(&of.header) == 1);
    found
}

/// Finds the loops in a statement, and the lines of each condition.
fn find<'a>(
    statement: &Statement,
    text: &'a str,
    code: &Code<'_>,
    found: &mut Vec<Loop<'a>>,
    decisions: &mut Vec<RangeInclusive<u32>>,
) {
    let lines = |bytes: &Range<usize>| code.number_at(bytes.start)..=code.number_at(bytes.end.saturating_sub(1));
    let head = statement.bytes.start..statement.header.end;
    match statement.kind {
        StatementKind::Branch => decisions.push(lines(&head)),
        StatementKind::Loop => {
            let tokens = within(&code.tokens, &head);
            let words = tokens.iter().map(|token| &text[token.bytes.clone()]);
            let words = words.filter(|_| tokens.first().is_some_and(|token| token.text == "for")).collect();
            let (lines, header) = (lines(&statement.bytes), lines(&head));
            decisions.push(header.clone());
            found.push(Loop { lines, header, code: spelled(tokens), words, is_do: false });
        }
        StatementKind::DoLoop => {
            let header = lines(&statement.header);
            let end = spelled(within(&code.tokens, &statement.header));
            let code = format!("do … {}", end.trim_end_matches(';'));
            decisions.push(header.clone());
            let lines = *lines(&statement.bytes).start()..=*header.end();
            found.push(Loop { lines, header, code, words: Vec::new(), is_do: true });
        }
        _ => {}
    }
    statement.parts.iter().for_each(|part| find(part, text, code, found, decisions));
}

/// The first lines of the ends of all `do` loops, which have their conditions.
pub(in crate::app::state::trace) fn ends_of_do(text: &str) -> Vec<u32> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    if !text.split(|c| !is_word(c)).any(|word| word == "do") {
        return Vec::new();
    }
    loops(text).into_iter().filter(|of| of.is_do).map(|of| *of.header.start()).collect()
}

impl Loop<'_> {
    /// Whether an event is the decision about the next round.
    pub(super) fn is_condition(&self, event: &Event) -> bool {
        event.doing.act == Act::Condition && self.header.contains(&event.doing.line)
    }

    /// Whether an event is of the loop in this call, or of a function that it calls.
    pub(super) fn is_inside(&self, event: &Event, calls: &str) -> bool {
        match *event.calls == *calls {
            true => self.lines.contains(&event.doing.line),
            false => calls.is_empty() || paths_to(&event.calls).any(|path| path == calls),
        }
    }
}

/// The values of what was stored, each variable once, or the place of the round in the list.
pub(super) fn label(stored: &[usize], events: &[Option<&Event>], place: usize) -> String {
    let mut values: Vec<(&str, String)> = Vec::new();
    for event in stored.iter().filter_map(|at| events[*at]) {
        let (name, value) = (event.doing.name.as_str(), event.value.map(|value| value.text()).unwrap_or_default());
        match values.iter_mut().find(|(known, _)| *known == name) {
            Some(known) => known.1 = value,
            None => values.push((name, value)),
        }
    }
    match values.is_empty() {
        true => format!("round {place}"),
        false => values.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", "),
    }
}
