//! Above the code: the file, the pixel, whether the trace is the picture's, and which fragment, call and time are shown.

use std::path::PathBuf;

use egui::{ComboBox, Key, Label, PopupCloseBehavior, RichText, ScrollArea, Ui};
use similar::TextDiff;

use super::choices::{self, MENU};
use super::edit::Editor;
use super::fold::Folds;
use super::model::CodeModel;
use super::scroll::Scroll;
use crate::app::command::file::OPEN_EDITOR;
use crate::app::command::scene::UNPIN;
use crate::app::command::source::{CHOOSE_STAGE, SAVE_FILE, SHOW_FILE};
use crate::app::commands::Commands;
use crate::app::editor::Place;
use crate::app::panels::draft::show_draft;
use crate::app::state::State;
use crate::app::state::shaders::edits::NO_FOLDER;
use crate::app::state::trace::{PixelTrace, Progress};
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{ACCENT, ERROR, GOOD, QUIET, WARNING, icon, small_mono};
use crate::shader::trace::TraceableStage;
use crate::shader::{ShaderSet, TreePath};

/// Width of the list of files, points.
const FILES: f32 = 176.0;
/// Width of the list of stages, points.
const STAGES: f32 = 130.0;
/// Points that the words about changes take.
const WIDTH_OF_CHANGES: f32 = 150.0;

/// Shows the rows above the code.
pub(super) fn show(
    ui: &mut Ui,
    state: &State,
    (shaders, model): (&ShaderSet, &CodeModel),
    (editor, folds, scroll): (&mut Editor, &mut Folds, &mut Scroll),
    commands: &mut Commands,
) {
    let newest = state.traces.newest();
    // Two rows whose buttons stay where they are, whatever is told behind them.
    ui.horizontal(|ui| {
        files(ui, state, shaders, model, newest.map(|newest| &**newest), commands);
        if let Some(newest) = newest.filter(|newest| newest.stages.len() > 1) {
            stages(ui, newest, commands);
        }
        if !model.path().is_some_and(|path| editor.has(path)) {
            folds.menu(ui, model);
        }
        open_in_editor(ui, state, model, commands);
        edit(ui, state, model, (editor, scroll), commands);
        if let Some(draft) = &state.edits.draft {
            show_draft(ui, state, draft, true, &mut commands.list);
        }
        // The choices leave too little room in their row.
        let is_unsaved = model.path().is_some_and(|path| editor.is_unsaved(path));
        progress(ui, state, newest.map(|newest| &**newest), is_unsaved);
    });
    ui.horizontal(|ui| {
        pixel(ui, state, commands);
        let trace = newest.and_then(|newest| newest.trace.as_ref().ok());
        if let Some((trace, fragment)) = trace.zip(state.traces.fragment()) {
            choices::show(ui, &state.traces.choice, (trace, &model.offers), fragment, commands);
        }
        changes(ui, state, model, scroll);
    });
    ui.add_space(2.0);
}

/// The list of files: those that the pixel's stage has first.
fn files(
    ui: &mut Ui,
    state: &State,
    shaders: &ShaderSet,
    model: &CodeModel,
    newest: Option<&PixelTrace>,
    commands: &mut Commands,
) {
    let shown = model.path().map(TreePath::as_str);
    let of_stage: Vec<TreePath> =
        newest.map(|of| of.files.iter().map(|file| TreePath::from(file.as_str())).collect()).unwrap_or_default();
    let list = ComboBox::from_id_salt("file")
        .selected_text(small_mono(shown.map_or("no file", |path| shaders.name_of(path))))
        .width(FILES)
        .height(MENU)
        .truncate();
    let id = ui.id().with("search of files");
    let list = list.close_behavior(PopupCloseBehavior::CloseOnClickOutside).show_ui(ui, |ui| {
        let typed: Option<String> = ui.data(|data| data.get_temp(id));
        let is_opening = typed.is_none();
        let mut typed = typed.unwrap_or_default();
        let field = search::field(ui, &mut typed, "files", 0.0);
        if is_opening {
            field.request_focus();
        }
        // Enter chooses the first file.
        let mut takes_first = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let words = Words::new(&typed);
        ui.data_mut(|data| data.insert_temp(id, typed));
        ScrollArea::vertical().max_height(MENU).show(ui, |ui| {
            let mut file = |ui: &mut Ui, path: &TreePath, is_strong: bool| {
                let name = shaders.name_of(path.as_str());
                if !words.are_in(name) {
                    return;
                }
                let text = small_mono(name);
                let text = if is_strong { text } else { text.color(QUIET) };
                if ui.selectable_label(Some(path.as_str()) == shown, text).clicked() || std::mem::take(&mut takes_first)
                {
                    commands.push(SHOW_FILE.with(path.clone()));
                    ui.close();
                }
            };
            if let Some(newest) = newest.filter(|_| !of_stage.is_empty()) {
                ui.label(
                    RichText::new(format!("In {} at this pixel", shaders.name_of(&newest.stage))).small().color(QUIET),
                );
                of_stage.iter().for_each(|path| file(ui, path, true));
            }
            let others = shaders.texts.keys().filter(|path| !of_stage.contains(path) && !is_hidden(path));
            let others: Vec<&TreePath> = others.filter(|path| words.are_in(shaders.name_of(path.as_str()))).collect();
            if !of_stage.is_empty() && !others.is_empty() {
                ui.separator();
                ui.label(RichText::new("Other files").small().color(QUIET));
            }
            others.into_iter().for_each(|path| file(ui, path, false));
        });
    });
    if list.inner.is_none() {
        ui.data_mut(|data| data.remove_temp::<String>(id));
    }
    let of = state.source.name();
    named(list.response, "File")
        .on_hover_text(format!("The file of {of} that is shown. The values are those of its statements"));
}

