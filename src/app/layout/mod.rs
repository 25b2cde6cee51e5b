//! The arrangement of the panels: tiles around the picture that the user docks, resizes and closes. It is kept between runs.

mod behavior;
mod fit;
mod preset;
mod repair;
mod store;

use egui::{Rect, Ui, Vec2};
use egui_tiles::{Container, LinearDir, SimplificationOptions, Tile, TileId, Tree};
use serde::{Deserialize, Serialize};

use behavior::Dock;
use fit::Fit;
pub(super) use preset::Preset;
use repair::repair;

/// Width of a column of panels that has none to take it from.
const COLUMN: f32 = 318.0;

/// What a tile shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Panel {
    Viewport,
    Modes,
    Model,
    Shaders,
    Timeline,
    Timing,
    Parameters,
    Passes,
    Environment,
    Lights,
    Output,
    Camera,
}

impl Panel {
    /// All panels that can be closed, in groups that share a tile at first.
    pub(super) const GROUPS: [&[Self]; 4] = [
        &[Self::Modes, Self::Model],
        &[Self::Shaders, Self::Timeline, Self::Timing],
        &[Self::Parameters, Self::Passes],
        &[Self::Environment, Self::Lights, Self::Output, Self::Camera],
    ];

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Viewport => "Viewport",
            Self::Modes => "Modes",
            Self::Model => "Model",
            Self::Shaders => "Shaders",
            Self::Timeline => "Timeline",
            Self::Timing => "GPU time",
            Self::Parameters => "Parameters",
            Self::Passes => "Passes",
            Self::Environment => "Environment",
            Self::Lights => "Lights",
            Self::Output => "Output",
            Self::Camera => "Camera",
        }
    }
}

/// The arrangement of the panels.
pub(super) struct Layout {
    tree: Tree<Panel>,
    fit: Fit,
    /// The arrangement that the user made, while a preset is shown.
    own: Option<Tree<Panel>>,
    /// Whether the user has changed the tiles since a preset was chosen.
    is_own: bool,
    /// Whether the arrangement differs from the stored one.
    is_changed: bool,
    /// Whether the tiles have been laid out since the last change.
    is_settled: bool,
    /// The part of the picture that no handle covers, in points.
    free: Rect,
}

impl Default for Layout {
    /// No panels.
    fn default() -> Self {
        Self::of_tree(Tree::empty("layout"))
    }
}

impl Layout {
    /// The arrangement of the last run, or the first preset.
    pub(super) fn restored() -> Self {
        let Some(store::Stored { mut tree, is_own, own }) = store::load() else {
            return Self { is_changed: true, ..Self::of_tree(Preset::Debug.tree()) };
        };
        repair(&mut tree);
        Self { is_own, own, ..Self::of_tree(tree) }
    }

    fn of_tree(tree: Tree<Panel>) -> Self {
        let (fit, free) = (Fit::default(), Rect::ZERO);
        Self { tree, fit, own: None, is_own: false, is_changed: false, is_settled: false, free }
    }

    /// Shows a preset. The user's own arrangement is kept for [`Self::arrange_own`].
    pub(super) fn arrange(&mut self, preset: Preset) {
        if self.is_own {
            self.own = Some(self.fit.measured(&self.tree));
        }
        let own = self.own.take();
        *self = Self { own, is_changed: true, ..Self::of_tree(preset.tree()) };
    }

    /// Whether there is an arrangement of the user's to go back to.
    pub(super) fn has_own(&self) -> bool {
        self.own.is_some()
    }

    /// Shows the user's own arrangement again.
    pub(super) fn arrange_own(&mut self) {
        if let Some(tree) = self.own.take() {
            *self = Self { is_own: true, is_changed: true, ..Self::of_tree(tree) };
        }
    }

    /// Notes a change by the user, who then has an arrangement of her own.
    fn edited(&mut self) {
        (self.is_changed, self.is_own) = (true, true);
        self.own = None;
    }

    pub(super) fn is_open(&self, panel: Panel) -> bool {
        self.tree.tiles.find_pane(&panel).is_some()
    }

