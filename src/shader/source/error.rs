//! Why a file of a shader tree cannot be used, and how large files may be.

/// Maximum size of a file in bytes. No shader is longer, and shaderc would hold several copies.
pub const MAX_FILE_BYTES: u64 = 4 << 20;
/// Largest size of an image file.
pub const MAX_IMAGE_BYTES: u64 = 256 << 20;

/// Why a file of a tree cannot be used. The message continues "FILE ...".
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SourceError {
    /// No such file.
    #[error("does not exist")]
    Missing,
    /// A directory instead of a file.
    #[error("is a directory, expected a GLSL file")]
    Directory,
    /// The file is not UTF-8.
    #[error("is not UTF-8 text (line {line}); save it as UTF-8")]
    NotUtf8 {
        /// First bad line, from 1.
        line: u32,
    },
    /// A NUL byte, which the compiler would treat as the end of the text.
    #[error("holds a NUL byte (line {line}); is it a binary file, or still being written?")]
    Nul {
        /// 1-based.
        line: u32,
    },
    /// A link to a file outside of the tree, which may come from elsewhere.
    #[error("is, or lies behind, a link that leads out of the shader tree; copy the file into the tree")]
    Outside,
    /// Larger than `MAX_FILE_BYTES`, or `MAX_IMAGE_BYTES` for an image.
    #[error("has {bytes} bytes, more than the {most} that such a file may have")]
    TooBig {
        /// Size found.
        bytes: u64,
        /// Largest size.
        most: u64,
    },
    /// Any other error of the system.
    #[error("cannot be read: {0}")]
    Io(String),
}

impl SourceError {
    /// The line of the file that is wrong, from 1.
    pub fn line(&self) -> Option<u32> {
        match self {
            Self::NotUtf8 { line } | Self::Nul { line } => Some(*line),
            _ => None,
        }
    }
}
