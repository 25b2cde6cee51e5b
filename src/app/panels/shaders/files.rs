//! The files of the tree in their folders. A file unfolds to what it includes and what includes it; a click on a name opens it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

use egui::{Align2, Color32, CursorIcon, Rect, RichText, ScrollArea, Sense, Ui, pos2, vec2};

use crate::app::command::file::OPEN_EDITOR;
use crate::app::command::program::SAY;
use crate::app::command::spec::Command;
use crate::app::editor::Place;
use crate::app::state::State;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{ACCENT, ERROR, QUIET, WARNING, body_font, small_font};
use crate::shader::{IncludeGraph, Severity, ShaderSet, TreePath};

/// Height of a row, in points.
const ROW: f32 = 17.0;
/// Indentation of a level, in points.
const INDENT: f32 = 12.0;

/// State of the list between frames.
#[derive(Default)]
pub(super) struct FilesState {
    search: String,
    /// Folders that are closed, and files that are unfolded.
    closed: BTreeSet<String>,
    unfolded: BTreeSet<TreePath>,
    graph: IncludeGraph,
    /// The texts when the tree was opened.
    first: BTreeMap<TreePath, Arc<str>>,
    /// Files whose texts differ from these.
    edited: BTreeSet<TreePath>,
    /// The generation and the tree of `graph`.
    of: (u64, String),
}

impl FilesState {
    fn update(&mut self, shaders: &ShaderSet, tree: &str) {
        let of = (shaders.generation, tree.to_owned());
        if self.of == of {
            return;
        }
        if self.of.1 != of.1 || self.first.is_empty() {
            self.first.clone_from(&shaders.texts);
        }
        let texts = shaders.texts.iter().filter(|(path, _)| shaders.is_authored(path.as_str()));
        let texts: BTreeMap<_, _> = texts.map(|(path, text)| (path.clone(), text.clone())).collect();
        self.graph = IncludeGraph::new(&texts, std::mem::take(&mut self.graph));
        let differs = |(path, text): &(&TreePath, &Arc<str>)| self.first.get(*path) != Some(*text);
        self.edited = shaders.texts.iter().filter(differs).map(|(path, _)| path.clone()).collect();
        self.of = of;
    }
}

/// A row of the list.
#[derive(Clone, Debug, PartialEq)]
enum FileRow {
    Folder {
        path: String,
        depth: usize,
        is_open: bool,
        files: usize,
    },
    File {
        path: TreePath,
        depth: usize,
    },
    /// A file that the file above includes, or that includes it.
    Include {
        path: TreePath,
        depth: usize,
        is_included: bool,
    },
}

/// The rows in sight: folders before files, each sorted.
fn rows(graph: &IncludeGraph, search: &str, closed: &BTreeSet<String>, unfolded: &BTreeSet<TreePath>) -> Vec<FileRow> {
    let words = Words::new(search);
    let is_found = |path: &&TreePath| words.are_in(path.as_str());
    let mut files: Vec<&TreePath> = graph.files().filter(is_found).collect();
    // A folder comes before the files beside it.
    let order = |path: &TreePath| -> Vec<(bool, String)> {
        let parts: Vec<&str> = path.as_str().split('/').collect();
        let last = parts.len() - 1;
        parts.iter().enumerate().map(|(index, part)| (index == last, (*part).to_owned())).collect()
    };
    files.sort_by_cached_key(|path| order(path));
    let mut out = Vec::new();
    let mut shown: BTreeSet<&str> = BTreeSet::new();
    for path in &files {
        let text = path.as_str();
        let folders: Vec<&str> = text.match_indices('/').map(|(at, _)| &text[..at]).collect();
        let mut is_open = true;
        for (depth, folder) in folders.iter().enumerate() {
            // Who searches sees what is found.
            let opens = !words.is_empty() || !closed.contains(*folder);
            if is_open && shown.insert(folder) {
                let is_inside =
                    |path: &&&TreePath| path.as_str().strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'));
                let files = files.iter().filter(is_inside).count();
                out.push(FileRow::Folder { path: (*folder).to_owned(), depth, is_open: opens, files });
            }
            is_open &= opens;
        }
        if !is_open {
            continue;
        }
        let depth = folders.len();
        out.push(FileRow::File { path: (*path).clone(), depth });
        if unfolded.contains(*path) {
            let row = |is_included| {
                move |path: &TreePath| FileRow::Include { path: path.clone(), depth: depth + 1, is_included }
            };
            out.extend(graph.includes(path).iter().map(row(true)));
            out.extend(graph.included_by(path).map(row(false)));
        }
    }
    out
}

/// Status mark of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mark {
    Wrong,
    Waiting,
    Edited,
    None,
}

impl Mark {
    fn words(self) -> (Color32, &'static str) {
        match self {
            Self::Wrong => (ERROR.color(), "Has an error"),
            Self::Waiting => (WARNING.color(), "Edited, but not used until the errors in other files are fixed"),
            Self::Edited => (ACCENT.color(), "Edited since the tree was opened"),
            Self::None => (QUIET.color(), "As it was when the tree was opened"),
        }
    }
}