/// The list of stages that draw the picture.
fn stages(ui: &mut Ui, newest: &PixelTrace, commands: &mut Commands) {
    let is_now = |of: &&TraceableStage| of.path == newest.stage;
    let now = newest.stages.iter().find(is_now).map_or(newest.stage.as_str(), |now| now.label.as_str());
    let list = ComboBox::from_id_salt("stage").selected_text(RichText::new(now).small()).width(STAGES).height(MENU);
    let list = list.truncate().show_ui(ui, |ui| {
        ui.set_min_width(MENU);
        for stage in &newest.stages {
            let text = if stage.label == stage.name {
                stage.name.clone()
            } else {
                format!("{}   {}", stage.label, stage.name)
            };
            if ui.selectable_label(is_now(&stage), RichText::new(text).small()).clicked() {
                commands.push(CHOOSE_STAGE.with(stage.path.clone()));
            }
        }
    });
    named(list.response, "Stage").on_hover_text(
        "The stage whose values are shown: of the surfaces, of their vertices, or of a pass of the picture. Stages of tessellation, \
         geometry and meshes are not traced",
    );
}

/// Whether a path names a stage that only Specula knows.
fn is_hidden(path: &TreePath) -> bool {
    path.as_str().rsplit('/').next().is_some_and(|name| name.starts_with('.'))
}

fn pixel(ui: &mut Ui, state: &State, commands: &mut Commands) {
    match state.inspection.pin {
        Some([x, y]) => {
            let text = small_mono(format!("{x}, {y}")).strong();
            ui.label(text).on_hover_text("The pinned pixel, from the upper left corner of the picture");
            let unpin = named(ui.small_button(icon::X), "Unpin");
            if unpin.on_hover_text("Unpin the pixel: Esc, or a click on the marker").clicked() {
                commands.push(UNPIN.with(()));
            }
        }
        None => {
            let hint = "Click a pixel of the picture to see what each line computes there";
            ui.label(RichText::new(hint).color(ACCENT));
        }
    }
}

/// How far the trace is, and whether its color is the picture's.
/// `is_unsaved`: the shown text is not the one that was traced.
fn progress(ui: &mut Ui, state: &State, newest: Option<&PixelTrace>, is_unsaved: bool) {
    let quiet = |ui: &mut Ui, text: &str| {
        drop(ui.add(Label::new(RichText::new(text).small().color(QUIET)).truncate()));
    };
    if is_unsaved {
        return quiet(ui, "values of the saved text");
    }
    if state.has_errors() && state.traces.progress == Progress::Done && newest.is_some() {
        return quiet(ui, "values of the last version that compiled");
    }
    match (state.traces.progress, newest) {
        // Nothing that moves: frames of a software device would hold the trace up.
        (Progress::UnderWay(_), _) if state.traces.preparations.is_done() => quiet(ui, "Tracing…"),
        (Progress::UnderWay(_), _) => {
            quiet(ui, "Compiling the log of this file, then tracing… Later clicks need no compiling");
        }
        (Progress::Outside, _) => quiet(ui, "outside of the picture"),
        (Progress::AfterLoss, _) => quiet(ui, "After a lost device, nothing is traced until an edit has been drawn"),
        (Progress::Waits, _) if state.inspection.is_pinned() => quiet(ui, "Waiting for the final picture…"),
        (Progress::Done, Some(PixelTrace { trace: Err(message), .. })) => {
            ui.add(Label::new(RichText::new(message).small().color(WARNING)).truncate()).on_hover_text(message);
        }
        (Progress::Done, Some(PixelTrace { trace: Ok(trace), .. })) => {
            let Some(fragment) = state.traces.fragment() else {
                return quiet(ui, "every fragment is discarded here; choose one below");
            };
            let (text, moment) = (trace.proof_text(fragment), moment(state));
            let (mark, color) = if trace.is_proven(fragment) { ("✔ ", GOOD) } else { ("", WARNING) };
            let hint = "The color with which the traced stage ends, compared with the pixel of the picture, bit by bit; where fragments share the pixel, the mean of its samples";
            let later = moment
                .as_ref()
                .map_or("", |_| ". The picture has moved on since: pause, or click another pixel, for values of now");
            let text = RichText::new(format!("{mark}{text}{}", moment.unwrap_or_default())).small().color(color);
            ui.add(Label::new(text).truncate()).on_hover_text(format!("{hint}{later}"));
        }
        _ => {}
    }
}

