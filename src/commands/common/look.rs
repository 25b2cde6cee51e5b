//! Reads the file of `--look`.

use std::path::Path;

use specula::picture::{self, Look, ReadError};

use crate::commands::Failure;

/// Reads a look. An unknown name or value is a usage error; a file that is not TOML is an input error.
pub(super) fn read_look(path: &Path) -> Result<Look, Failure> {
    picture::read_look(path).map_err(|error| match error {
        ReadError::File(message) => Failure::Input(message),
        ReadError::Text(error) => {
            // As `file:line:column: message`, which editors parse.
            let separator = if error.place.is_some() { ":" } else { ": " };
            let message = format!("{}{separator}{error}", path.display());
            if error.is_value { Failure::Usage(message) } else { Failure::Input(message) }
        }
    })
}