    /// Shows a panel: in front of the tabs in its tile, beside panels of its group or any other, or in a column of its own. A narrow
    /// window then shows the panel's side of the picture.
    pub(super) fn open(&mut self, panel: Panel) {
        self.is_changed = true;
        if !self.is_open(panel) {
            self.insert(panel);
            self.edited();
        }
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(other) if *other == panel));
        let tiles = &self.tree.tiles;
        let up = std::iter::successors(tiles.find_pane(&panel), |id| tiles.parent_of(*id));
        if up.into_iter().any(|id| !tiles.is_visible(id)) {
            self.fit.swap_sides();
        }
    }

    pub(super) fn close(&mut self, panel: Panel) {
        if let Some(id) = self.tree.tiles.find_pane(&panel) {
            self.tree.remove_recursively(id);
            self.tree.simplify(&SIMPLIFY);
            self.fit.invalidate();
            self.edited();
        }
    }

    fn insert(&mut self, panel: Panel) {
        let group = Panel::GROUPS.into_iter().find(|group| group.contains(&panel)).unwrap_or_default();
        let (root, tiles) = (self.tree.root(), &mut self.tree.tiles);
        let with = |other: &Panel| tiles.parent_of(tiles.find_pane(other)?);
        let all = Panel::GROUPS.concat();
        let beside = group.iter().find_map(with).or_else(|| all.iter().rev().find_map(with));
        let pane = tiles.insert_pane(panel);
        if let Some(Tile::Container(Container::Tabs(tabs))) = beside.and_then(|id| tiles.get_mut(id)) {
            tabs.add_child(pane);
            return;
        }
        let column = tiles.insert_tab_tile(vec![pane]);
        self.fit.invalidate();
        match root.and_then(|id| tiles.get_mut(id)) {
            Some(Tile::Container(Container::Linear(linear))) if linear.dir == LinearDir::Horizontal => {
                linear.add_child(column);
                linear.shares.set_share(column, COLUMN);
            }
            _ => {
                let children: Vec<TileId> = root.into_iter().chain([column]).collect();
                let whole = tiles.insert_horizontal_tile(children);
                if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(whole) {
                    linear.shares.set_share(column, COLUMN);
                }
                self.tree.root = Some(whole);
            }
        }
    }

    /// Shows the tiles in `ui`. `panels` shows what is in them. Returns the rectangle of the picture in points.
    pub(super) fn show(&mut self, ui: &mut Ui, panels: &mut dyn FnMut(&mut Ui, Panel)) -> Rect {
        let area = ui.available_rect_before_wrap();
        self.fit.apply(&mut self.tree, area.size());
        let mut dock =
            Dock { panels, picture: None, is_edited: false, is_dropped: false, is_selected: false, closed: None };
        // What the tiles leave uncovered, apart from the picture, is painted behind them.
        let background = ui.painter().add(egui::Shape::Noop);
        self.tree.ui(&mut dock, ui);
        let Dock { picture, is_edited, is_dropped, is_selected, closed, .. } = dock;
        let picture = picture.unwrap_or(Rect::from_min_size(area.min, Vec2::ZERO));
        ui.painter().set(background, around(picture, area, ui.visuals().extreme_bg_color));
        if is_dropped {
            repair(&mut self.tree);
        }
        self.is_changed |= is_selected;
        if is_edited {
            self.edited();
        }
        if let Some(panel) = closed {
            self.close(panel);
        }
        let reach = &ui.style().interaction;
        let grab = reach.resize_grab_radius_side + reach.interact_radius;
        self.free = fit::without_handles(picture, area, grab);
        self.store(ui);
        picture
    }

    /// The part of the last picture that no handle between it and a panel covers, in points.
    pub(super) fn free_of_handles(&self) -> Rect {
        self.free
    }

    /// Stores a changed arrangement, once its tiles have their sizes. A drag changes them in each frame, and only its end is worth
    /// a file.
    fn store(&mut self, ui: &Ui) {
        if !self.is_changed || ui.input(|input| input.pointer.any_down()) {
            self.is_settled = false;
        } else if std::mem::replace(&mut self.is_settled, true) {
            (self.is_changed, self.is_settled) = (false, false);
            self.fit.remember(&self.tree);
            let (tree, own) = (self.fit.measured(&self.tree), self.own.clone());
            store::save(&store::Stored { tree, is_own: self.is_own, own });
        } else {
            ui.ctx().request_repaint();
        }
    }
}

