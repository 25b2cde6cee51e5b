//! The values of a line, at the right end of what is in sight.

use std::sync::Arc;

use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{Color32, CursorIcon, Galley, Rect, RichText, Sense, Ui, WidgetInfo, WidgetType, pos2, vec2};

use super::bar;
use super::hover;
use super::model::CodeLine;
use crate::app::commands::Commands;
use crate::app::source_line::watch;
use crate::app::state::State;
use crate::app::state::trace::Progress;
use crate::app::state::trace::rows::{NEW, Note};
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{ACCENT, CODE_KEYWORD, CODE_VALUE, ERROR, QUIET, small_mono_font};
use crate::shader::TreePath;
use crate::shader::trace::{Act, TracedValue};

/// Points between code and values, and between two values.
pub(super) const GAP: f32 = 14.0;
/// Points between a bar and its value.
const BAR_GAP: f32 = 5.0;
/// Points to the right of the values.
const MARGIN: f32 = 8.0;
/// Values without this many points are left out.
const LEAST: f32 = 3.0 * GAP;

/// The values of a line as they are laid out.
pub(super) struct Values<'a> {
    laid_out: Vec<(&'a Note, Arc<Galley>, Option<TracedValue>)>,
    /// Those for which there is no room, and their mark.
    left_out: Option<(Vec<&'a Note>, Arc<Galley>)>,
    /// Where they begin; infinite without values.
    pub(super) start: f32,
}

impl<'a> Values<'a> {
    /// Lays out the values of a line, in the part of its row that is in sight: as many as there is room for behind the code, or else in
    /// `least` points. Where there is no room for all, those that are 0 come last, as the lobes that a material lacks. `is_old`: they are of a
    /// version before the shown text.
    pub(super) fn new(
        ui: &Ui,
        (line, is_old): (&'a CodeLine, bool),
        (sight, code_end): (Rect, f32),
        least: f32,
    ) -> Self {
        let right = sight.right() - MARGIN;
        let most = (right - code_end - GAP).max(least);
        let lay_out = |notes: &[&'a Note]| {
            let (mut laid_out, mut total) = (Vec::new(), 0.0);
            for note in notes {
                let gap = if laid_out.is_empty() { 0.0 } else { GAP };
                let room = most - total - gap;
                if room < LEAST {
                    break;
                }
                let bar = bar::value(note);
                let of_bar = if bar.is_some() { bar::WIDTH + BAR_GAP } else { 0.0 };
                let galley = |before: Option<&str>| {
                    let mut job = job_of(note, before, is_old);
                    job.wrap = TextWrapping::truncate_at_width(room - of_bar);
                    ui.painter().layout_job(job)
                };
                let whole = galley(note.before.as_deref());
                // The new value is wanted more than the old one.
                let galley = if whole.elided && note.before.is_some() { galley(Some("…")) } else { whole };
                total += gap + of_bar + galley.size().x;
                laid_out.push((*note, galley, bar));
            }
            (laid_out, total)
        };
        let mut notes: Vec<&Note> = line.row.notes.iter().collect();
        let (mut laid_out, mut total) = lay_out(&notes);
        if laid_out.len() < notes.len() {
            notes.sort_by_key(|note| is_zero(note));
            (laid_out, total) = lay_out(&notes);
        }
        let rest = notes.split_off(laid_out.len());
        let left_out = (!rest.is_empty()).then(|| {
            let text = format!("+{}", rest.len());
            let galley = ui.painter().layout_no_wrap(text, small_mono_font(), QUIET.color());
            total += galley.size().x + if laid_out.is_empty() { 0.0 } else { GAP };
            (rest, galley)
        });
        let start = if line.row.notes.is_empty() { f32::INFINITY } else { right - total };
        Self { laid_out, left_out, start }
    }

    /// Shows them.
    pub(super) fn show(
        self,
        ui: &mut Ui,
        (state, path): (&State, &TreePath),
        (line, sight): (&CodeLine, Rect),
        commands: &mut Commands,
    ) {
        let mut x = self.start;
        for (index, (note, galley, bar)) in self.laid_out.into_iter().enumerate() {
            let (size, begin) = (galley.size(), x);
            if bar.is_some() {
                x += bar::WIDTH + BAR_GAP;
            }
            let area = Rect::from_x_y_ranges(begin..=x + size.x, sight.y_range()).expand2(vec2(3.0, 0.0));
            let expression =
                expression(note).filter(|_| state.session.shaders.as_ref().is_some_and(|of| of.can_watch(path)));
            let sense = if expression.is_some() { Sense::click() } else { Sense::hover() };
            let response = ui.interact(area, ui.id().with(("note", line.row.line, index)), sense);
            spoken::button(&response, &note.text());
            if response.hovered() {
                ui.painter().rect_filled(area, 3.0, ui.visuals().widgets.inactive.weak_bg_fill);
            }
            bar.into_iter().for_each(|value| bar::draw(ui.painter(), (begin, sight.center().y), value));
            ui.painter().galley(pos2(x, sight.center().y - size.y / 2.0), galley, CODE_VALUE.color());
            commands.sight.around |= response.hovered() && bar.is_some();
            if let Some(name) = expression.as_ref().filter(|_| response.clicked()) {
                watch(&mut commands.settings, format!("{path}:{}:{name}", line.row.line));
                commands.settings.expression.evaluation = state.traces.choice.evaluation(&note.done);
            }
            let is_link = expression.is_some();
            let response = if is_link { response.on_hover_cursor(CursorIcon::PointingHand) } else { response };
            response.on_hover_ui(|ui| hover::show(ui, state, (path, line), note, expression.as_deref()));
            x += size.x + GAP;
        }
        let Some((rest, mark)) = self.left_out else { return };
        let area = Rect::from_x_y_ranges(x..=x + mark.size().x, sight.y_range());
        let response = ui.interact(area, ui.id().with(("left out", line.row.line)), Sense::hover());
        ui.painter().galley(pos2(x, sight.center().y - mark.size().y / 2.0), mark, QUIET.color());
        let all = rest.iter().map(|note| note.text()).collect::<Vec<_>>().join("\n");
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &all));
        response.on_hover_text(RichText::new(all).font(small_mono_font()));
    }
}

