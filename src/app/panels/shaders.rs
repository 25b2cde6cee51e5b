//! The panel Shaders: the state of the tree above, below it the files, the stages, the problems or the last edits. An error changes
//! neither the height of the upper part nor what lies below.

mod edits;
mod files;
mod problems;
mod stages;

use egui::{Align, Layout, RichText, Ui};

use crate::app::command::file::OPEN_EDITOR;
use crate::app::command::shaders::RELOAD;
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::editor::Place;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::State;
use crate::app::state::shaders::status::ShaderStatus;
use crate::app::widgets::plural;
use crate::app::widgets::rows::elided;
use crate::app::widgets::theme::{ACCENT, ERROR, QUIET};
use crate::shader::{Diagnostic, Severity};
pub(super) use stages::short_figures;

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Shaders", Group::Shaders, "files includes stages problems driver registers", || {
        Box::<ShadersState>::default()
    })
    .scrolls_itself();

/// Tab that the lower part of the panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Tab {
    #[default]
    Stages,
    Files,
    Problems,
    Edits,
}

/// State of the panel between frames.
#[derive(Default)]
pub(super) struct ShadersState {
    tab: Tab,
    files: files::FilesState,
    stages: stages::StagesState,
}

impl PanelUi for ShadersState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        show(ui, context.state, self, &mut commands.list);
    }
}

/// Shows the panel.
fn show(ui: &mut Ui, state: &State, own: &mut ShadersState, commands: &mut Vec<Command>) {
    let version = state.session.shaders.is_some().then(|| state.shown_version());
    let diagnostics = &state.session.diagnostics;
    head(ui, &state.shader, version, diagnostics, state.is_cut_short(), commands);
    tree(ui, &state.shader, commands);
    ui.horizontal(|ui| {
        let checked = state.checks.diagnostics();
        let problems = match diagnostics.len() + checked.len() {
            0 => "Problems".to_owned(),
            count => format!("Problems {count}"),
        };
        let tabs = [
            (Tab::Stages, "Stages", "What each stage costs, and how the last edit changed that"),
            (Tab::Files, "Files", "The files of the tree, and which includes which"),
            (Tab::Problems, &problems, "Errors and warnings, by file"),
            (Tab::Edits, "Edits", "The last edits: what they reached, and how long each step took"),
        ];
        for (tab, title, hint) in tabs {
            let mut all = diagnostics.iter().chain(checked);
            let is_wrong = tab == Tab::Problems && all.any(|d| d.severity == Severity::Error);
            let title = RichText::new(title).small();
            let title = if is_wrong { title.color(ERROR) } else { title };
            ui.selectable_value(&mut own.tab, tab, title).on_hover_text(hint);
        }
    });
    match own.tab {
        Tab::Stages => stages::show(ui, state, &mut own.stages, commands),
        Tab::Files => files::show(ui, state, &mut own.files, commands),
        Tab::Problems => problems::show(ui, state, commands),
        Tab::Edits => edits::show(ui, &state.shader.log),
    }
}

/// The state of the shaders, and the button that compiles them again.
fn head(
    ui: &mut Ui,
    status: &ShaderStatus,
    version: Option<u64>,
    diagnostics: &[Diagnostic],
    cut_short: bool,
    commands: &mut Vec<Command>,
) {
    let bar = |ui: &mut Ui| {
        // The button first, so that a long text in a narrow column is elided beside it.
        if ui.button("Reload").on_hover_text("Compile everything again (F5)").clicked() {
            commands.push(RELOAD.with(()));
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
            let (text, hover) = words(status, version, errors, cut_short);
            let text = if errors > 0 && !status.compiling { text.color(ERROR) } else { text };
            ui.add(elided(text)).on_hover_text(hover);
        });
    };
    ui.horizontal(|ui| ui.with_layout(Layout::right_to_left(Align::Center), bar));
}

/// The state of the shaders in a few words, and in a sentence. `version`: the one on screen, once there are shaders.
fn words(status: &ShaderStatus, version: Option<u64>, errors: usize, cut_short: bool) -> (RichText, &'static str) {
    // No spinner: on a software device its frames would slow the compilation down.
    match (status.compiling, errors) {
        (true, _) => ("Compiling…".into(), "The picture stays until the new shaders are ready"),
        (_, 0) => match version {
            None => ("No shaders yet".into(), "The first shaders have not compiled yet"),
            Some(version) => {
                (format!("Version {version}").into(), "The version on screen, as the panel Timeline counts")
            }
        },
        (_, errors) if cut_short => {
            (plural(errors, "error").into(), "A loop did not end, so the picture is incomplete")
        }
        (_, errors) => (plural(errors, "error").into(), "The picture still uses the last shaders that compiled"),
    }
}

/// The folder or file to edit, which opens in the editor.
fn tree(ui: &mut Ui, status: &ShaderStatus, commands: &mut Vec<Command>) {
    let text = RichText::new(&status.tree).small();
    let Some(folder) = &status.location else {
        ui.add(elided(text.color(QUIET))).on_hover_text(&status.tree);
        return;
    };
    let label = ui.add(elided(text.color(ACCENT)).sense(egui::Sense::click()));
    if label.clicked() {
        commands.push(OPEN_EDITOR.with(Place { file: folder.clone(), line: None, column: None }));
    }
    let hint = format!("{}\nSave a file here and the picture updates. Click to open it in the editor", status.tree);
    label.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_text(hint);
}
