//! The frame that the state describes: what it is, what it lacks, how the screen draws it, and whether it is final.

mod adaptive;
pub(super) mod background;
pub(super) mod draw;
mod grid;
mod memory;
pub(super) mod picture;
mod pictures;
pub(super) mod progress;
mod readings;
mod readout;
mod recording;
pub(super) mod reference;
mod request;
mod results;
mod scan;
mod stages;
pub(super) mod title;
mod toy_pixel;
