//! The model and the shader tree that the command line, or else the look, names.

use std::path::{Path, PathBuf};

use specula::scene;
use specula::shader::Source;

use super::Common;
use super::look::read_look;
use crate::commands::Failure;

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
