//! The arrangement of the panels: tiles around the picture that the user docks, resizes and closes. It is kept between runs.

mod behavior;
mod below;
mod fit;
mod preset;
mod repair;
mod store;
#[cfg(test)]
mod tests;

use egui::{Rect, Ui, Vec2};
use egui_tiles::{Container, LinearDir, Tile, TileId, Tree};

use super::state::arrangement::{Panel, Preset};
use behavior::{Dock, SIMPLIFY, TabTitles};
use fit::Fit;
use repair::{COLUMN, repair};

/// The arrangement of the panels.
pub(super) struct Layout {
    tree: Tree<Panel>,
    fit: Fit,
    /// The user's own arrangement, while a preset is shown.
    own: Option<Tree<Panel>>,
    /// Whether the user has changed the tiles since a preset was chosen.
    is_own: bool,
    /// Whether the arrangement differs from the stored one.
    is_changed: bool,
    /// Whether the tiles have been laid out since the last change.
    is_settled: bool,
    /// The part of the picture that no handle covers, in points.
    free: Rect,
    /// Whether the light theme is shown.
    is_light: bool,
    /// Whether this arrangement is temporary (for an exercise or a single file), so that the next window does not get it.
    is_temporary: bool,
    /// The preset that was chosen last.
    preset: Preset,
    /// The arrangement before a temporary one, whether the user had customized it, and the preset before.
    before: Option<(Tree<Panel>, bool, Preset)>,
    /// The user's own arrangement for single files.
    of_file: Option<Tree<Panel>>,
}

impl Layout {
    /// The arrangement of the last run, or the first preset.
    pub(super) fn restored() -> Self {
        let Some(store::Stored { mut tree, is_own, own, is_light, preset, of_file }) = store::load() else {
            return Self { is_changed: true, ..Self::of_tree(Preset::Debug.tree()) };
        };
        repair(&mut tree);
        Self { is_own, own, is_light, preset, of_file, ..Self::of_tree(tree) }
    }

    /// An arrangement that is not stored until it changes.
    #[cfg(test)]
    pub(super) fn of_preset(preset: Preset) -> Self {
        Self::of_tree(preset.tree())
    }

    fn of_tree(tree: Tree<Panel>) -> Self {
        Self {
            tree,
            fit: Fit::default(),
            own: None,
            is_own: false,
            is_changed: false,
            is_settled: false,
            free: Rect::ZERO,
            is_light: false,
            is_temporary: false,
            preset: Preset::default(),
            before: None,
            of_file: None,
        }
    }

    /// Replaces the tiles. Theme and kept arrangements stay.
    fn replace(&mut self, tree: Tree<Panel>) {
        let (own, of_file) = (self.own.take(), self.of_file.take());
        let (is_light, preset) = (self.is_light, self.preset);
        *self = Self { own, of_file, is_light, preset, is_changed: true, ..Self::of_tree(tree) };
    }

    /// Shows a preset. The user's own arrangement is kept for [`Self::arrange_own`].
    pub(super) fn arrange(&mut self, preset: Preset) {
        self.keep_of_file();
        if self.is_own {
            self.own = Some(self.fit.measured(&self.tree));
        }
        self.replace(preset.tree());
        self.preset = preset;
    }

    /// Shows the preset that was chosen last without the user's changes.
    pub(super) fn reset(&mut self) {
        let (is_temporary, is_of_file, before) = (self.is_temporary, self.is_of_file(), self.before.take());
        self.arrange(self.preset);
        (self.is_temporary, self.before) = (is_temporary, before);
        if is_of_file {
            self.of_file = None;
        }
    }

    /// Shows a preset until the user chooses another arrangement, or until [`Self::arrange_as_before`]. The next window is arranged as
    /// before. Panels that no preset has stay open, unless the user has changed the arrangement for single files.
    pub(super) fn arrange_temporarily(&mut self, preset: Preset) {
        let before = self.before.take();
        let before = before.unwrap_or_else(|| (self.fit.measured(&self.tree), self.is_own, self.preset));
        let is_added = |panel: &Panel| !panel.is_in_presets() && self.is_open(*panel);
        let added: Vec<Panel> = Panel::groups().concat().into_iter().filter(is_added).collect();
        self.arrange(preset);
        (self.is_temporary, self.before) = (true, Some(before));
        if let Some(tree) = self.of_file.clone().filter(|_| preset == Preset::Toy) {
            (self.tree, self.is_own) = (tree, true);
            return;
        }
        for panel in added {
            if !self.is_open(panel) {
                self.insert(panel);
            }
        }
    }

