//! Errors of loading an environment image, as messages for the user.

use std::path::PathBuf;

/// An environment that could not be loaded. The message is one paragraph: the file, what was found, what was expected,
/// what to do.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct EnvironmentError {
    /// The file as the user gave it.
    pub file: PathBuf,
    /// The fault.
    pub problem: EnvironmentProblem,
    /// Absolute paths of the files that were read or looked for. Watch these to retry once they change.
    pub files: Vec<PathBuf>,
}

/// A fault of an environment image.
#[derive(Debug, thiserror::Error)]
pub enum EnvironmentProblem {
    /// Neither a readable file nor a built-in name.
    #[error(
        "cannot be read: {source}. Expected a .hdr or .exr file that may be read, or one of the built-in \
         environments: {built_in}."
    )]
    Read {
        /// The operating system's message.
        source: std::io::Error,
        /// The built-in names, separated by commas.
        built_in: String,
    },
    /// The model's file has no environment.
    #[error(
        "is the environment of the model's file (EXT_lights_image_based), and this model has none that can be used. Choose \
         a .hdr or .exr file, or one of the built-in environments: {built_in}."
    )]
    NotInModel {
        /// The built-in names, separated by commas.
        built_in: String,
    },
    /// The file has no bytes.
    #[error("is empty. Expected a Radiance HDR or OpenEXR image; copy or export it again.")]
    Empty,
    /// An image format of low dynamic range.
    #[error(
        "is a {found} image, of low dynamic range, and cannot light a scene: expected Radiance HDR or OpenEXR. \
         Use the .hdr or .exr that it was made from."
    )]
    LowDynamicRange {
        /// The format.
        found: String,
    },
    /// Neither HDR nor EXR.
    #[error(
        "is not an environment image: expected Radiance HDR (which begins with `#?`) or OpenEXR (bytes 76 2f 31 01), \
         found {bytes} bytes of something else. Convert it to .hdr or .exr."
    )]
    UnknownFormat {
        /// Their number.
        bytes: usize,
    },
    /// A size outside the limits.
    #[error(
        "has {width}x{height} pixels, expected 1x1 to {}x{}. Scale it to a size in between; 2048x1024 is plenty.",
        super::decoded::MAX_WIDTH,
        super::decoded::MAX_HEIGHT
    )]
    Size {
        /// Columns according to the header.
        width: u64,
        /// Rows according to the header.
        height: u64,
    },
    /// The header declares more pixels than the file can hold.
    #[error(
        "is cut short: its header says {width}x{height} pixels, which takes at least {expected} bytes, \
         found {found}. Copy or download it again."
    )]
    TooShort {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The smallest possible size of such an image in bytes.
        expected: u64,
        /// The actual size in bytes.
        found: u64,
    },
    /// A file that the decoder rejects.
    #[error(
        "does not decode as {format}: expected a whole image, found: {found}. The file is damaged or cut short; copy \
         or export it again."
    )]
    Damaged {
        /// The format.
        format: &'static str,
        /// The decoder's message.
        found: String,
    },
    /// A valid file with a feature that Specula does not read.
    #[error("is {found}, expected {expected}. {todo}")]
    Unsupported {
        /// Found in the file.
        found: String,
        /// Supported by Specula.
        expected: &'static str,
        /// Advice to the user.
        todo: &'static str,
    },
    /// Pixels that are NaN or infinite.
    #[error(
        "has {count} {pixels} that cannot be light: the first is {value} in {channel} at x = {x}, y = {y}; expected \
         finite values everywhere. Repair the image, for example by clamping it to 0..60000 in an \
         image editor.",
        pixels = if *count == 1 { "pixel" } else { "pixels" }
    )]
    Values {
        /// The number of such pixels.
        count: usize,
        /// The first one's value: NaN or infinite.
        value: f32,
        /// "red", "green" or "blue".
        channel: &'static str,
        /// Column of the first one, from the left.
        x: usize,
        /// Row of the first one, from the top.
        y: usize,
    },
    /// A panic in a decoder, caught.
    #[error(
        "could not be decoded: the decoder panicked ({found}). The file is probably damaged; please report this and \
         attach the file."
    )]
    Refused {
        /// The panic's message.
        found: String,
    },
}
