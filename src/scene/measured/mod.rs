//! Measured BRDFs: tables of reflectance measured on real materials, as references for the analytic BRDF.
//!
//! Reads the formats of two databases, recognized by content and size:
//!
//! - **MERL** (`.binary`): isotropic, over half and difference angles. Matusik et al. 2003, "A Data-Driven Reflectance
//!   Model".
//! - **UTIA** (`.bin`): anisotropic, over the angles of light and view. Filip & Vávra 2014, "Template-Based Sampling of
//!   Anisotropic BRDFs".
//!
//! `shaders/brdf/measured.glsl` reads [`Measured::values`]; [`Measured::evaluate`] does the same lookup on the CPU. All
//! directions here are unit vectors in tangent space (x tangent, y bitangent, z normal) that point away from the
//! surface.

mod error;
mod grid;
mod merl;
#[cfg(test)]
mod tests;
mod utia;

use std::ffi::OsStr;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::Vec3;

use crate::regular_file;
pub use error::{MeasuredError, MeasuredProblem};

/// Negative values are failed measurements. If more than this fraction of all values is negative, the user is warned.
const UNUSUAL: f64 = 0.05;

/// The database whose format a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredKind {
    /// Isotropic; theta_h x theta_d x phi_d = 90 x 90 x 180.
    Merl,
    /// Anisotropic; (theta x phi) of the light by (theta x phi) of the view, (6 x 48) x (6 x 48).
    Utia,
}

impl MeasuredKind {
    /// The database's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Merl => "MERL",
            Self::Utia => "UTIA",
        }
    }

    /// The size of every file of this format, bytes.
    pub fn file_bytes(self) -> usize {
        match self {
            Self::Merl => merl::FILE_BYTES,
            Self::Utia => utia::FILE_BYTES,
        }
    }

    /// Encodes `f(l, v)`, in 1/sr for directions above the horizon, as a file of this format. Other programs can read
    /// it, and the tests read it back.
    pub fn encode(self, f: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<u8> {
        match self {
            Self::Merl => merl::encode(f),
            Self::Utia => utia::encode(f),
        }
    }
}

/// A measured BRDF.
#[derive(Clone, Debug)]
pub struct MeasuredBrdf {
    /// The file's name without its extension, which both databases use as the material's name.
    pub name: String,
    /// The file's name without its extension. Both databases use it as the material's name.
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

    /// f(l, v) in 1/sr, linearly interpolated; black if either direction is below the horizon.
    pub fn evaluate(&self, l: Vec3, v: Vec3) -> Vec3 {
        if !(l.z > 0.0 && v.z > 0.0) {
            return Vec3::ZERO;
        }
        match self.kind {
            MeasuredKind::Merl => merl::evaluate(&self.values, l, v),
            MeasuredKind::Utia => utia::evaluate(&self.values, l, v),
        }
    }
}

/// A file's values as RGB triples, and warnings about them.
struct Decoded {
    values: Vec<f32>,
    warnings: Vec<String>,
}

/// Reads the whole file once its first bytes and its length determine the format. The header's dimensions are only
/// compared, never used as a size.
fn read(path: &Path) -> Result<(MeasuredKind, Vec<u8>), MeasuredProblem> {
    let metadata = std::fs::metadata(path).map_err(MeasuredProblem::Read)?;
    if !metadata.is_file() {
        return Err(MeasuredProblem::NotAFile);
    }
    let mut file = regular_file::open(path).map_err(MeasuredProblem::Read)?;
    let mut bytes = Vec::new();
    (&mut file).take(merl::HEADER_BYTES as u64).read_to_end(&mut bytes).map_err(MeasuredProblem::Read)?;
    let kind = recognize(&bytes, metadata.len(), path.extension())?;
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
    if dimensions == Some(merl::DIMENSIONS) {
        return of_length(MeasuredKind::Merl);
    }
    if length == MeasuredKind::Utia.file_bytes() as u64 {
        return Ok(MeasuredKind::Utia);
    }
    // Small numbers are probably dimensions; the first bytes of a double or of text are not small numbers.
    let plausible = |found: &[i32; 3]| is_called("binary") || found.iter().all(|n| (1..=4096).contains(n));
    match dimensions.filter(plausible) {
        Some(found) => Err(MeasuredProblem::Dimensions { found }),
        None if is_called("bin") => of_length(MeasuredKind::Utia),
        None => Err(MeasuredProblem::Unknown { found: length }),
    }
}

/// Converts three planes of doubles (red, green, blue) to RGB triples of `f32`, multiplied by `scale`.
fn interleave(planes: &[u8], scale: [f64; 3]) -> Result<Vec<f32>, MeasuredProblem> {
    let (doubles, _) = planes.as_chunks::<8>();
    let cells = doubles.len() / 3;
    let mut values = vec![0.0; cells * 3];
    for (index, bytes) in doubles.iter().enumerate() {
        let (channel, cell) = (index / cells, index % cells);
        let found = f64::from_le_bytes(*bytes);
        let value = (found * scale[channel]) as f32;
        if !value.is_finite() {
            return Err(MeasuredProblem::NotANumber { channel: ["red", "green", "blue"][channel], index: cell, found });
        }
        values[cell * 3 + channel] = value;
    }
    if values.iter().any(|&value| value > 0.0) { Ok(values) } else { Err(MeasuredProblem::Black) }
}

/// A warning if unusually many values (`negative` of `all`) were negative and set to 0.
fn warn_of_negative(negative: usize, all: usize) -> Option<String> {
    let part = negative as f64 / all as f64;
    (part > UNUSUAL).then(|| {
        format!(
            "{negative} of {all} values ({:.0} %) are negative where both directions are above the horizon, and are \
             treated as 0. A few are normal. This many mean that most of the measurement failed, or that the file is \
             not what it seems.",
            100.0 * part
        )
    })
}