/// Whether a value is 0, and was before.
fn is_zero(note: &Note) -> bool {
    let mut values = note.done.values();
    matches!(note.done.act, Act::Store | Act::Argument)
        && !note.is_changed()
        && values.all(|value| value.numbers().all(|number| number == 0.0))
}

/// The expression that shows a value over the model.
fn expression(note: &Note) -> Option<String> {
    let name = &note.done.name;
    match note.done.act {
        Act::Store | Act::Argument if !name.is_empty() && !name.contains("[ ]") => Some(name.clone()),
        Act::Return if name.is_empty() => Some("return".to_owned()),
        _ => None,
    }
}

/// Whether the values are of a version before the text: of one before the shaders in use, which is being traced, or of the last one that compiled.
pub(super) fn are_old(state: &State) -> bool {
    if state.has_errors() {
        return true;
    }
    let traced = state.traces.newest().map(|newest| newest.of.picture.shaders.generation);
    let is_done = state.traces.progress == Progress::Done;
    !is_done && state.session.shaders.as_ref().is_some_and(|now| traced.is_some_and(|traced| traced != now.generation))
}

/// `before`: the text of the value in the version before, if it differs.
fn job_of(note: &Note, before: Option<&str>, is_old: bool) -> LayoutJob {
    let mut job = LayoutJob::default();
    let mut add = |text: &str, color: Color32| {
        let format = TextFormat { font_id: small_mono_font(), color, ..TextFormat::default() };
        job.append(text, 0.0, format);
    };
    let is_branch = matches!(note.done.act, Act::Condition | Act::Discard | Act::Leave);
    if note.is_new {
        add(NEW, ACCENT.color());
    }
    add(&note.label, QUIET.color());
    if let Some(before) = before {
        add(before, QUIET.color());
        add(" → ", QUIET.color());
    }
    let color = match (note.is_bad, note.is_changed(), is_branch) {
        (true, ..) => ERROR,
        (_, true, _) => ACCENT,
        (.., true) => CODE_KEYWORD,
        _ => CODE_VALUE,
    };
    add(&note.values, if is_old { QUIET.color() } else { color.color() });
    job
}
