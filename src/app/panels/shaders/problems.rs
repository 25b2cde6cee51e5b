//! Errors and warnings by file. A click opens the place in the editor.

use std::path::PathBuf;

use egui::{CursorIcon, RichText, ScrollArea, Sense, Ui};

use crate::app::command::file::OPEN_EDITOR;
use crate::app::command::spec::Command;
use crate::app::editor::Place;
use crate::app::state::State;
use crate::app::widgets::elide::middle;
use crate::app::widgets::plural;
use crate::app::widgets::rows::elided;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ACCENT, ERROR, QUIET, WARNING, small_font};
use crate::shader::{Diagnostic, Severity};

/// Height of a line, in points.
const HEIGHT: f32 = 16.0;

/// A line of the list.
enum Line<'a> {
    /// A file, with the number of its diagnostics.
    File(&'a str, usize),
    Diagnostic(&'a Diagnostic),
}

/// The diagnostics by file, in the order in which the files come first.
fn grouped<'a>(diagnostics: impl Iterator<Item = &'a Diagnostic>, words: &Words) -> Vec<Line<'a>> {
    let is_found = |diagnostic: &&Diagnostic| words.are_in(&text_of(diagnostic));
    let diagnostics: Vec<&Diagnostic> = diagnostics.filter(is_found).collect();
    let mut files: Vec<&str> = Vec::new();
    for diagnostic in &diagnostics {
        if !files.contains(&diagnostic.file.as_str()) {
            files.push(&diagnostic.file);
        }
    }
    let lines = files.into_iter().flat_map(|file| {
        let own: Vec<&Diagnostic> = diagnostics.iter().copied().filter(|diagnostic| diagnostic.file == file).collect();
        std::iter::once(Line::File(file, own.len())).chain(own.into_iter().map(Line::Diagnostic))
    });
    lines.collect()
}

pub(super) fn show(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    let diagnostics = || state.session.diagnostics.iter().chain(state.checks.diagnostics());
    let count = diagnostics().count();
    if count == 0 {
        ui.label(RichText::new("No errors and no warnings").small().color(QUIET));
        return;
    }
    let words = search::above_kept(ui, "problems", count);
    let lines = grouped(diagnostics(), &words);
    if lines.is_empty() {
        words.no_match(ui, "problem");
    }
    let has_files = state.shader.location.is_some();
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, HEIGHT, lines.len(), |ui, range| {
        for line in &lines[range] {
            match line {
                Line::File(file, count) => {
                    let text = format!("{file}   {}", plural(*count, "problem"));
                    let shown = middle(ui.painter(), &text, &small_font(), ui.available_width());
                    ui.add(elided(RichText::new(shown).small().strong())).on_hover_text(*file);
                }
                Line::Diagnostic(diagnostic) => one(ui, diagnostic, has_files, commands),
            }
        }
    });
}

/// The text that the search looks into.
fn text_of(diagnostic: &Diagnostic) -> String {
    let kind = if diagnostic.severity == Severity::Error { "error" } else { "warning" };
    format!("{kind} {} {}", diagnostic.file, diagnostic.message)
}

fn one(ui: &mut Ui, diagnostic: &Diagnostic, has_files: bool, commands: &mut Vec<Command>) {
    let color = if diagnostic.severity == Severity::Error { ERROR } else { WARNING };
    let place = match (diagnostic.line, diagnostic.column) {
        (Some(line), Some(column)) => format!("{line}:{column}"),
        (Some(line), None) => line.to_string(),
        _ => String::new(),
    };
    ui.horizontal(|ui| {
        ui.add_space(10.0);
        ui.label(RichText::new(place).monospace().small().color(if has_files { ACCENT } else { QUIET }));
        let text = RichText::new(&diagnostic.message).small().color(color);
        let label = ui.add(elided(text).sense(Sense::click()));
        if label.clicked() {
            let Diagnostic { file, line, column, .. } = diagnostic;
            match has_files {
                true => {
                    commands.push(OPEN_EDITOR.with(Place { file: PathBuf::from(file), line: *line, column: *column }))
                }
                false => ui.ctx().copy_text(diagnostic.one_line()),
            }
        }
        let hint = if has_files { "Click to open it in the editor" } else { "Click to copy it" };
        let hover = format!("{}\n{hint}", diagnostic.full().trim_end());
        label.on_hover_cursor(CursorIcon::PointingHand).on_hover_ui(|ui| {
            ui.set_max_width(700.0);
            ui.label(RichText::new(hover).monospace());
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagnostics_of_a_file_stand_together() {
        let of = |file: &str, message: &str| Diagnostic::error(file, message);
        let diagnostics = [of("b.glsl", "1"), of("a.glsl", "2"), of("b.glsl", "3")];
        let words = |line: &Line<'_>| match line {
            Line::File(file, count) => format!("{file} {count}"),
            Line::Diagnostic(diagnostic) => diagnostic.message.clone(),
        };
        let lines =
            |search: &str| grouped(diagnostics.iter(), &Words::new(search)).iter().map(words).collect::<Vec<String>>();
        assert_eq!(lines(""), ["b.glsl 2", "1", "3", "a.glsl 1", "2"]);
        assert_eq!(lines("ERROR b.glsl 3"), ["b.glsl 1", "3"]);
        assert!(lines("warning").is_empty());
    }
}
