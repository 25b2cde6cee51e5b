//! Measured BRDFs: tables of reflectance measured on real materials, as references for the analytic BRDF.
//!
//! Reads the formats of two databases, recognized by content and size:
//!
//! - **MERL** (`.binary`): isotropic, over half and difference angles. Matusik et al. 2003, "A Data-Driven Reflectance
//!   Model".
//! - **UTIA** (`.bin`): anisotropic, over the angles of light and view. Filip & Vávra 2014, "Template-Based Sampling of
//!   Anisotropic BRDFs".
//!
//! `shaders/brdf/measured.glsl` reads [`MeasuredBrdf::values`]. All directions here are unit vectors in tangent space (x tangent, y bitangent,
//! z normal) that point away from the surface.

mod decoded;
mod error;
mod kind;
mod merl;
#[cfg(test)]
mod reference_tests;
#[cfg(test)]
mod tests;
mod utia;

use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::regular_file;
pub use error::{MeasuredError, MeasuredProblem};
pub use kind::MeasuredKind;

/// A measured BRDF.
#[derive(Clone, Debug)]
pub struct MeasuredBrdf {
    /// The file's name without its extension, which both databases use as the material's name.
    pub name: String,
    /// The database whose format the file has.
    pub kind: MeasuredKind,
    /// 1/sr, linear RGB triples in the file's order, none negative: 1,458,000 (MERL) or 82,944 (UTIA) of them.
    pub values: Vec<f32>,
    /// Absolute paths of the files that were read.
    pub files: Vec<PathBuf>,
    /// Warnings about the data, in sentences for the user.
    pub warnings: Vec<String>,
}

impl MeasuredBrdf {
    /// Reads a MERL `.binary` or a UTIA `.bin` file. Never reads more bytes than such a file has.
    ///
    /// # Errors
    /// Fails if the file cannot be read, has neither format, the wrong dimensions or the wrong size, contains a value
    /// that is not a finite number, or is entirely black.
    pub fn open(path: &Path) -> Result<Self, MeasuredError> {
        let open = || {
            let file = std::path::absolute(path).map_err(MeasuredProblem::Read)?;
            let (kind, bytes) = read(&file)?;
            let decoded = match kind {
                MeasuredKind::Merl => merl::decode(&bytes)?,
                MeasuredKind::Utia => utia::decode(&bytes)?,
            };
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            Ok(Self { name, kind, values: decoded.values, files: vec![file], warnings: decoded.warnings })
        };
        open().map_err(|problem| MeasuredError { file: path.to_owned(), problem })
    }
}

/// Reads the whole file once its first bytes and its length determine the format. The header's dimensions are only
/// compared, never used as a size.
fn read(path: &Path) -> Result<(MeasuredKind, Vec<u8>), MeasuredProblem> {
    if !std::fs::metadata(path).map_err(MeasuredProblem::Read)?.is_file() {
        return Err(MeasuredProblem::NotAFile);
    }
    let mut file = regular_file::open(path).map_err(MeasuredProblem::Read)?;
    let length = file.limit();
    let mut bytes = Vec::new();
    (&mut file).take(kind::MERL_HEADER_BYTES as u64).read_to_end(&mut bytes).map_err(MeasuredProblem::Read)?;
    let kind = recognize(&bytes, length, path.extension())?;
    let rest = (kind.file_bytes() - bytes.len()) as u64;
    file.take(rest).read_to_end(&mut bytes).map_err(MeasuredProblem::Read)?;
    // The length was right before, so the file was truncated while it was read.
    if bytes.len() != kind.file_bytes() {
        return Err(MeasuredProblem::Size { kind, found: bytes.len() as u64 });
    }
    Ok((kind, bytes))
}

/// Determines the format from the first bytes and the length. UTIA has no header, so only its length can tell. The
/// extension only selects the error message.
fn recognize(header: &[u8], length: u64, extension: Option<&OsStr>) -> Result<MeasuredKind, MeasuredProblem> {
    let is_called = |name| extension.is_some_and(|extension| extension.eq_ignore_ascii_case(name));
    let of_length = |kind: MeasuredKind| {
        let right = length == kind.file_bytes() as u64;
        if right { Ok(kind) } else { Err(MeasuredProblem::Size { kind, found: length }) }
    };
    if length == 0 {
        return Err(MeasuredProblem::Empty);
    }
    let dimensions = merl::dimensions(header);
    if dimensions == Some(kind::MERL_DIMENSIONS) {
        return of_length(MeasuredKind::Merl);
    }
    if length == MeasuredKind::Utia.file_bytes() as u64 {
        return Ok(MeasuredKind::Utia);
    }
    // Small numbers are probably dimensions. Others may be anything, such as a part of a secret, and a message must not print that.
    let plausible = |found: &[i32; 3]| found.iter().all(|n| (1..=4096).contains(n));
    match dimensions.filter(plausible) {
        Some(found) => Err(MeasuredProblem::Dimensions { found }),
        None if is_called("bin") => of_length(MeasuredKind::Utia),
        None => Err(MeasuredProblem::Unknown { found: length }),
    }
}