/// How tiles become simpler after a change. A tile with one tab keeps it.
const SIMPLIFY: SimplificationOptions = SimplificationOptions {
    prune_empty_tabs: true,
    prune_empty_containers: true,
    prune_single_child_tabs: false,
    prune_single_child_containers: true,
    all_panes_must_have_tabs: false,
    join_nested_linear_containers: true,
    flatten_tabs_in_tabs: true,
};

/// `area` without `picture`, filled.
fn around(picture: Rect, area: Rect, color: egui::Color32) -> egui::Shape {
    let sides = [
        area.with_max_y(picture.min.y),
        area.with_min_y(picture.max.y),
        area.with_max_x(picture.min.x),
        area.with_min_x(picture.max.x),
    ];
    let filled = sides.into_iter().filter(|side| side.is_positive());
    egui::Shape::Vec(filled.map(|side| egui::Shape::rect_filled(side, 0.0, color)).collect())
}

#[cfg(test)]
mod tests {
    use egui_tiles::Tiles;

    use super::*;

    /// Lays the tiles out in a window of this size, and returns the picture.
    fn shown(layout: &mut Layout, egui: &egui::Context, size: Vec2) -> Rect {
        let input =
            egui::RawInput { screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size)), ..Default::default() };
        let mut picture = Rect::NOTHING;
        let _ = egui.run_ui(input, |ui| picture = layout.show(ui, &mut |_, _| {}));
        picture
    }

    /// A layout that is not stored.
    fn unstored(preset: Preset) -> Layout {
        Layout::of_tree(preset.tree())
    }

    #[test]
    fn panels_keep_their_width_and_the_picture_takes_the_rest() {
        let (egui, mut layout) = (egui::Context::default(), unstored(Preset::Debug));
        let widths = [1280.0, 2560.0, 900.0, 1280.0].map(|width| {
            let picture = shown(&mut layout, &egui, Vec2::new(width, 720.0));
            (picture.min.x, width - picture.max.x)
        });
        for (left, right) in widths {
            assert!((left - widths[0].0).abs() < 1.5 && (right - widths[0].1).abs() < 1.5, "{widths:?}");
        }
        assert!(widths[0].0 > 150.0 && widths[0].1 > 250.0, "{widths:?}");
        // A narrow window hides the panels on the left, which come back with their width.
        let narrow = shown(&mut layout, &egui, Vec2::new(640.0, 480.0));
        assert!(narrow.min.x == 0.0 && narrow.width() > 250.0, "{narrow:?}");
        let wide = shown(&mut layout, &egui, Vec2::new(1280.0, 720.0));
        assert!((wide.min.x - widths[0].0).abs() < 1.5, "{wide:?}, {widths:?}");
        // Even in a tiny one there is a picture.
        assert!(shown(&mut layout, &egui, Vec2::new(300.0, 200.0)).width() > 100.0);
    }

    #[test]
    fn every_panel_closes_and_opens_again() {
        for preset in Preset::ALL {
            let (egui, mut layout) = (egui::Context::default(), unstored(preset));
            let size = Vec2::new(1280.0, 720.0);
            let first = shown(&mut layout, &egui, size);
            layout.is_changed = false;
            for panel in Panel::GROUPS.concat() {
                layout.close(panel);
                layout.is_changed = false;
                shown(&mut layout, &egui, size);
                assert!(!layout.is_open(panel));
            }
            assert!(shown(&mut layout, &egui, size).width() > 1270.0, "a column without panels is left");
            for panel in Panel::GROUPS.concat() {
                layout.open(panel);
                layout.is_changed = false;
                shown(&mut layout, &egui, size);
                assert!(layout.is_open(panel), "{panel:?}");
                let mut seen = false;
                let input = egui::RawInput {
                    screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size)),
                    ..Default::default()
                };
                let _ = egui.run_ui(input, |ui| {
                    layout.show(ui, &mut |_, shown| seen |= shown == panel);
                });
                assert!(seen, "{panel:?} is open behind another tab");
            }
            assert!(shown(&mut layout, &egui, size).width() > 0.5 * first.width());
        }
    }

    #[test]
    fn panels_that_a_small_window_shrinks_grow_again() {
        let (egui, mut layout) = (egui::Context::default(), unstored(Preset::Debug));
        let [first, small, last] = [1280.0, 400.0, 1280.0].map(|width| {
            let picture = shown(&mut layout, &egui, Vec2::new(width, 720.0));
            width - picture.max.x
        });
        assert!(small < first - 10.0 && (last - first).abs() < 1.5, "{first}, {small}, {last}");
    }

    #[test]
    fn a_panel_that_a_narrow_window_hides_can_be_opened() {
        let (egui, mut layout) = (egui::Context::default(), unstored(Preset::Debug));
        let size = Vec2::new(640.0, 480.0);
        let left_of_picture = shown(&mut layout, &egui, size).min.x;
        layout.open(Panel::Modes);
        layout.is_changed = false;
        let picture = shown(&mut layout, &egui, size);
        assert!(left_of_picture == 0.0 && picture.min.x > 100.0 && picture.max.x > 638.0, "{picture:?}");
    }

    #[test]
    fn a_preset_keeps_the_arrangement_that_the_user_made() {
        let (egui, mut layout) = (egui::Context::default(), unstored(Preset::Debug));
        shown(&mut layout, &egui, Vec2::new(1280.0, 720.0));
        layout.close(Panel::Lights);
        for preset in [Preset::Look, Preset::Debug] {
            layout.arrange(preset);
            assert!(layout.is_open(Panel::Lights) && layout.has_own());
        }
        layout.arrange_own();
        assert!(!layout.is_open(Panel::Lights) && layout.is_open(Panel::Modes) && !layout.has_own());
    }

    #[test]
    fn a_panel_on_the_picture_moves_beside_it() {
        let (egui, mut layout) = (egui::Context::default(), unstored(Preset::Debug));
        let size = Vec2::new(1280.0, 720.0);
        shown(&mut layout, &egui, size);
        let tiles = &mut layout.tree.tiles;
        let (picture, lights) = (tiles.find_pane(&Panel::Viewport).unwrap(), tiles.find_pane(&Panel::Lights).unwrap());
        let (tabs, root) = (tiles.parent_of(lights).unwrap(), tiles.parent_of(picture).unwrap());
        let container = |tiles: &mut Tiles<Panel>, id, change: &dyn Fn(&mut Container)| match tiles.get_mut(id) {
            Some(Tile::Container(container)) => change(container),
            _ => panic!("no container"),
        };
        container(tiles, tabs, &|tabs| _ = tabs.remove_child(lights));
        // As a drop on the middle of the picture leaves it.
        let new = tiles.insert_tab_tile(vec![picture, lights]);
        container(tiles, root, &|root| _ = root.replace_child(picture, new));
        repair(&mut layout.tree);
        layout.fit.invalidate();
        let picture = shown(&mut layout, &egui, size);
        assert!(picture.width() > 200.0 && layout.is_open(Panel::Lights), "{picture:?}");
        assert!(
            fit::path_to_picture(&layout.tree.tiles)
                .into_iter()
                .all(|[parent, _]| { !matches!(layout.tree.tiles.get_container(parent), Some(Container::Tabs(_))) })
        );
    }

    #[test]
    fn handles_lie_only_between_the_picture_and_panels() {
        let area = Rect::from_min_max(egui::pos2(0.0, 30.0), egui::pos2(1000.0, 700.0));
        let picture = area.with_min_x(240.0);
        let free = fit::without_handles(picture, area, 10.0);
        assert_eq!(free, picture.with_min_x(250.0));
    }
}
