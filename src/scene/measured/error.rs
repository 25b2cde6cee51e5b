//! Errors of reading a measured BRDF, as messages for the user.

use std::path::PathBuf;

use super::kind::{MERL_DIMENSIONS, MeasuredKind};

/// A measured BRDF that could not be read. The message is one paragraph: the file, what was expected, what was found,
/// what to do.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct MeasuredError {
    /// The file as the user gave it.
    pub file: PathBuf,
    /// The fault.
    pub problem: MeasuredProblem,
}

/// A fault of a measured BRDF.
#[derive(Debug, thiserror::Error)]
pub enum MeasuredProblem {
    /// The file cannot be read.
    #[error("cannot be read: {0}. Check the path and that the file may be read.")]
    Read(#[source] std::io::Error),
    /// A folder, or a device.
    #[error("is not a file. Give one material of the database, as in `blue-acrylic.binary`.")]
    NotAFile,
    /// The file has no bytes.
    #[error("is empty. Expected {}; copy or download it again.", formats())]
    Empty,
    /// Neither the first bytes nor the size match a format.
    #[error("is not a measured BRDF that Specula reads: expected {}, found a file of {found} bytes.", formats())]
    Unknown {
        /// Its size in bytes.
        found: u64,
    },
    /// A MERL file with other dimensions.
    #[error(
        "has the dimensions {}, expected {} (MERL's theta_h x theta_d x phi_d). Specula reads files of the MERL \
         database's own resolution only: resample it, or take another file.",
        dimensions(found),
        dimensions(&MERL_DIMENSIONS)
    )]
    Dimensions {
        /// The header's three numbers.
        found: [i32; 3],
    },
    /// The first bytes or the extension match a format, but the size does not.
    #[error(
        "has {found} bytes, expected {} of a {} file: {}. Copy or download it again{}.",
        kind.file_bytes(),
        kind.name(),
        if *found < kind.file_bytes() as u64 { "it looks cut short" } else { "it has more than the data" },
        if *kind == MeasuredKind::Utia { "; if it is the data of a glTF file, open the .gltf beside it" } else { "" }
    )]
    Size {
        /// The format that it seems to have.
        kind: MeasuredKind,
        /// Its size in bytes.
        found: u64,
    },
    /// A value that is NaN, infinite, or too large for an `f32`.
    #[error(
        "holds {found} at {channel} value {index}, expected a number below 1e38. The file is damaged: copy or download \
         it again."
    )]
    NotANumber {
        /// The color plane.
        channel: &'static str,
        /// Index in the plane, from 0.
        index: usize,
        /// The value.
        found: f64,
    },
    /// No value is above 0.
    #[error(
        "is black: none of its values is above 0. The file is damaged or was never filled: copy or download it again."
    )]
    Black,
}

fn formats() -> String {
    format!(
        "a MERL file (.binary, {} bytes, beginning with the numbers {}) or a UTIA file (.bin, {} bytes)",
        MeasuredKind::Merl.file_bytes(),
        dimensions(&MERL_DIMENSIONS),
        MeasuredKind::Utia.file_bytes()
    )
}

fn dimensions([a, b, c]: &[i32; 3]) -> String {
    format!("{a} x {b} x {c}")
}
