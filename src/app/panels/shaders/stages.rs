//! The stages with their state, their times, and their numbers with the change since the version before.

use std::collections::BTreeSet;

use egui::{Checkbox, Color32, CursorIcon, Grid, RichText, ScrollArea, Sense, Ui};

use crate::app::command::shaders::ASK_DRIVER;
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::state::shaders::stages::{StageRow, StageState};
use crate::app::widgets::check_box;
use crate::app::widgets::elide::middle;
use crate::app::widgets::rows::elided;
use crate::app::widgets::theme::{ERROR, GOOD, QUIET, WARNING, small_font};
use crate::message::grouped;
use crate::pipeline::{Figure, all_statistics};

/// A list narrower than this has two lines for each stage, in points.
const ONE_LINE: f32 = 520.0;
/// Heights of a line, in points.
const LINE: f32 = 16.0;

/// State of the list between frames.
#[derive(Default)]
pub(super) struct StagesState {
    /// Stages whose details are shown.
    open: BTreeSet<String>,
    /// Whether stages that draw nothing are listed.
    shows_all: bool,
}

pub(super) fn show(ui: &mut Ui, state: &State, own: &mut StagesState, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let count = state.stages.rows().len();
        let all = Checkbox::new(&mut own.shows_all, RichText::new(format!("All {count}")).small());
        check_box::show(ui, all).on_hover_text(
            "Also list the stages that the current picture does not use: bakes, other modes, disabled passes",
        );
        ask(ui, state, commands);
    });
    let is_shown = |row: &&StageRow| own.shows_all || row.state <= StageState::Pending;
    let rows: Vec<&StageRow> = state.stages.rows().iter().filter(is_shown).collect();
    if rows.is_empty() {
        ui.label(RichText::new("No picture yet").small().color(QUIET));
    }
    let is_wide = ui.available_width() >= ONE_LINE;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for row in rows {
            let clicked = match is_wide {
                true => ui.horizontal(|ui| title(ui, row, 170.0) | numbers(ui, row)).inner,
                false => {
                    let clicked = ui.horizontal(|ui| title(ui, row, ui.available_width() - 70.0)).inner;
                    let more = ui.horizontal(|ui| {
                        ui.add_space(16.0);
                        numbers(ui, row)
                    });
                    clicked | more.inner
                }
            };
            if clicked && !own.open.remove(&row.path) {
                own.open.insert(row.path.clone());
            }
            if own.open.contains(&row.path) {
                ui.indent(&row.path, |ui| details(ui, row));
            }
        }
    });
}

/// The switch for querying the driver's statistics.
fn ask(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    let tells = state.tells_statistics;
    let hint = match tells {
        true => {
            "Query the driver's statistics for each pipeline of the picture: registers, instructions, spills, code size \
             (VK_KHR_pipeline_executable_properties). The driver builds each pipeline once more for this, in the background \
             while the program is idle"
        }
        false => {
            "This driver lacks VK_KHR_pipeline_executable_properties, so it reports no statistics of its machine code. The \
             SPIR-V word counts below are exact"
        }
    };
    let mut asks = state.shader.asks_driver;
    let switch = Checkbox::new(&mut asks, RichText::new("Ask the driver").small());
    let response = ui.add_enabled_ui(tells, |ui| check_box::show(ui, switch)).inner;
    if response.changed() {
        commands.push(ASK_DRIVER.with(asks));
    }
    response.on_hover_text(hint).on_disabled_hover_text(hint);
}

/// The mark, path and state of a stage. Returns whether it is clicked.
fn title(ui: &mut Ui, row: &StageRow, width: f32) -> bool {
    let (name, meaning) = row.state.words();
    let (rect, _) = ui.allocate_exact_size(egui::vec2(10.0, LINE), Sense::hover());
    ui.painter().circle_filled(rect.center(), 3.5, color(row.state));
    let shown = middle(ui.painter(), &row.name, &small_font(), width.max(60.0));
    let label = elided(RichText::new(shown).small()).selectable(false).sense(Sense::click());
    let left = egui::Layout::left_to_right(egui::Align::Center);
    let response = ui.allocate_ui_with_layout(egui::vec2(width.max(60.0), LINE), left, |ui| {
        ui.set_min_width(width.max(60.0));
        ui.add(label)
    });
    let hover = format!("{}: {meaning}\nClick for details", row.name);
    let clicked = response.inner.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(hover).clicked();
    ui.label(RichText::new(name).small().color(color(row.state))).on_hover_text(meaning);
    clicked
}

