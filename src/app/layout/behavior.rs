//! Appearance of the tiles, and behavior of their tabs.

use egui::{Color32, Margin, Rect, Response, Stroke, Ui, Visuals, WidgetText};
use egui_tiles::{Behavior, EditAction, ResizeState, SimplificationOptions, TabState, Tile, TileId, Tiles, UiResponse};

use super::{Panel, SIMPLIFY};
use crate::app::panels::theme::{ACCENT, EDGE, PANEL, QUIET};

/// Space between two tiles, in points.
pub(super) const GAP: f32 = 2.0;
/// Height of the tabs of a tile, in points.
pub(super) const TAB_BAR: f32 = 24.0;

/// The tiles in one frame.
pub(super) struct Dock<'a> {
    pub(super) panels: &'a mut dyn FnMut(&mut Ui, Panel),
    /// The rectangle of the viewport, if it is not behind another tab.
    pub(super) picture: Option<Rect>,
    /// Whether the user has moved or resized a tile.
    pub(super) is_edited: bool,
    /// Whether the user has moved a tile.
    pub(super) is_dropped: bool,
    /// Whether another tab has come to the front.
    pub(super) is_selected: bool,
    /// The panel that the user has closed.
    pub(super) closed: Option<Panel>,
}

/// The titles of the panels in a tile.
fn titles(tiles: &Tiles<Panel>, id: TileId) -> Vec<&'static str> {
    match tiles.get(id) {
        Some(Tile::Pane(panel)) => vec![panel.title()],
        Some(Tile::Container(container)) => container.children().flat_map(|child| titles(tiles, *child)).collect(),
        None => Vec::new(),
    }
}

impl Behavior<Panel> for Dock<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, panel: &mut Panel) -> UiResponse {
        let area = ui.max_rect();
        if *panel == Panel::Viewport {
            self.picture = Some(area);
            return UiResponse::None;
        }
        ui.painter().rect_filled(area, 0.0, PANEL);
        egui::Frame::new().inner_margin(Margin::symmetric(8, 6)).show(ui, |ui| {
            // These have rows above their lists, or may run from left to right: they scroll by themselves.
            if matches!(*panel, Panel::Modes | Panel::Shaders | Panel::Timeline | Panel::Inspector) {
                return (self.panels)(ui, *panel);
            }
            let scroll = egui::ScrollArea::vertical().id_salt(panel.title()).auto_shrink(false);
            scroll.show(ui, |ui| (self.panels)(ui, *panel));
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, panel: &Panel) -> WidgetText {
        panel.title().into()
    }

    fn tab_title_for_tile(&mut self, tiles: &Tiles<Panel>, id: TileId) -> WidgetText {
        titles(tiles, id).join(", ").into()
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<Panel>, id: TileId, tab: Response) -> Response {
        let Some(Tile::Pane(panel)) = tiles.get(id) else { return tab };
        if *panel == Panel::Viewport {
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
        tab.on_hover_text("Drag to dock elsewhere; middle click closes")
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
