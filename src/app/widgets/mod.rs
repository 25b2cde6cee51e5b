//! The parts that all panels share: rows of a name and its control, the search of lists, check boxes, the theme, and words for screen readers.

pub(in crate::app) mod check_box;
pub(in crate::app) mod rows;
pub(in crate::app) mod search;
pub(in crate::app) mod spoken;
pub(in crate::app) mod theme;
