//! The rows of a file, made anew when the file, the trace or the choice changes.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use super::choices::Offers;
use super::functions::{Fold, Function};
use super::text_lines::{TextLine, TextLines};
use crate::app::state::State;
use crate::app::state::trace::Progress;
use crate::app::state::trace::choice::Choice;
use crate::app::state::trace::rows::{Note, Reach, Row};
use crate::identity::Identity;
use crate::shader::expression::lines_before;
use crate::shader::trace::Act;
use crate::shader::{Diagnostic, Highlight, Severity, ShaderSet, TreePath};

/// A line of the file.
pub(super) struct CodeLine {
    pub(super) text: String,
    /// The parts that have a color, by their bytes in `text`.
    pub(super) parts: Vec<(Range<usize>, Highlight)>,
    /// The file that the line includes.
    pub(super) include: Option<TreePath>,
    pub(super) row: Row,
    /// The first error or warning about the line.
    pub(super) message: Option<(Severity, String)>,
    /// The bytes of its numbers that can be dragged.
    pub(super) numbers: Vec<Range<usize>>,
    /// The function that begins here.
    pub(super) fold: Option<Fold>,
}

/// A row of the list.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shown {
    /// A line, by its index.
    Line(usize),
    /// A message about the line above.
    Message(Severity, String),
}

/// The inputs that decide whether the rest is up to date.
#[derive(Clone, PartialEq)]
struct Inputs {
    path: TreePath,
    text: Arc<str>,
    /// Those of the newest version and of the one before, and whether a pixel is pinned.
    traces: ([Identity; 2], bool),
    choice: Choice,
    diagnostics: Vec<Diagnostic>,
    /// The folded functions.
    folded: BTreeSet<String>,
}

/// The file that is shown.
#[derive(Default)]
pub(super) struct CodeModel {
    inputs: Option<Inputs>,
    /// The text of the file, which most traces do not change.
    texts: TextLines,
    pub(super) lines: Vec<CodeLine>,
    pub(super) shown: Vec<Shown>,
    /// Characters of the longest line.
    pub(super) longest: usize,
    /// The choices that the trace offers.
    pub(super) offers: Offers,
}

impl CodeModel {
    /// The file.
    pub(super) fn path(&self) -> Option<&TreePath> {
        self.inputs.as_ref().map(|inputs| &inputs.path)
    }

    /// The text of the file.
    pub(super) fn text(&self) -> Option<&Arc<str>> {
        self.inputs.as_ref().map(|inputs| &inputs.text)
    }

    /// Makes the rows anew if something has changed. `folds`: the folded functions of a file; `typed`: the text that the user has typed into
    /// a file, which has none.
    pub(super) fn update(
        &mut self,
        state: &State,
        shaders: &ShaderSet,
        folds: impl Fn(&TreePath) -> BTreeSet<String>,
        typed: impl Fn(&TreePath) -> Option<Arc<str>>,
    ) {
        let Some((path, text)) = shown_file(state, shaders) else {
            return *self = Self::default();
        };
        let display = state.source.display_path(&path);
        let diagnostics = state.session.diagnostics.iter().chain(state.checks.diagnostics());
        let diagnostics = diagnostics.filter(|found| found.file == display).cloned().collect();
        let (text, folded, diagnostics) = match typed(&path) {
            Some(typed) => {
                let moved = in_typed(diagnostics, &text, &typed);
                (typed, BTreeSet::new(), moved)
            }
            None => (text, folds(&path), diagnostics),
        };
        let inputs = Inputs {
            path,
            text,
            traces: (
                [state.traces.newest(), state.traces.before()].map(Identity::of_any),
                state.traces.progress == Progress::NoPixel,
            ),
            choice: state.traces.choice.clone(),
            diagnostics,
            folded,
        };
        if self.inputs.as_ref() == Some(&inputs) {
            return;
        }
        self.texts.update(&inputs.text);
        self.lines = lines(state, shaders, &inputs, &self.texts);
        let notes = self.lines.iter().flat_map(|line| &line.row.notes);
        self.offers = Offers::new(&state.traces, notes.map(|note| note.done.count).max().unwrap_or(0));
        let about = |line: &CodeLine| inputs.diagnostics.iter().any(|found| found.line == Some(line.row.line));
        for function in &self.texts.functions {
            // Wrong lines are never hidden.
            let is_wrong = self.lines[function.lines.clone()].iter().any(about);
            fold(&mut self.lines, function, !is_wrong && inputs.folded.contains(&function.name));
        }
        self.shown = rows(&mut self.lines, &inputs.diagnostics);
        self.longest = self.lines.iter().map(|line| line.text.chars().count()).max().unwrap_or(0);
        self.inputs = Some(inputs);
    }

    /// Its functions.
    pub(super) fn functions(&self) -> &[Function] {
        &self.texts.functions
    }

    /// The index of the first line whose values the last edit has changed.
    pub(super) fn first_change(&self) -> Option<usize> {
        self.lines.iter().position(|line| line.row.is_first_change)
    }

    /// The index of the first line with an error.
    pub(super) fn first_error(&self) -> Option<usize> {
        let is_error = |line: &CodeLine| matches!(line.message, Some((Severity::Error, _)));
        self.lines.iter().position(is_error)
    }

