//! A row of the tree: the arrow that folds, the name, a count or size, and the switch that hides it.

use egui::{Align2, Color32, Pos2, Rect, Response, Sense, Shape, Stroke, TextStyle, Ui, pos2, vec2};

use super::rows::TreeRow;
use crate::app::state::selection::Selected;
use crate::app::widgets::elide;
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{EDGE, QUIET, STRONG};

/// Height in points.
pub(super) const HEIGHT: f32 = 18.0;
/// Points by which a level moves to the right.
const INDENT: f32 = 10.0;
/// Width of the switch, points.
const SWITCH: f32 = 18.0;

/// User action on a row.
pub(super) enum Action {
    Toggle,
    Select(Selected),
    LookThrough(usize),
    /// Draws or hides what settings refer to by this name.
    Show(String, bool),
}

/// How a row is shown.
pub(super) struct RowState {
    /// Whether the settings let it be drawn.
    pub(super) is_wanted: bool,
    /// Whether it is drawn: the file and its clips hide nodes, too.
    pub(super) is_visible: bool,
    pub(super) is_selected: bool,
    /// Whether it is a search result, which is shown without a level.
    pub(super) is_found: bool,
}

/// Shows a row.
pub(super) fn show(ui: &mut Ui, row: &TreeRow, state: &RowState) -> Option<Action> {
    let RowState { is_wanted, is_visible, is_selected, is_found } = *state;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click());
    let label = format!("{} {}", row.name, row.detail);
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::WidgetType::SelectableLabel, true, is_selected, label.clone())
    });
    let painter = ui.painter();
    if is_selected || response.hovered() {
        painter.rect_filled(rect, 3.0, if is_selected { ui.visuals().selection.bg_fill } else { EDGE.color() });
    }
    let settings_hide = row.key.as_ref().filter(|_| row.item.is_some());
    let mut x = rect.left() + 4.0 + if is_found { 0.0 } else { row.depth as f32 * INDENT };
    let middle = rect.center().y;
    if let Some(is_folded) = row.is_folded.filter(|_| !is_found) {
        arrow(painter, pos2(x + 3.0, middle), is_folded);
    }
    x += 12.0;
    let body = TextStyle::Body.resolve(ui.style());
    let small = TextStyle::Small.resolve(ui.style());
    let quiet = if is_selected { STRONG.color() } else { QUIET.color() };
    let mut right = rect.right() - 4.0;
    let mut action = None;
    if let Some(key) = settings_hide {
        right -= SWITCH;
        let place = Rect::from_min_max(pos2(right, rect.top()), rect.right_bottom());
        let switch = ui.interact(place, response.id.with("shown"), Sense::click());
        dot(ui.painter(), place.center(), is_wanted, &switch, quiet);
        let text =
            if is_wanted { "Hide it (Ctrl+H hides the selection)" } else { "Draw it again (Alt+H draws everything)" };
        spoken::button(&switch, &format!("{} {}", if is_wanted { "Hide" } else { "Draw" }, row.name));
        if switch.on_hover_text(text).clicked() {
            action = Some(Action::Show(key.clone(), !is_wanted));
        }
    }
    let painter = ui.painter();
    let detail = painter.text(pos2(right, middle), Align2::RIGHT_CENTER, &row.detail, small, quiet);
    let color = match (row.item, is_visible, is_selected) {
        (None, ..) => QUIET.color(),
        (_, false, _) => QUIET.color(),
        (.., true) => STRONG.color(),
        _ => ui.visuals().text_color(),
    };
    let name = elide::middle(painter, &row.name, &body, (detail.left() - 6.0 - x).max(0.0));
    let galley = painter.layout_no_wrap(name, body, color);
    let corner = pos2(x, middle - 0.5 * galley.size().y);
    painter.galley(corner, galley, color);
    if action.is_some() {
        return action;
    }
    let (clicked, double, at) = (response.clicked(), response.double_clicked(), response.interact_pointer_pos());
    response.on_hover_text(hover(row, is_wanted && !is_visible));
    let folds = row.is_folded.is_some() && at.is_some_and(|at| row.item.is_none() || at.x < x);
    match row.item {
        _ if clicked && folds => Some(Action::Toggle),
        Some(Selected::Camera(camera)) if clicked || double => Some(Action::LookThrough(camera)),
        Some(item) if clicked => Some(Action::Select(item)),
        _ => None,
    }
}

/// The hover text of a row. `is_hidden`: the file or a clip hides the part.
fn hover(row: &TreeRow, is_hidden: bool) -> String {
    let about = match row.item {
        None => "Click to fold or unfold",
        Some(Selected::Camera(_)) => "Click to look through this camera; R frames the model again",
        Some(Selected::Texture(_)) => "Click to see the texture",
        Some(Selected::Light(_)) => "Click to see its handle in the picture",
        _ => "Click to select; / isolates it",
    };
    let hidden = if is_hidden { "\nNot drawn now: the file or a clip hides it (KHR_node_visibility)" } else { "" };
    format!("{}\n{about}{hidden}", row.name)
}

fn arrow(painter: &egui::Painter, at: Pos2, is_folded: bool) {
    let tips = match is_folded {
        true => [vec2(-1.5, -3.5), vec2(2.5, 0.0), vec2(-1.5, 3.5)],
        false => [vec2(-3.5, -1.5), vec2(3.5, -1.5), vec2(0.0, 2.5)],
    };
    painter.add(Shape::convex_polygon(tips.map(|tip| at + tip).to_vec(), QUIET, Stroke::NONE));
}

/// The switch: a dot if the part is drawn, a ring if it is not.
fn dot(painter: &egui::Painter, at: Pos2, is_drawn: bool, response: &Response, color: Color32) {
    let color = if response.hovered() { STRONG.color() } else { color };
    match is_drawn {
        true => painter.circle_filled(at, 3.0, color),
        false => painter.circle_stroke(at, 3.0, Stroke::new(1.2, color)),
    };
}
