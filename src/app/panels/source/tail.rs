//! The texts behind the code of a function's first line: the number of folded lines, and the function's cost.

use std::sync::Arc;

use egui::{Galley, Pos2, Rect, Ui, vec2};

use super::colors::ROW;
use super::cost;
use super::model::CodeLine;
use crate::app::state::State;
use crate::app::widgets::plural;
use crate::app::widgets::theme::{QUIET, small_font};
use crate::headless::FunctionCost;
use crate::shader::TreePath;

/// Points before each text.
const GAP: f32 = 10.0;

/// The texts as they are laid out.
pub(super) struct Tail<'a> {
    folded: Option<Arc<Galley>>,
    cost: Option<(&'a FunctionCost, String, Arc<Galley>)>,
    /// Points that they take, with what is before them.
    pub(super) width: f32,
}

impl<'a> Tail<'a> {
    pub(super) fn new(ui: &Ui, state: &'a State, (path, line): (&TreePath, &CodeLine)) -> Self {
        let lay_out = |text: &str| ui.painter().layout_no_wrap(text.to_owned(), small_font(), QUIET.color());
        let hidden = line.fold.as_ref().map_or(0, |fold| fold.hidden);
        let folded = (hidden > 0).then(|| lay_out(&format!("… {}", plural(hidden, "line"))));
        let cost = cost::text_of(state, path, line.row.line).map(|(cost, text)| {
            let galley = lay_out(&text);
            (cost, text, galley)
        });
        let all = folded.iter().chain(cost.as_ref().map(|(.., galley)| galley));
        let width = all.map(|galley| GAP + galley.size().x).sum();
        Self { folded, cost, width }
    }

    /// Shows them from a place on, which is in the middle of the height.
    pub(super) fn show(self, ui: &mut Ui, line: u32, mut at: Pos2) {
        let mut paint = |ui: &Ui, galley: Arc<Galley>| {
            at.x += GAP;
            let area = Rect::from_center_size(at + vec2(galley.size().x / 2.0, 0.0), vec2(galley.size().x, ROW));
            ui.painter().galley(at - vec2(0.0, galley.size().y / 2.0), galley, QUIET.color());
            at.x = area.right();
            area
        };
        self.folded.into_iter().for_each(|galley| _ = paint(ui, galley));
        if let Some((cost, text, galley)) = self.cost {
            let area = paint(ui, galley);
            cost::show(ui, (cost, &text), line, area);
        }
    }
}
