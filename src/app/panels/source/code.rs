//! The lines of the file, of which only those in sight are laid out.

use egui::{ScrollArea, Ui, vec2};

use super::colors::ROW;
use super::edit::Editor;
use super::find::Find;
use super::fold::Folds;
use super::look::Look;
use super::model::CodeModel;
use super::number::NumberDrag;
use super::row::{Clicked, show_row};
use super::scroll::Scroll;
use crate::app::commands::Commands;
use crate::app::state::State;
use crate::app::widgets::theme::small_mono_font;

/// The parts of the panel that the lines show and change.
pub(super) struct Parts<'a> {
    pub(super) find: &'a Find,
    pub(super) editor: &'a mut Editor,
    pub(super) folds: &'a mut Folds,
    pub(super) drag: &'a mut NumberDrag,
    pub(super) scroll: &'a mut Scroll,
}

/// Shows the lines.
pub(super) fn show(
    ui: &mut Ui,
    state: &State,
    model: &CodeModel,
    Parts { find, editor, folds, drag, scroll }: Parts<'_>,
    commands: &mut Commands,
) {
    let Some((path, text)) = model.path().zip(model.text()) else { return };
    let letter = ui.fonts_mut(|fonts| fonts.glyph_width(&small_mono_font(), '0'));
    let look = Look::new(letter, model.lines.len());
    let width = look.width(model.longest);
    let mut area = ScrollArea::both().id_salt("code").auto_shrink(false);
    let has_values = model.lines.iter().any(|line| !line.row.notes.is_empty());
    if scroll.is_news(path.as_str(), has_values) {
        // A file opens at its first error, or where the pixel reaches it.
        let first = model.first_error().or_else(|| model.first_change());
        let first = first.or_else(|| model.lines.iter().position(|line| !line.row.notes.is_empty()));
        scroll.offer(first.unwrap_or(0));
    }
    scroll.seek(path.as_str(), state.traces.seeks.as_ref());
    if let Some(line) = scroll.take() {
        if folds.open_at(model, line) {
            // The next frame has its row.
            scroll.again(line);
            ui.ctx().request_repaint();
        }
        let above = (ui.available_height() / 3.0).min(6.0 * ROW);
        area = area.vertical_scroll_offset((ROW * model.shown_at(line) as f32 - above).max(0.0));
    }
    if let Some(line) = scroll.take_top() {
        area = area.vertical_scroll_offset(ROW * model.shown_at(line) as f32);
    }
    let spacing = std::mem::replace(&mut ui.spacing_mut().item_spacing, vec2(0.0, 0.0));
    area.show_rows(ui, ROW, model.shown.len(), |ui, range| {
        ui.set_min_width(width.max(ui.available_width()));
        scroll.saw(model.line_at(range.start));
        for shown in &model.shown[range] {
            match show_row(ui, (state, path), model, shown, (&look, find, drag), commands) {
                Some(Clicked::Edit(line)) => {
                    editor.begin(path, text, line);
                    scroll.keep();
                }
                Some(Clicked::Fold(name)) => folds.toggle(path, &name),
                None => {}
            }
        }
    });
    ui.spacing_mut().item_spacing = spacing;
}
