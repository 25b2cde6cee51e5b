//! Environment images: radiance from every direction, from a file or made by code.
//!
//! [`EnvironmentFile::open`] reads bytes and takes their fingerprint; [`EnvironmentFile::decode`] makes pixels of them.
//! Whoever has what it needs in a cache under the fingerprint skips the second.

mod built_in;
mod direction;
mod error;
mod float_image;
mod open_exr;
mod radiance;
mod sky;
mod studio;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::xxh3_128_with_seed;

pub use built_in::BUILT_IN;
pub use direction::{direction_from_uv, uv_from_direction};
pub use error::{EnvironmentError, EnvironmentProblem};

/// Widest image that is read, pixels.
pub const MAX_WIDTH: u32 = 16384;
/// Highest image that is read, pixels.
pub const MAX_HEIGHT: u32 = 8192;
/// Largest file that is read: the largest image with four floats a pixel, and a header.
const MAX_FILE_BYTES: u64 = MAX_WIDTH as u64 * MAX_HEIGHT as u64 * 16 + (1 << 20);
/// Raise it when the same bytes decode to other pixels, so that caches under the old fingerprints are not used.
const DECODER_VERSION: u64 = 1;

/// Linear RGB radiance from every direction, as an equirectangular image; see [`direction_from_uv`] for which texel is
/// where.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Environment {
    /// The built-in name, or the file's without its ending.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Radiance, linear RGB with Rec. 709 primaries; alpha is 1. Rows from top (+Y) to bottom, `width * height` in all;
    /// every value is finite and not negative.
    pub pixels: Vec<[f32; 4]>,
    /// Largest value of any channel.
    pub peak: f32,
    /// What the file's author may want to know: an odd aspect, no light at all.
    pub warnings: Vec<String>,
}

/// An environment that was read but not decoded.
#[derive(Clone, Debug)]
pub struct EnvironmentFile {
    /// The built-in name, or the file's without its ending.
    pub name: String,
    /// Absolute paths of the files that it was read from, to be watched; none for a built-in one.
    pub files: Vec<PathBuf>,
    /// Equal for equal content: XXH3 (128 bits) of the bytes, or of a built-in's name and version. The same on every
    /// machine, so that it may name a file of a cache.
    pub fingerprint: u128,
    given: PathBuf,
    source: Source,
}

#[derive(Clone, Debug)]
enum Source {
    BuiltIn(&'static str),
    Bytes(Vec<u8>),
}

impl EnvironmentFile {
    /// Reads what the user named: a file, or else the one of [`BUILT_IN`] with that name.
    ///
    /// # Errors
    /// When there is neither, or the file cannot be read. Its content is not looked at yet.
    pub fn open(name: &str) -> Result<Self, EnvironmentError> {
        let given = PathBuf::from(name);
        let built_in = BUILT_IN.into_iter().find(|built_in| *built_in == name);
        if let Some(built_in) = built_in.filter(|_| !given.exists() || given.is_dir()) {
            let fingerprint = fingerprint(built_in::identity(built_in).as_bytes());
            let source = Source::BuiltIn(built_in);
            return Ok(Self { name: name.to_owned(), files: Vec::new(), fingerprint, given, source });
        }
        let path = std::path::absolute(&given).unwrap_or_else(|_| given.clone());
        let bytes = read(&path).map_err(|source| EnvironmentError {
            file: given.clone(),
            problem: EnvironmentProblem::Read { source, built_in: BUILT_IN.join(", ") },
            files: vec![path.clone()],
        })?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let fingerprint = fingerprint(&bytes);
        Ok(Self { name, files: vec![path], fingerprint, given, source: Source::Bytes(bytes) })
    }

    /// Makes the pixels.
    ///
    /// # Errors
    /// When the file is no HDR or EXR image, is damaged, is larger than [`MAX_WIDTH`] times [`MAX_HEIGHT`], or has
    /// values that are no radiance. Never panics on any content.
    pub fn decode(&self) -> Result<Environment, EnvironmentError> {
        let mut environment = match &self.source {
            Source::BuiltIn(name) => built_in::make(name),
            Source::Bytes(bytes) => float_image::decode(bytes).map_err(|problem| EnvironmentError {
                file: self.given.clone(),
                problem,
                files: self.files.clone(),
            })?,
        };
        environment.name.clone_from(&self.name);
        Ok(environment)
    }
}

fn fingerprint(bytes: &[u8]) -> u128 {
    xxh3_128_with_seed(bytes, DECODER_VERSION)
}

/// Reads a regular file; a device or pipe might never end.
fn read(path: &Path) -> std::io::Result<Vec<u8>> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    if metadata.len() > MAX_FILE_BYTES {
        let size = format!("it has {} bytes, of which at most {MAX_FILE_BYTES} are read", metadata.len());
        return Err(std::io::Error::other(size));
    }
    std::fs::read(path)
}
