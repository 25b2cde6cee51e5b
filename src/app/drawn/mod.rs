//! Pictures with what draws them on the device: the last complete one, those of older versions, and the other one of a comparison.

pub(super) mod compare;
pub(super) mod generations;
pub(super) mod last_complete;
pub(super) mod readout;
pub(super) mod waits;
