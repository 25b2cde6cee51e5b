//! `--look`: the settings of a file, and the model and the shader tree that a picture names.

use std::path::{Path, PathBuf};

use specula::picture::{self, Look, ReadError};
use specula::scene;
use specula::shader::Source;

use super::{Common, Failure};

impl Common {
    /// Treats a shader file in the model's position as the shader tree. Options that the command line does not give come from the
    /// look.
    ///
    /// # Errors
    /// The look cannot be read, or a file that it names is gone.
    pub fn take_files(&mut self, model: &mut Option<PathBuf>) -> Result<(), Failure> {
        if self.shaders.is_none() && model.as_deref().is_some_and(|path| Source::is_file(path) && path.exists()) {
            self.shaders = model.take();
        }
        let Some(path) = self.look.as_deref() else { return Ok(()) };
        let look = read_look(path)?;
        let gone = |what: &str, file: &Path, option: &str| {
            let (path, file) = (path.display(), file.display());
            Err(Failure::Input(format!("{path}: its {what} {file} is not there; name it with {option}")))
        };
        match look.model {
            Some(file) if model.is_none() => {
                if !file.exists() && !scene::BUILT_IN.iter().any(|name| Path::new(name) == file) {
                    return gone("model", &file, "MODEL");
                }
                *model = Some(file);
            }
            _ => {}
        }
        match look.shaders {
            Some(tree) if self.shaders.is_none() && !tree.exists() => return gone("shader tree", &tree, "`--shaders`"),
            Some(tree) if self.shaders.is_none() => self.shaders = Some(tree),
            _ => {}
        }
        Ok(())
    }
}

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
