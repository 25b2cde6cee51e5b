//! Numbers in the code that the mouse drags: the picture and the values follow, and the file stays until they are written.

use egui::{Align2, CursorIcon, LayerId, Order, Rect, Sense, Ui, pos2, vec2};

use super::look::Look;
use super::model::CodeLine;
use crate::app::command::shaders::DRAFT;
use crate::app::commands::Commands;
use crate::app::source_line::SourceLine;
use crate::app::state::State;
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{ACCENT, PANEL, small_mono_font};
use crate::shader::TreePath;
use crate::shader::rewrite::{Literal, spelled_like};

/// Change of a whole number for each point of the mouse.
const WHOLE: f64 = 0.05;
/// The same of another number, as a share of the number or, if that is small, of 0.1.
const SHARE: f64 = 0.005;
/// Shift slows the mouse down by this factor.
const SLOW: f64 = 0.1;

/// The number that is dragged.
#[derive(Default)]
pub(super) struct NumberDrag(Option<Dragged>);

struct Dragged {
    line: SourceLine,
    /// Which of its numbers.
    index: usize,
    /// Its value before it is rounded.
    value: f64,
}

impl Dragged {
    /// The number of a line with this index among `count` numbers. Numbers of the line that are not those of the file stay.
    fn new(state: &State, (path, line): (&TreePath, &CodeLine), (index, count): (usize, usize)) -> Option<Self> {
        let shaders = state.session.shaders.as_ref()?;
        let draft = state.edits.draft.as_ref();
        let base = draft.filter(|draft| draft.path == *path).map(|draft| &draft.base);
        let text = base.or_else(|| shaders.texts.get(path))?;
        let mut line = SourceLine::new(shaders, path, line.row.line, text)?;
        if line.numbers.len() != count {
            return None;
        }
        for edit in draft.into_iter().flat_map(|draft| &draft.edits) {
            let of_edit = line.numbers.iter_mut().find(|(literal, _)| literal.bytes == edit.bytes);
            let new = edit.new.trim_end_matches(['u', 'U', 'f', 'F']).parse().ok();
            of_edit.zip(new).into_iter().for_each(|((_, value), new)| *value = new);
        }
        let value = line.numbers.get(index)?.1;
        Some(Self { line, index, value })
    }

    /// Moves the number. Returns whether that changes it.
    fn drag(&mut self, points: f64) -> bool {
        let (literal, value) = &mut self.line.numbers[self.index];
        let speed = if literal.is_whole { WHOLE } else { SHARE * literal.value.abs().max(0.1) };
        // A sign is not part of the number.
        self.value = (self.value + speed * points).max(0.0);
        let new = rounded(literal, self.value);
        let is_other = *value != new;
        *value = new;
        is_other
    }

    /// The number as it is written.
    fn text(&self) -> String {
        let (literal, value) = &self.line.numbers[self.index];
        spelled_like(&literal.text, *value)
    }
}

/// A whole number, or one with few decimals.
fn rounded(literal: &Literal, value: f64) -> f64 {
    if literal.is_whole {
        return value.round();
    }
    let step = SHARE * literal.value.abs().max(0.1);
    let digits = 10_f64.powi((-step.log10().floor()) as i32);
    (value * digits).round() / digits
}

impl NumberDrag {
    /// Offers the numbers of a line. `left`: where its code begins.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        (state, path): (&State, &TreePath),
        line: &CodeLine,
        (left, rect, look): (f32, Rect, &Look),
        commands: &mut Commands,
    ) {
        let is_free = state.edits.draft.as_ref().is_none_or(|draft| draft.is_at(path, line.row.line));
        for (index, bytes) in line.numbers.iter().enumerate() {
            let x = |byte: usize| left + look.letter * line.text[..byte].chars().count() as f32;
            let area = Rect::from_x_y_ranges(x(bytes.start)..=x(bytes.end), rect.y_range());
            let id = ui.id().with(("number", line.row.line, index));
            let response = ui.interact(area, id, if is_free { Sense::drag() } else { Sense::hover() });
            spoken::button(&response, &format!("Drag {}", &line.text[bytes.clone()]));
            if response.drag_started() {
                self.0 = Dragged::new(state, (path, line), (index, line.numbers.len()));
            }
            if response.hovered() || response.dragged() {
                ui.painter().hline(area.x_range(), area.bottom() - 2.0, egui::Stroke::new(1.0, ACCENT));
            }
            if response.dragged()
                && let Some(dragged) = &mut self.0
            {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
                let slow = if ui.input(|input| input.modifiers.shift) { SLOW } else { 1.0 };
                if dragged.drag(f64::from(response.drag_delta().x) * slow) {
                    commands.push(DRAFT.with(dragged.line.edits()));
                }
                label(ui, area, &dragged.text());
            }
            if response.drag_stopped() {
                self.0 = None;
            }
            let hint = match is_free {
                true => "Drag to see the picture with another number (Shift: slowly). Write saves it",
                false => "Write or cancel the numbers of the other line first",
            };
            response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(hint);
        }
    }
}

/// The number beside the mouse, since the code follows once it has compiled.
fn label(ui: &Ui, area: Rect, text: &str) {
    let painter = ui.ctx().layer_painter(LayerId::new(Order::Tooltip, ui.id().with("dragged number")));
    let galley = painter.layout_no_wrap(text.to_owned(), small_mono_font(), ACCENT.color());
    let size = galley.size() + vec2(10.0, 4.0);
    let place = Rect::from_min_size(pos2(area.left() - 5.0, area.top() - size.y - 2.0), size);
    painter.rect(place, 4.0, PANEL.color(), egui::Stroke::new(1.0, ACCENT), egui::StrokeKind::Inside);
    let center = place.center();
    painter.text(center, Align2::CENTER_CENTER, text, small_mono_font(), ACCENT.color());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::rewrite::literals;

    #[test]
    fn dragged_numbers_keep_few_decimals_and_no_sign() {
        let text = "x = 0.5 * 3 + 100.0;";
        let [half, three, hundred] = literals(text, 1).try_into().unwrap();
        assert_eq!(rounded(&half, 0.512_345), 0.512);
        assert_eq!(rounded(&three, 3.6), 4.0);
        assert_eq!(rounded(&hundred, 101.26), 101.3);
    }
}