pub(super) fn show(ui: &mut Ui, state: &State, own: &mut FilesState, commands: &mut Vec<Command>) {
    let Some(shaders) = state.session.shaders.clone() else {
        ui.label(RichText::new("Compiling shaders…").small().color(QUIET));
        return;
    };
    own.update(&shaders, &state.shader.tree);
    let field = search::field(ui, &mut own.search, "files", 0.0);
    field.on_hover_text("Files that no stage includes are not listed");
    let rows = rows(&own.graph, &own.search, &own.closed, &own.unfolded);
    if rows.is_empty() {
        Words::new(&own.search).no_match(ui, "file");
    }
    let spacing = std::mem::replace(&mut ui.spacing_mut().item_spacing.y, 0.0);
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, rows.len(), |ui, range| {
        for row in &rows[range] {
            show_row(ui, state, &shaders, row, own, commands);
        }
    });
    ui.spacing_mut().item_spacing.y = spacing;
}

fn show_row(
    ui: &mut Ui,
    state: &State,
    shaders: &ShaderSet,
    row: &FileRow,
    own: &mut FilesState,
    commands: &mut Vec<Command>,
) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    match row {
        FileRow::Folder { path, depth, is_open, files } => {
            let name = path.rsplit('/').next().unwrap_or(path);
            let response = ui.interact(rect, ui.id().with(("folder", path)), Sense::click());
            spoken::button(&response, &format!("{path}/"));
            let x = rect.left() + INDENT * *depth as f32;
            arrow(ui, x, rect, *is_open);
            text(ui, x + INDENT, rect, name, ui.visuals().text_color(), response.hovered());
            let count = pos2(rect.right() - 4.0, rect.center().y);
            ui.painter().text(count, Align2::RIGHT_CENTER, files.to_string(), small_font(), QUIET.color());
            if response.on_hover_text(format!("{path}/: {files} files")).clicked() && !own.closed.remove(path) {
                own.closed.insert(path.clone());
            }
        }
        FileRow::File { path, depth } => {
            let display = state.source.display_path(path);
            let mark = mark(state, own, path, &display);
            let x = rect.left() + INDENT * *depth as f32;
            let is_unfolded = own.unfolded.contains(path);
            let fold = Rect::from_min_size(pos2(x, rect.top()), vec2(INDENT, ROW));
            let folds = ui.interact(fold, ui.id().with(("fold", path)), Sense::click());
            spoken::button(&folds, &format!("Includes of {path}"));
            arrow(ui, x, rect, is_unfolded);
            if folds.on_hover_text("What it includes, and what includes it").clicked() && !own.unfolded.remove(path) {
                own.unfolded.insert(path.clone());
            }
            let name = path.as_str().rsplit('/').next().unwrap_or_default();
            let response = ui.interact(rect.with_min_x(fold.right()), ui.id().with(("file", path)), Sense::click());
            spoken::button(&response, path.as_str());
            let color = if mark == Mark::None { ui.visuals().text_color() } else { mark.words().0 };
            text(ui, fold.right(), rect, name, color, response.hovered());
            if mark != Mark::None {
                ui.painter().circle_filled(pos2(rect.right() - 8.0, rect.center().y), 3.0, color);
            }
            open_on_click(response, &display, commands, |ui| about(ui, shaders, &own.graph, path, mark));
        }
        FileRow::Include { path, depth, is_included } => {
            let display = state.source.display_path(path);
            let x = rect.left() + INDENT * (*depth as f32 + 1.0);
            let response = ui.interact(rect, ui.id().with(("include", row_id(row), rect.top() as i32)), Sense::click());
            let word = if *is_included { "includes" } else { "included by" };
            let words = format!("{word} {path}");
            spoken::button(&response, &words);
            text(ui, x, rect, &words, QUIET.color(), response.hovered());
            let mark = mark(state, own, path, &display);
            open_on_click(response, &display, commands, |ui| about(ui, shaders, &own.graph, path, mark));
        }
    }
}

fn row_id(row: &FileRow) -> (&str, bool) {
    match row {
        FileRow::Folder { path, .. } => (path, false),
        FileRow::File { path, .. } => (path.as_str(), false),
        FileRow::Include { path, is_included, .. } => (path.as_str(), *is_included),
    }
}

fn mark(state: &State, own: &FilesState, path: &TreePath, display: &str) -> Mark {
    let is_error = |d: &crate::shader::Diagnostic| d.severity == Severity::Error && d.file == display;
    if state.session.diagnostics.iter().any(is_error) {
        Mark::Wrong
    } else if state.shader.log.is_waiting(display) {
        Mark::Waiting
    } else if own.edited.contains(path) {
        Mark::Edited
    } else {
        Mark::None
    }
}

/// A triangle that points to the right, or down if what it belongs to is open.
fn arrow(ui: &Ui, x: f32, rect: Rect, is_open: bool) {
    let center = pos2(x + 5.0, rect.center().y);
    let points = match is_open {
        true => vec![center + vec2(-3.0, -1.5), center + vec2(3.0, -1.5), center + vec2(0.0, 2.5)],
        false => vec![center + vec2(-1.5, -3.0), center + vec2(2.5, 0.0), center + vec2(-1.5, 3.0)],
    };
    ui.painter().add(egui::Shape::convex_polygon(points, QUIET, egui::Stroke::NONE));
}

