//! The arrangements that Specula offers.

use egui_tiles::{Linear, LinearDir, TileId, Tiles, Tree};

use crate::app::state::arrangement::{Panel, Preset};

/// Widths of the columns beside the picture, in points.
const LEFT: f32 = 236.0;
const RIGHT: f32 = 318.0;
/// Width of the column with an exercise, which is text.
const LESSON: f32 = 400.0;
/// Height of the timeline below the picture, in points.
const BELOW: f32 = 190.0;

impl Preset {
    /// The tiles of the arrangement.
    pub(super) fn tree(self) -> Tree<Panel> {
        let tiles = &mut Tiles::default();
        let groups = Panel::groups();
        let [modes, shaders, parameters, settings] = groups.each_ref().map(Vec::as_slice);
        let picture = tiles.insert_pane(Panel::VIEWPORT);
        let columns = match self {
            Self::Debug => {
                let left = [(modes, 3.0), (shaders, 1.0)];
                let right = [(parameters, 1.0), (settings, 1.0)];
                vec![(column(tiles, &left), LEFT), (picture, 1.0), (column(tiles, &right), RIGHT)]
            }
            Self::Look => {
                let right = [(settings, 1.0), (parameters, 1.0)];
                vec![(picture, 1.0), (column(tiles, &right), RIGHT)]
            }
            Self::Compare => {
                let right = [(parameters, 1.0), (settings, 1.0)];
                let below = [Panel::TIMELINE, Panel::SHADERS, Panel::TIMING];
                let below = below.map(|panel| tiles.insert_pane(panel)).to_vec();
                let below = tiles.insert_tab_tile(below);
                let left = linear(tiles, LinearDir::Vertical, vec![(picture, 1.0), (below, BELOW)]);
                vec![(left, 1.0), (column(tiles, &right), RIGHT)]
            }
            Self::Toy => {
                let above = [Panel::PASSES, Panel::PARAMETERS, Panel::OUTPUT, Panel::CAPTURE];
                let below = [Panel::SHADERS, Panel::TIMELINE, Panel::TIMING, Panel::MODES];
                let right: [(&[Panel], f32); 2] = [(&above, 1.0), (&below, 1.0)];
                vec![(picture, 1.0), (column(tiles, &right), RIGHT)]
            }
            Self::Learn => {
                // The panels that the texts of the exercises name, and the files.
                let others = [Panel::PARAMETERS, Panel::LIGHTS, Panel::MODES, Panel::SHADERS];
                let below: [(&[Panel], f32); 2] = [(&[Panel::LEARN], 3.0), (&others, 1.0)];
                vec![(picture, 1.0), (column(tiles, &below), LESSON)]
            }
        };
        let root = linear(tiles, LinearDir::Horizontal, columns);
        Tree::new("layout", root, std::mem::take(tiles))
    }
}

/// Groups of tabs, one above the other, with their shares of the height.
fn column(tiles: &mut Tiles<Panel>, groups: &[(&[Panel], f32)]) -> TileId {
    let rows = groups.iter().map(|(panels, share)| {
        // An exercise needs a column of its own.
        let is_shown = |panel: &&Panel| **panel != Panel::LEARN || panels.len() == 1;
        let shown = panels.iter().filter(is_shown).filter(|panel| panel.is_in_presets());
        let panes = shown.map(|panel| tiles.insert_pane(*panel)).collect();
        (tiles.insert_tab_tile(panes), *share)
    });
    let rows = rows.collect();
    linear(tiles, LinearDir::Vertical, rows)
}

fn linear(tiles: &mut Tiles<Panel>, dir: LinearDir, children: Vec<(TileId, f32)>) -> TileId {
    let mut linear = Linear::new(dir, children.iter().map(|(child, _)| *child).collect());
    children.into_iter().for_each(|(child, share)| linear.shares.set_share(child, share));
    tiles.insert_container(linear)
}