    /// How many lines have values that the last edit has made or changed.
    pub(super) fn changes(&self) -> usize {
        let is_changed = |line: &&CodeLine| line.row.notes.iter().any(Note::is_changed);
        self.lines.iter().filter(is_changed).count()
    }

    /// The index of the line that a row shows, or the next line below it.
    pub(super) fn line_at(&self, row: usize) -> usize {
        let below = self.shown.get(row..).unwrap_or_default();
        let line = |shown: &Shown| if let Shown::Line(line) = shown { Some(*line) } else { None };
        below.iter().find_map(line).unwrap_or_else(|| self.lines.len().saturating_sub(1))
    }

    /// The index of the row that shows a line, or the last one above it.
    pub(super) fn shown_at(&self, line: usize) -> usize {
        self.shown.iter().rposition(|shown| matches!(shown, Shown::Line(at) if *at <= line)).unwrap_or(0)
    }
}

/// The file that is shown, with its text: the chosen one, that of the newest trace, or that of the picture.
fn shown_file(state: &State, shaders: &ShaderSet) -> Option<(TreePath, Arc<str>)> {
    let known = |path: &TreePath| {
        let saved = state.traces.saved.of(path);
        Some((path.clone(), saved.or_else(|| shaders.author_text(path))?.clone()))
    };
    let first = || shaders.texts.keys().next().and_then(known);
    let found = state.traces.file_shown().and_then(known);
    found.or_else(|| state.file_of_picture().as_ref().and_then(known)).or_else(first)
}

fn lines(state: &State, shaders: &ShaderSet, inputs: &Inputs, texts: &TextLines) -> Vec<CodeLine> {
    let Inputs { path, text, .. } = inputs;
    let line = |(line, row): (&TextLine, Row)| CodeLine {
        text: line.text.clone(),
        parts: line.parts.clone(),
        include: line.include.as_ref().and_then(|name| included(shaders, path, name)),
        row,
        message: None,
        numbers: line.numbers.clone(),
        fold: None,
    };
    texts.lines.iter().zip(state.traces.rows(path, text)).map(line).collect()
}

/// The file that a file includes by a name: beside it first, then from the root, as the compiler looks.
fn included(shaders: &ShaderSet, path: &TreePath, name: &str) -> Option<TreePath> {
    let mut places = path.sibling(name).into_iter().chain(TreePath::parse(name));
    places.find(|place| shaders.texts.contains_key(place))
}

/// Marks the first line of a function. If it is folded, that line shows what the function returns, and whether something in it has changed.
fn fold(lines: &mut [CodeLine], function: &Function, is_folded: bool) {
    let (first, body) = match lines.get_mut(function.lines.clone()) {
        Some([first, body @ ..]) => (first, body),
        _ => return,
    };
    let hidden = if is_folded { body.len() } else { 0 };
    first.fold = Some(Fold { name: function.name.clone(), hidden });
    if is_folded {
        let returns = body.iter().flat_map(|line| &line.row.notes).filter(|note| note.done.act == Act::Return);
        // In front, where there is room for sure.
        let returns: Vec<Note> = returns.cloned().collect();
        first.row.notes.splice(0..0, returns);
        first.row.is_first_change |= body.iter().any(|line| line.row.is_first_change);
        let is_reached = body.iter().any(|line| line.row.reach == Reach::Reached);
        let is_missed = body.iter().any(|line| line.row.reach == Reach::Missed);
        first.row.reach = match (is_reached, is_missed) {
            (true, _) => Reach::Reached,
            (false, true) => Reach::Missed,
            (false, false) => first.row.reach,
        };
    }
}

/// Diagnostics about the saved text at the lines of the typed one. Those about lines that were typed over are left out.
fn in_typed(mut diagnostics: Vec<Diagnostic>, saved: &str, typed: &str) -> Vec<Diagnostic> {
    if diagnostics.is_empty() || saved == typed {
        return diagnostics;
    }
    let before = lines_before(saved, typed);
    let lines: [Vec<&str>; 2] = [saved, typed].map(|text| text.lines().collect());
    let line = |old: u32| {
        let new = before.iter().position(|before| *before == Some(old))?;
        (lines[0].get(old as usize - 1) == lines[1].get(new)).then_some(new as u32 + 1)
    };
    diagnostics.retain_mut(|found| match found.line.map(line) {
        Some(None) => false,
        moved => {
            found.line = moved.flatten();
            true
        }
    });
    diagnostics
}

/// The lines with the messages about them, without those that are folded.
fn rows(lines: &mut [CodeLine], diagnostics: &[Diagnostic]) -> Vec<Shown> {
    let mut shown = Vec::new();
    let about = |line: Option<u32>| diagnostics.iter().filter(move |found| found.line == line);
    let message = |found: &Diagnostic| Shown::Message(found.severity, found.message.replace('\n', " "));
    shown.extend(about(None).map(message));
    let mut hidden = 0;
    for (index, line) in lines.iter_mut().enumerate() {
        if hidden > 0 {
            hidden -= 1;
            continue;
        }
        hidden = line.fold.as_ref().map_or(0, |fold| fold.hidden);
        shown.push(Shown::Line(index));
        shown.extend(about(Some(line.row.line)).map(message));
        let first = about(Some(line.row.line)).min_by_key(|found| found.severity);
        line.message = first.map(|found| (found.severity, found.message.replace('\n', " ")));
    }
    shown
}
