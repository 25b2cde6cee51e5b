//! The parts that all panels share: rows of a name and its control, the search of lists, check boxes, the theme, and words for screen readers.

pub(in crate::app) mod check_box;
pub(in crate::app) mod color;
mod controls;
pub(in crate::app) mod elide;
pub(in crate::app) mod rows;
pub(in crate::app) mod search;
mod sight;
pub(in crate::app) mod spoken;
pub(in crate::app) mod theme;

/// A unit with raised powers: "cd/m²" of "cd/m^2".
pub(in crate::app) fn with_powers(unit: &str) -> String {
    unit.replace("^2", "²").replace("^3", "³")
}

/// A count with its noun, such as "1 draw" or "2 draws".
pub(in crate::app) fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