fn color(own: StageState) -> Color32 {
    match own {
        StageState::Failed => ERROR.color(),
        StageState::OnScreen => GOOD.color(),
        StageState::Pending => WARNING.color(),
        StageState::Bakes | StageState::Off => QUIET.color(),
    }
}

/// The statistics and times of a stage in a line. Returns whether it is clicked.
fn numbers(ui: &mut Ui, row: &StageRow) -> bool {
    ui.spacing_mut().item_spacing.x = 3.0;
    short_figures(ui, &row.figures);
    let largest = row.now.largest.as_ref();
    let driver = largest.map(|largest| match (largest.driver_ms, largest.is_cached) {
        (_, true) => "cached".to_owned(),
        (Some(ms), _) => format!("{ms:.0} ms"),
        (None, _) => format!("{:.0} ms", largest.pipeline_ms),
    });
    let compile = row.compile_ms.map(|ms| format!("{ms:.0} ms"));
    let times: Vec<String> = compile.into_iter().chain(driver).collect();
    if times.is_empty() {
        return false;
    }
    let times = times.join(" + ");
    let text = RichText::new(format!("· {times}")).monospace().small().color(QUIET);
    let label = ui.add(elided(text).sense(Sense::click()));
    let hover = format!("{times}: the last compilation to SPIR-V, and the driver's time to build the pipeline");
    label.on_hover_text(hover).clicked()
}

/// Statistics with their changes: `4,469 words -212 · 96 registers -8`.
pub(in crate::app::panels) fn short_figures(ui: &mut Ui, figures: &[Figure]) {
    for (index, figure) in figures.iter().enumerate() {
        if index > 0 {
            ui.label(RichText::new("·").small().color(QUIET));
        }
        ui.label(RichText::new(figure.text()).monospace().small()).on_hover_text(&figure.meaning);
        change(ui, figure);
    }
}

/// The change of a statistic since the previous version, if it has changed.
fn change(ui: &mut Ui, figure: &Figure) {
    let (Some(text), Some(change)) = (figure.change_text(), figure.change()) else { return };
    // An increase is not an error, but worth attention.
    let color = if change > 0.0 { WARNING } else { GOOD };
    let before = grouped(figure.before.unwrap_or_default());
    ui.label(RichText::new(text).monospace().small().color(color))
        .on_hover_text(format!("Before the last edit: {before} {}", figure.name));
}

/// All statistics of a stage.
fn details(ui: &mut Ui, row: &StageRow) {
    let mut lines = vec![(
        "Words as compiled",
        grouped(row.now.compiled as f64),
        "SPIR-V before specialization, including code that constants disable",
    )];
    if let Some(largest) = &row.now.largest {
        lines.push((
            "Words with its constants",
            grouped(largest.words_before as f64),
            "What this picture needs, before Specula's optimizer",
        ));
        lines.push((
            "Words given to the driver",
            grouped(largest.words as f64),
            "SPIR-V after specialization and optimization",
        ));
        lines.push((
            "Pipelines in the picture",
            row.now.pipelines.to_string(),
            "One for each kind of material, for example. The numbers are those of the largest",
        ));
        let cached = if largest.is_cached { ", from a cache" } else { "" };
        lines.push((
            "Pipeline",
            format!("{:.1} ms{cached}", largest.pipeline_ms),
            "Driver time to build the pipeline with all of its stages",
        ));
        if let Some(ms) = largest.driver_ms {
            lines.push(("This stage in it", format!("{ms:.1} ms"), "As reported by the driver"));
        }
    }
    lines.extend(
        row.compile_ms.map(|ms| ("Compiled in", format!("{ms:.1} ms"), "The last compilation from GLSL to SPIR-V")),
    );
    Grid::new((&row.path, "lines")).num_columns(2).spacing([10.0, 1.0]).show(ui, |ui| {
        for (name, value, meaning) in lines {
            ui.label(RichText::new(name).small().color(QUIET)).on_hover_text(meaning);
            ui.label(RichText::new(value).monospace().small());
            ui.end_row();
        }
        for (name, figures) in all_statistics(&row.now, row.before.as_ref()) {
            ui.label(RichText::new(name).small().strong()).on_hover_text("The driver's name for its machine code");
            ui.end_row();
            for figure in figures {
                ui.label(RichText::new(&figure.name).small().color(QUIET)).on_hover_text(&figure.meaning);
                ui.horizontal(|ui| {
                    ui.label(RichText::new(grouped(figure.value)).monospace().small());
                    change(ui, &figure);
                });
                ui.end_row();
            }
        }
    });
}
