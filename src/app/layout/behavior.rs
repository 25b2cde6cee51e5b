//! Appearance of the tiles, and behavior of their tabs.

use std::sync::Arc;

use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, Galley, Margin, Rect, Response, Stroke, TextStyle, Ui, Visuals, WidgetText};
use egui_tiles::{
    Behavior, EditAction, ResizeState, SimplificationOptions, TabState, Tabs, Tile, TileId, Tiles, UiResponse,
};

use crate::app::state::arrangement::Panel;
use crate::app::widgets::theme::{ACCENT, EDGE, PANEL, QUIET};

/// Simplifies tiles after a change. A tile with a single tab keeps it.
pub(super) const SIMPLIFY: SimplificationOptions = SimplificationOptions {
    prune_empty_tabs: true,
    prune_empty_containers: true,
    prune_single_child_tabs: false,
    prune_single_child_containers: true,
    all_panes_must_have_tabs: false,
    join_nested_linear_containers: true,
    flatten_tabs_in_tabs: true,
};

/// Space between two tiles, in points.
pub(super) const GAP: f32 = 2.0;
/// Height of the tabs of a tile, in points.
pub(super) const TAB_BAR: f32 = 24.0;
/// Space at both sides of a tab's title, in points: the least in a narrow tile, and the most.
const MARGIN: std::ops::RangeInclusive<f32> = 3.0..=8.0;
/// Smallest width of a truncated title, in points.
const LEAST_TITLE: f32 = 8.0;

/// The tiles in one frame.
pub(super) struct Dock<'a> {
    pub(super) panels: &'a mut dyn FnMut(&mut Ui, Panel),
    /// The rectangle of the viewport, if it is not behind another tab.
    pub(super) picture: Option<Rect>,
    /// Whether the user has moved or resized a tile.
    pub(super) is_edited: bool,
    /// Whether the user has moved a tile.
    pub(super) is_dropped: bool,
    /// Whether another tab was selected.
    pub(super) is_selected: bool,
    /// The panel that the user has closed.
    pub(super) closed: Option<Panel>,
    /// The titles of the tabs that are being shown.
    pub(super) tabs: TabTitles,
}

/// How the titles of a tile's tabs fit into its width. The title of the active tab is never cut.
pub(super) struct TabTitles {
    /// Space at both sides of a title, in points.
    margin: f32,
    /// The titles that are truncated.
    cut: Vec<(TileId, Arc<Galley>)>,
}

impl Default for TabTitles {
    fn default() -> Self {
        Self { margin: *MARGIN.end(), cut: Vec::new() }
    }
}

impl TabTitles {
    /// Fits the titles of `tabs` into the width of `ui`: in a narrow tile the margins shrink first, then the longest titles of the
    /// inactive tabs.
    fn fit(ui: &Ui, tiles: &Tiles<Panel>, tabs: &Tabs) -> Self {
        let layout = |id: TileId, width: f32| {
            let font = TextStyle::Button.resolve(ui.style());
            let mut job = LayoutJob::simple_singleline(titles(tiles, id).join(", "), font, Color32::PLACEHOLDER);
            job.wrap = TextWrapping::truncate_at_width(width);
            ui.painter().layout_job(job)
        };
        let ids: Vec<TileId> = tabs.children.iter().copied().filter(|id| tiles.is_visible(*id)).collect();
        let widths: Vec<f32> = ids.iter().map(|id| layout(*id, f32::INFINITY).size().x).collect();
        // A point for rounding.
        let room = ui.available_width() - 1.0;
        let sides = 2.0 * ids.len().max(1) as f32;
        let margin = ((room - widths.iter().sum::<f32>()) / sides).clamp(*MARGIN.start(), *MARGIN.end());
        let (mut inactive, mut room) = (Vec::new(), room - sides * margin);
        for (id, width) in ids.into_iter().zip(widths) {
            match tabs.is_active(id) {
                true => room -= width,
                false => inactive.push((id, width)),
            }
        }
        let most = widest(inactive.iter().map(|(_, width)| *width).collect(), room).max(LEAST_TITLE);
        let cut = inactive.into_iter().filter(|(_, width)| *width > most).map(|(id, _)| (id, layout(id, most)));
        Self { margin, cut: cut.collect() }
    }

    /// The title of a tab, if it is truncated.
    fn cut(&self, id: TileId) -> Option<&Arc<Galley>> {
        self.cut.iter().find(|(tile, _)| *tile == id).map(|(_, galley)| galley)
    }
}

/// The largest width that titles can have so that all of them fit into `room` points.
fn widest(mut widths: Vec<f32>, mut room: f32) -> f32 {
    widths.sort_by(f32::total_cmp);
    for (index, width) in widths.iter().enumerate() {
        let share = room / (widths.len() - index) as f32;
        if *width > share {
            return share;
        }
        room -= width;
    }
    f32::INFINITY
}