/// The time of the traced picture, if the picture on screen is of another.
fn moment(state: &State) -> Option<String> {
    let traced = state.traces.newest()?.of.picture.clock.time_s;
    (traced != state.picture.clock.time_s).then(|| format!(", at {traced:.2} s"))
}

/// How many lines the last edit has changed, and the first of them.
fn changes(ui: &mut Ui, state: &State, model: &CodeModel, scroll: &mut Scroll) {
    if state.traces.before().is_none() || state.traces.progress != Progress::Done {
        return;
    }
    let Some(first) = model.first_change() else {
        let text = "no value differs from the version before";
        return drop(ui.add(Label::new(RichText::new(text).small().color(QUIET)).truncate()));
    };
    let line = &model.lines[first].row;
    let whole = format!("first change: line {}, {} in all", line.line, model.changes());
    let text = if ui.available_width() < WIDTH_OF_CHANGES { format!("line {}", line.line) } else { whole.clone() };
    let hint = "Values before and after the last edit stand beside the code. Click to go to the line that differs first, in the order of execution";
    let is_bad = line.notes.iter().any(|note| note.is_bad);
    let button = egui::Button::new(RichText::new(text).small().color(if is_bad { ERROR } else { ACCENT })).frame(false);
    if ui.add(button).on_hover_text(format!("{whole}\n{hint}")).clicked() {
        scroll.to(first);
    }
}

/// The buttons that begin to type into the file, save it and end that.
fn edit(
    ui: &mut Ui,
    state: &State,
    model: &CodeModel,
    (editor, scroll): (&mut Editor, &mut Scroll),
    commands: &mut Commands,
) {
    let Some((path, text)) = model.path().zip(model.text()) else { return };
    if !editor.has(path) {
        let button = ui.add_enabled(editor.can_begin(path), egui::Button::new("Edit").small());
        let hint = "Type into the file. A double click on a line does the same";
        let of_other = "This is a file of the tree before: the shaders of the open one do not compile yet";
        let why_not = match (state.has_files(), state.is_tree_in_use()) {
            (false, _) => NO_FOLDER,
            (true, false) => of_other,
            (true, true) => "The program has added this file to the one that you opened",
        };
        if button.on_hover_text(hint).on_disabled_hover_text(why_not).clicked() {
            editor.begin(path, text, scroll.first);
            scroll.keep();
        }
        return;
    }
    if let Some(theirs) = editor.conflict(path) {
        return settle(ui, path, &theirs, (editor, scroll), commands);
    }
    let is_unsaved = editor.is_unsaved(path);
    let save = ui.add_enabled(is_unsaved, egui::Button::new("Save").small());
    let hint = "Ctrl+S. Changes that another program has made since are kept, unless they are in the same lines";
    if save.on_hover_text(hint).clicked() {
        editor.save(path).into_iter().for_each(|typed| commands.push(SAVE_FILE.with(typed)));
    }
    let (name, hint) = match is_unsaved {
        true => ("Revert", "Drop the changes that were not saved"),
        false => ("Done", "Show the file without typing into it"),
    };
    if ui.small_button(name).on_hover_text(hint).clicked() {
        editor.end(path);
        scroll.keep();
    }
    if is_unsaved {
        ui.label(RichText::new("not saved").small().color(WARNING));
    }
}

/// The choice between what was typed and what another program has written to the same lines.
fn settle(
    ui: &mut Ui,
    path: &TreePath,
    theirs: &str,
    (editor, scroll): (&mut Editor, &mut Scroll),
    commands: &mut Commands,
) {
    let told = RichText::new("not saved: another program has changed the same lines").small().color(WARNING);
    ui.label(told).on_hover_ui(|ui| {
        let typed = editor.text(path).unwrap_or_default();
        let difference = TextDiff::from_lines(theirs, &*typed);
        let difference = difference.unified_diff().context_radius(1).header("theirs", "yours").to_string();
        ui.label(RichText::new(difference).monospace());
    });
    if ui
        .small_button("Save mine")
        .on_hover_text("Write what you typed over the changes of the other program")
        .clicked()
    {
        editor.settle(path, false);
        editor.save(path).into_iter().for_each(|typed| commands.push(SAVE_FILE.with(typed)));
    }
    if ui.small_button("Take theirs").on_hover_text("Drop what you typed, and go on with the file as it is").clicked() {
        editor.settle(path, true);
        scroll.keep();
    }
}

fn open_in_editor(ui: &mut Ui, state: &State, model: &CodeModel, commands: &mut Commands) {
    let Some(path) = model.path() else { return };
    let display = state.source.display_path(path);
    if display.starts_with("embedded:") {
        return;
    }
    if named(ui.small_button("Open"), "Open in editor")
        .on_hover_text(format!("Open {display} in your editor"))
        .clicked()
    {
        commands.push(OPEN_EDITOR.with(Place { file: PathBuf::from(display), line: None, column: None }));
    }
}