fn text(ui: &Ui, x: f32, rect: Rect, words: &str, color: Color32, is_hovered: bool) {
    let color = if is_hovered { ui.visuals().strong_text_color() } else { color };
    let clip = ui.painter().with_clip_rect(rect.with_max_x(rect.right() - 16.0).intersect(ui.clip_rect()));
    clip.text(pos2(x + 2.0, rect.center().y), Align2::LEFT_CENTER, words, body_font(), color);
}

/// Opens the file, as displayed, on a click. A file in the program has no place to open; its name is copied.
fn open_on_click(response: egui::Response, display: &str, commands: &mut Vec<Command>, about: impl FnOnce(&mut Ui)) {
    let is_on_disk = !display.starts_with("embedded:");
    if response.clicked() {
        match is_on_disk {
            true => commands.push(OPEN_EDITOR.with(Place { file: PathBuf::from(display), line: None, column: None })),
            false => commands.push(SAY.with(
                "this file is built in. `specula new DIR` writes the tree to a folder where you can edit it".into(),
            )),
        }
    }
    response.on_hover_cursor(CursorIcon::PointingHand).on_hover_ui(|ui| {
        ui.set_max_width(360.0);
        about(ui);
        if is_on_disk {
            ui.label(RichText::new("Click to open it in the editor").small().color(QUIET));
        }
    });
}

/// The hover text of a file.
fn about(ui: &mut Ui, shaders: &ShaderSet, graph: &IncludeGraph, path: &TreePath, mark: Mark) {
    let list = |names: Vec<&str>| match names.len() {
        0 => "nothing".to_owned(),
        1..=12 => names.join(", "),
        count => format!("{} and {} more", names[..10].join(", "), count - 10),
    };
    let reaches = shaders.stages.iter().filter(|(_, stage)| stage.dependencies.contains(path));
    let reaches: Vec<&str> = reaches.map(|(stage, _)| shaders.name_of(stage)).collect();
    ui.label(RichText::new(shaders.name_of(path.as_str())).strong());
    let (color, meaning) = mark.words();
    ui.label(RichText::new(meaning).small().color(color));
    let included_by = graph.included_by(path).map(|path| shaders.name_of(path.as_str())).collect();
    let includes = graph.includes(path).iter().map(|path| shaders.name_of(path.as_str())).collect();
    for (title, names) in [("Includes", includes), ("Included by", included_by), ("An edit recompiles", reaches)] {
        ui.label(RichText::new(format!("{title}: {}", list(names))).small());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph() -> IncludeGraph {
        let files = [
            ("pbr.frag", "#include \"brdf/ndf.glsl\"\n"),
            ("brdf/ndf.glsl", "#include \"common.glsl\"\n"),
            ("brdf/layers/sheen.glsl", ""),
            ("common.glsl", ""),
        ];
        let texts = files.iter().map(|(path, text)| (TreePath::from(*path), Arc::from(*text))).collect();
        IncludeGraph::new(&texts, IncludeGraph::default())
    }

    fn words(rows: &[FileRow]) -> Vec<String> {
        let words = |row: &FileRow| match row {
            FileRow::Folder { path, depth, is_open, files } => {
                format!("{}{} {path}/ {files}", " ".repeat(*depth), if *is_open { "-" } else { "+" })
            }
            FileRow::File { path, depth } => format!("{}{path}", " ".repeat(*depth)),
            FileRow::Include { path, depth, is_included } => {
                format!("{}{} {path}", " ".repeat(*depth), if *is_included { ">" } else { "<" })
            }
        };
        rows.iter().map(words).collect()
    }

    #[test]
    fn folders_come_before_files_and_fold() {
        let none = BTreeSet::new();
        let all = rows(&graph(), "", &none, &BTreeSet::new());
        let expected =
            ["- brdf/ 2", " - brdf/layers/ 1", "  brdf/layers/sheen.glsl", " brdf/ndf.glsl", "common.glsl", "pbr.frag"];
        assert_eq!(words(&all), expected);
        let closed = BTreeSet::from(["brdf".to_owned()]);
        let folded = rows(&graph(), "", &closed, &BTreeSet::new());
        assert_eq!(words(&folded), ["+ brdf/ 2", "common.glsl", "pbr.frag"]);
        // A search unfolds what it finds.
        assert_eq!(words(&rows(&graph(), "NDF", &closed, &BTreeSet::new())), ["- brdf/ 1", " brdf/ndf.glsl"]);
    }

    #[test]
    fn a_file_unfolds_to_its_includes_in_both_directions() {
        let unfolded = BTreeSet::from([TreePath::from("brdf/ndf.glsl")]);
        let rows = rows(&graph(), "ndf", &BTreeSet::new(), &unfolded);
        assert_eq!(words(&rows), ["- brdf/ 1", " brdf/ndf.glsl", "  > common.glsl", "  < pbr.frag"]);
    }
}
