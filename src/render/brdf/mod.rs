//! What the BRDF needs besides its formulas: tables of its albedo, measured data, and its measurement for `specula brdf`.

pub(crate) mod ltc;
pub(crate) mod measured;
pub(super) mod tables;