    /// Shows the arrangement before [`Self::arrange_temporarily`], unless the user has chosen another one since.
    pub(super) fn arrange_as_before(&mut self) {
        self.keep_of_file();
        let before = self.before.take().filter(|_| self.is_temporary && !self.is_own);
        let Some((tree, is_own, preset)) = before else { return };
        self.own.take_if(|_| is_own);
        self.replace(tree);
        (self.is_own, self.preset) = (is_own, preset);
    }

    /// Whether the arrangement for a single file is shown.
    fn is_of_file(&self) -> bool {
        self.is_temporary && self.preset == Preset::Toy
    }

    /// The arrangement for single files, if the user has changed it.
    fn own_of_file(&self) -> Option<Tree<Panel>> {
        match self.is_of_file() && self.is_own {
            true => Some(self.fit.measured(&self.tree)),
            false => self.of_file.clone(),
        }
    }

    /// Keeps the arrangement for single files if it is shown and the user has changed it.
    fn keep_of_file(&mut self) {
        self.of_file = self.own_of_file();
        self.is_own &= !self.is_of_file();
    }

    /// Whether there is an own arrangement of the user to restore.
    pub(super) fn has_own(&self) -> bool {
        self.own.is_some()
    }

    /// Shows the user's own arrangement again.
    pub(super) fn arrange_own(&mut self) {
        if let Some(tree) = self.own.take() {
            self.keep_of_file();
            self.replace(tree);
            self.is_own = true;
        }
    }

    /// The side of the picture whose panels do not fit into the window.
    pub(super) fn hidden_side(&self) -> Option<&'static str> {
        self.fit.hidden_side(&self.tree)
    }

    /// Shows these panels in place of those on the other side.
    pub(super) fn swap_sides(&mut self) {
        self.fit.swap_sides();
    }

    /// Whether the light theme is shown.
    pub(super) fn is_light(&self) -> bool {
        self.is_light
    }

    /// Shows the light or the dark theme.
    pub(super) fn set_light(&mut self, is_light: bool) {
        self.is_changed |= self.is_light != is_light;
        self.is_light = is_light;
    }

    /// Marks the layout as customized. An existing own arrangement stays while the user changes a preset.
    fn edited(&mut self) {
        self.is_changed = true;
        self.is_own |= self.own.is_none() || self.is_of_file();
    }

    pub(super) fn is_open(&self, panel: Panel) -> bool {
        self.tree.tiles.find_pane(&panel).is_some()
    }

    /// Whether a panel is open, and not on the side that a narrow window hides.
    pub(super) fn is_in_sight(&self, panel: Panel) -> bool {
        let tiles = &self.tree.tiles;
        let pane = tiles.find_pane(&panel);
        pane.is_some() && std::iter::successors(pane, |id| tiles.parent_of(*id)).all(|id| tiles.is_visible(id))
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
        if !self.is_in_sight(panel) {
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
        if panel.is_below_picture() && below::insert(&mut self.tree, panel) {
            return self.fit.invalidate();
        }
        let group = Panel::groups().into_iter().find(|group| group.contains(&panel)).unwrap_or_default();
        let (root, tiles) = (self.tree.root(), &mut self.tree.tiles);
        let with = |other: &Panel| tiles.parent_of(tiles.find_pane(other)?);
        let all = Panel::groups().concat();
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
        let (picture, tabs) = (None, TabTitles::default());
        let mut dock =
            Dock { panels, picture, is_edited: false, is_dropped: false, is_selected: false, closed: None, tabs };
        // The background fills the gaps between tiles, but not the picture.
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

    /// The content of the file: this arrangement, or the previous one if this is temporary. The theme is stored in both cases.
    fn stored(&self) -> store::Stored {
        let Self { is_light, is_own, preset, .. } = *self;
        let of_file = self.own_of_file();
        if !self.is_temporary {
            let (tree, own) = (self.fit.measured(&self.tree), self.own.clone());
            return store::Stored { tree, is_own, own, is_light, preset, of_file };
        }
        match store::load() {
            Some(before) => store::Stored { is_light, of_file, ..before },
            None => {
                let preset = Preset::default();
                store::Stored { tree: preset.tree(), is_own: false, own: None, is_light, preset, of_file }
            }
        }
    }

    /// Stores a changed arrangement, once its tiles have their sizes. A drag changes them in each frame; only its end is stored.
    fn store(&mut self, ui: &Ui) {
        if !self.is_changed || ui.input(|input| input.pointer.any_down()) {
            self.is_settled = false;
        } else if std::mem::replace(&mut self.is_settled, true) {
            (self.is_changed, self.is_settled) = (false, false);
            self.fit.remember(&self.tree);
            store::save(&self.stored());
        } else {
            ui.ctx().request_repaint();
        }
    }
}

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
