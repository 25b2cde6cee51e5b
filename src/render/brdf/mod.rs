//! What the BRDF needs besides its formulas: tables of its albedo, measured data, and its measurement for `specula brdf`.

pub(super) mod ltc;
pub mod measure;
pub(super) mod measured;
pub(super) mod tables;