/// The titles of the panels in a tile.
fn titles(tiles: &Tiles<Panel>, id: TileId) -> Vec<&'static str> {
    match tiles.get(id) {
        Some(Tile::Pane(panel)) => vec![panel.0],
        Some(Tile::Container(container)) => container.children().flat_map(|child| titles(tiles, *child)).collect(),
        None => Vec::new(),
    }
}

impl Behavior<Panel> for Dock<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, panel: &mut Panel) -> UiResponse {
        let area = ui.max_rect();
        if *panel == Panel::VIEWPORT {
            self.picture = Some(area);
            return UiResponse::None;
        }
        ui.painter().rect_filled(area, 0.0, PANEL);
        egui::Frame::new().inner_margin(Margin::symmetric(8, 6)).show(ui, |ui| {
            if panel.scrolls_itself() {
                return (self.panels)(ui, *panel);
            }
            let scroll = egui::ScrollArea::vertical().id_salt(panel.0).auto_shrink(false);
            scroll.show(ui, |ui| (self.panels)(ui, *panel));
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, panel: &Panel) -> WidgetText {
        panel.0.into()
    }

    fn tab_title_for_tile(&mut self, tiles: &Tiles<Panel>, id: TileId) -> WidgetText {
        match self.tabs.cut(id) {
            Some(title) => title.clone().into(),
            None => titles(tiles, id).join(", ").into(),
        }
    }

    fn tab_title_spacing(&self, _: &Visuals) -> f32 {
        self.tabs.margin
    }

    /// Called before the tabs of a tile are shown.
    fn top_bar_right_ui(&mut self, tiles: &Tiles<Panel>, ui: &mut Ui, _: TileId, tabs: &Tabs, _: &mut f32) {
        self.tabs = TabTitles::fit(ui, tiles, tabs);
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<Panel>, id: TileId, tab: Response) -> Response {
        let Some(Tile::Pane(panel)) = tiles.get(id) else { return tab };
        if *panel == Panel::VIEWPORT {
            return tab;
        }
        let mut closes = tab.middle_clicked();
        tab.context_menu(|ui| {
            if ui.button("Close").clicked() {
                closes = true;
                ui.close();
            }
        });
        if closes {
            self.closed = Some(*panel);
        }
        let hint = "Drag to dock elsewhere; middle-click to close";
        match self.tabs.cut(id) {
            Some(_) => tab.on_hover_text(format!("{}\n{hint}", panel.0)),
            None => tab.on_hover_text(hint),
        }
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        GAP
    }

    fn min_size(&self) -> f32 {
        60.0
    }

    fn tab_bar_color(&self, _: &Visuals) -> Color32 {
        EDGE.color()
    }

    fn tab_bg_color(&self, _: &Visuals, _: &Tiles<Panel>, _: TileId, state: &TabState) -> Color32 {
        if state.active { PANEL.color() } else { Color32::TRANSPARENT }
    }

    fn tab_outline_stroke(&self, _: &Visuals, _: &Tiles<Panel>, _: TileId, _: &TabState) -> Stroke {
        Stroke::NONE
    }

    fn tab_bar_hline_stroke(&self, _: &Visuals) -> Stroke {
        Stroke::NONE
    }

    fn tab_text_color(&self, visuals: &Visuals, _: &Tiles<Panel>, _: TileId, state: &TabState) -> Color32 {
        if state.active { visuals.strong_text_color() } else { QUIET.color() }
    }

    fn resize_stroke(&self, _: &egui::Style, state: ResizeState) -> Stroke {
        match state {
            ResizeState::Idle => Stroke::new(GAP, EDGE),
            ResizeState::Hovering | ResizeState::Dragging => Stroke::new(GAP, ACCENT),
        }
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SIMPLIFY
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        TAB_BAR
    }

    fn on_edit(&mut self, action: EditAction) {
        self.is_dropped |= action == EditAction::TileDropped;
        self.is_edited |= matches!(action, EditAction::TileDropped | EditAction::TileResized);
        self.is_selected |= action == EditAction::TabSelected;
    }
}

#[cfg(test)]
mod tests {
    use super::widest;

    #[test]
    fn long_titles_are_cut_first() {
        assert_eq!(widest(vec![30.0, 60.0, 40.0], 130.0), f32::INFINITY);
        assert_eq!(widest(vec![30.0, 60.0, 40.0], 120.0), 50.0);
        assert_eq!(widest(vec![30.0, 60.0, 40.0], 100.0), 35.0);
        assert_eq!(widest(Vec::new(), 10.0), f32::INFINITY);
    }
}
