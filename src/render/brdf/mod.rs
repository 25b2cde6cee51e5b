//! Data that the BRDF reads on the device: tables of its albedo, the table of transformed cosines, measured BRDFs.

pub(crate) mod ltc;
pub(crate) mod measured;
pub(super) mod tables;
