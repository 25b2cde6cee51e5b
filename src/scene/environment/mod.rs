//! Environment images: radiance from every direction, read from a file or generated.
//!
//! [`EnvironmentFile::open`] reads the bytes and computes their fingerprint; [`EnvironmentFile::decode`] decodes the
//! pixels. A caller that finds the fingerprint in its cache skips decoding.

mod built_in;
mod decoded;
mod direction;
mod error;
mod float_image;
mod importance;
mod of_model;
mod open_exr;
mod panorama;
mod primaries;
mod projection;
mod radiance;
mod sky;
mod studio;
mod subsampled;
mod suns;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::sync::Arc;

use xxhash_rust::xxh3::xxh3_128_with_seed;

use crate::regular_file;

pub use built_in::BUILT_IN;
pub use decoded::{MAX_HEIGHT, MAX_WIDTH};
pub use direction::{direction_from_uv, uv_from_direction};
pub use error::{EnvironmentError, EnvironmentProblem};
pub use importance::CubeLuminance;
pub use of_model::{MODEL, ModelEnvironment};
pub use panorama::Environment;
pub use suns::{Sun, has_exact_sun, restore_clipped, separates_suns};

/// Largest supported file: the largest image with four floats a pixel, and a header.
const MAX_FILE_BYTES: u64 = MAX_WIDTH as u64 * MAX_HEIGHT as u64 * 16 + (1 << 20);
/// Raise this when the same bytes decode to other pixels. It seeds the fingerprint, so old cache entries are not used.
const DECODER_VERSION: u64 = 2;

/// An environment that was read but not decoded yet.
#[derive(Clone, Debug)]
pub struct EnvironmentFile {
    /// The built-in name, or the file's name without its extension.
    pub name: String,
    /// Absolute paths of the files it was read from, to watch. Empty for a built-in environment.
    pub files: Vec<PathBuf>,
    /// XXH3 (128 bits) of the bytes, or of a built-in environment's name and version. It is equal for equal content on
    /// every machine, so it can name a cache file.
    pub fingerprint: u128,
    given: PathBuf,
    source: Source,
}

#[derive(Clone, Debug)]
enum Source {
    BuiltIn(&'static str),
    Bytes(Vec<u8>),
    Model(Arc<ModelEnvironment>),
}

/// Whether settings name this environment by a word of Specula instead of a file.
pub fn is_word_of_specula(name: &str) -> bool {
    BUILT_IN.contains(&name) || name == MODEL || name == "none"
}

impl EnvironmentFile {
    /// The environment that the model's file brings along, as [`MODEL`] names it.
    ///
    /// # Errors
    /// The model has none.
    pub fn of_model(environment: Option<Arc<ModelEnvironment>>) -> Result<Self, EnvironmentError> {
        let (given, files) = (PathBuf::from(MODEL), Vec::new());
        let Some(environment) = environment else {
            let problem = EnvironmentProblem::NotInModel { built_in: BUILT_IN.join(", ") };
            return Err(EnvironmentError { file: given, problem, files });
        };
        let fingerprint = environment.fingerprint();
        Ok(Self { name: MODEL.to_owned(), files, fingerprint, given, source: Source::Model(environment) })
    }

    /// Opens `name`: a file, or else the environment of that name in [`BUILT_IN`].
    ///
    /// # Errors
    /// Fails if there is neither, or if the file cannot be read. The content is not examined yet.
    pub fn open(name: &str) -> Result<Self, EnvironmentError> {
        let given = PathBuf::from(name);
        let built_in = BUILT_IN.into_iter().find(|built_in| *built_in == name);
        if let Some(built_in) = built_in.filter(|_| !given.exists() || given.is_dir()) {
            let fingerprint = fingerprint(built_in::identity(built_in).as_bytes());
            let source = Source::BuiltIn(built_in);
            return Ok(Self { name: name.to_owned(), files: Vec::new(), fingerprint, given, source });
        }
        let path = std::path::absolute(&given).unwrap_or_else(|_| given.clone());
        let bytes = regular_file::read(&path, MAX_FILE_BYTES).map_err(|source| EnvironmentError {
            file: given.clone(),
            problem: EnvironmentProblem::Read { source, built_in: BUILT_IN.join(", ") },
            files: vec![path.clone()],
        })?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let fingerprint = fingerprint(&bytes);
        Ok(Self { name, files: vec![path], fingerprint, given, source: Source::Bytes(bytes) })
    }

    /// Decodes the pixels.
    ///
    /// # Errors
    /// Fails if the file is not an HDR or EXR image, is damaged, is larger than [`MAX_WIDTH`] x [`MAX_HEIGHT`], or has
    /// NaN or infinite values. Never panics, whatever the content.
    pub fn decode(&self) -> Result<Environment, EnvironmentError> {
        let mut environment = match &self.source {
            Source::BuiltIn(name) => built_in::make(name),
            Source::Model(environment) => environment.decode(),
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
