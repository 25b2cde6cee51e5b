//! Why an environment image was not loaded, in words for the person who opened it.

use std::path::PathBuf;

/// An environment that could not be loaded. Its message is one paragraph: the file, what was found, what was expected,
/// what to do.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct EnvironmentError {
    /// The file as the user gave it.
    pub file: PathBuf,
    /// What is wrong with it.
    pub problem: EnvironmentProblem,
    /// Absolute paths of the files that were read or looked for: whoever waits for the repair watches these.
    pub files: Vec<PathBuf>,
}

/// What is wrong with an environment image.
#[derive(Debug, thiserror::Error)]
pub enum EnvironmentProblem {
    /// Neither a file that can be read nor a built-in name.
    #[error(
        "cannot be read: {source}. Expected a .hdr or .exr file that may be read, or one of the built-in \
         environments: {built_in}."
    )]
    Read {
        /// The operating system's words.
        source: std::io::Error,
        /// The built-in names, separated by commas.
        built_in: String,
    },
    /// The file has no bytes.
    #[error("is empty. Expected a Radiance HDR or OpenEXR image; copy or export it again.")]
    Empty,
    /// An image format without radiance above white.
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
         found {found}. Convert it to .hdr or .exr."
    )]
    UnknownFormat {
        /// The first bytes.
        found: String,
    },
    /// A size that is not read.
    #[error(
        "has {width}x{height} pixels, expected 1x1 to {}x{}. Scale it to a size in between; 2048x1024 is plenty.",
        super::MAX_WIDTH,
        super::MAX_HEIGHT
    )]
    Size {
        /// Columns, as the header has it.
        width: u64,
        /// Rows, as the header has it.
        height: u64,
    },
    /// The header promises more than the file can hold.
    #[error(
        "is cut short: its header says {width}x{height} pixels, for which at least {expected} bytes are expected, \
         found {found}. Copy or download it again."
    )]
    TooShort {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Fewest bytes in which that many pixels can be written.
        expected: u64,
        /// Bytes there are.
        found: u64,
    },
    /// A file that the decoder gave up on.
    #[error(
        "does not decode as {format}: expected a whole image, found: {found}. The file is damaged or cut short; copy \
         or export it again."
    )]
    Damaged {
        /// The format.
        format: &'static str,
        /// The decoder's words.
        found: String,
    },
    /// A valid file of a kind that is not read.
    #[error("is {found}, expected {expected}. {todo}")]
    Unsupported {
        /// What the file has.
        found: String,
        /// What is read.
        expected: &'static str,
        /// What to do.
        todo: &'static str,
    },
    /// Values that are no radiance.
    #[error(
        "has {count} {pixels} that cannot be light: the first is {value} in {channel} at x = {x}, y = {y}; expected \
         finite values of 0 and more everywhere. Repair the image, for example by clamping it to 0..60000 in an \
         image editor.",
        pixels = if *count == 1 { "pixel" } else { "pixels" }
    )]
    Values {
        /// How many pixels have one.
        count: usize,
        /// The first one's value: NaN, infinite or negative.
        value: f32,
        /// "red", "green" or "blue".
        channel: &'static str,
        /// Column of the first, from the left.
        x: usize,
        /// Row of the first, from the top.
        y: usize,
    },
    /// A panic in a decoder, caught.
    #[error(
        "was refused: the decoder stopped at something it did not expect ({found}). The file is most likely damaged; \
         please report it with the file."
    )]
    Refused {
        /// The panic's words.
        found: String,
    },
}
