//! Several modes side by side in the picture: which modes, and where each lies.

use crate::shader::{Mode, PATHS_STAGE};

/// Most modes at once.
const MOST: usize = 9;
/// Pixels between two modes.
pub(in crate::app) const GAP: u32 = 3;

/// A part of the window that shows a picture, in pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::app) struct PictureRect {
    pub(in crate::app) at: (u32, u32),
    pub(in crate::app) size: (u32, u32),
}

/// The modes that are shown side by side.
#[derive(Default)]
pub(in crate::app) struct Grid {
    /// Slugs of the modes, row by row. Empty unless at least two modes are shown.
    modes: Vec<String>,
}

impl Grid {
    /// Whether several modes are shown.
    pub(in crate::app) fn is_on(&self) -> bool {
        self.modes.len() > 1
    }

    /// The slugs of the modes, row by row.
    pub(in crate::app) fn modes(&self) -> &[String] {
        &self.modes
    }

    /// Adds a mode beside the selected one, or removes it. Returns whether there was room for it.
    fn toggle(&mut self, slug: &str, selected: &str) -> bool {
        if self.modes.is_empty() {
            self.modes.push(selected.to_owned());
        }
        if let Some(at) = self.modes.iter().position(|mode| mode == slug) {
            // The selected mode stays.
            if slug != selected {
                self.modes.remove(at);
            }
        } else if self.modes.len() < MOST {
            self.modes.push(slug.to_owned());
        } else {
            return false;
        }
        if self.modes.len() < 2 {
            self.modes.clear();
        }
        true
    }

    /// The modes with one more beside the selected one, or without it; `None` if there is no room for it.
    pub(in crate::app) fn toggled(&self, slug: &str, selected: &str) -> Option<Vec<String>> {
        let mut grid = Self { modes: self.modes.clone() };
        grid.toggle(slug, selected).then_some(grid.modes)
    }

    /// Whether the grid can show a mode: it takes one frame.
    pub(in crate::app) fn can_show(mode: &Mode) -> bool {
        mode.stage != PATHS_STAGE && !mode.accumulate
    }

    /// Shows these modes, by their slugs; fewer than two end the grid.
    ///
    /// # Errors
    /// A message if there are too many.
    pub(in crate::app) fn show(&mut self, modes: Vec<String>) -> Result<(), String> {
        let mut each = Vec::new();
        for mode in modes {
            if !each.contains(&mode) {
                each.push(mode);
            }
        }
        if each.len() > MOST {
            return Err(format!("{} modes do not fit side by side; at most {MOST} do", each.len()));
        }
        self.modes = if each.len() > 1 { each } else { Vec::new() };
        Ok(())
    }

    /// Shows one mode alone.
    pub(in crate::app) fn end(&mut self) {
        self.modes.clear();
    }

    /// Ends the grid when the selected mode is not part of it.
    pub(in crate::app) fn follow(&mut self, selected: &str) {
        if !self.modes.iter().any(|mode| mode == selected) {
            self.end();
        }
    }
}

/// Columns and rows for `count` pictures: nearly as many of both.
fn columns_and_rows(count: usize) -> (u32, u32) {
    let columns = (1..=count).find(|columns| columns * columns >= count).unwrap_or(1) as u32;
    (columns, (count as u32).div_ceil(columns).max(1))
}

/// Where `count` pictures lie in `whole`, row by row, in pixels of the window, and then the places that stay empty.
pub(in crate::app) fn places(count: usize, whole: PictureRect) -> Vec<PictureRect> {
    let (columns, rows) = columns_and_rows(count);
    let side = |length: u32, parts: u32| (length.saturating_sub(GAP * (parts - 1)) / parts).max(1);
    let size = (side(whole.size.0, columns), side(whole.size.1, rows));
    let place = |index: u32| PictureRect {
        at: (whole.at.0 + index % columns * (size.0 + GAP), whole.at.1 + index / columns * (size.1 + GAP)),
        size,
    };
    (0..columns * rows).map(place).collect()
}

/// The places of `count` pictures.
pub(in crate::app) fn cells(count: usize, whole: PictureRect) -> Vec<PictureRect> {
    let mut cells = places(count, whole);
    cells.truncate(count);
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_come_and_go() {
        let mut grid = Grid::default();
        assert!(grid.toggle("d", "final") && grid.is_on());
        assert!(grid.toggle("g", "final") && grid.toggle("d", "final"));
        assert_eq!(grid.modes(), ["final", "g"]);
        grid.follow("g");
        assert!(grid.is_on());
        grid.follow("v");
        assert!(!grid.is_on());
        (0..8).for_each(|index| assert!(grid.toggle(&index.to_string(), "final")));
        assert!(!grid.toggle("one more", "final") && grid.modes().len() == 9);
    }

    #[test]
    fn cells_fill_the_picture() {
        let whole = PictureRect { at: (100, 50), size: (900, 600) };
        for (count, columns) in [(1, 1), (2, 2), (4, 2), (5, 3), (9, 3)] {
            let cells = cells(count, whole);
            assert_eq!(cells.iter().filter(|cell| cell.at.1 == 50).count(), columns.min(count));
            let inside = |cell: &PictureRect| {
                cell.at.0 + cell.size.0 <= 1000 && cell.at.1 + cell.size.1 <= 650 && cell.at.0 >= 100 && cell.at.1 >= 50
            };
            assert!(cells.len() == count && cells.iter().all(inside));
        }
    }
}
