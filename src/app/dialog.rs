//! The file dialog of the desktop, through the XDG portal. It blocks, so it runs on a thread of its own.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::state::dialog::Dialog;
use crate::shader::embedded;
use crate::threads::NoDialog;

/// Extensions of models, environments, measured BRDFs, look files and single shaders.
const EXTENSIONS: [&str; 12] =
    ["gltf", "glb", "zip", "hdr", "exr", "binary", "bin", "toml", "png", "glsl", "frag", "fs"];
/// Extensions of models.
const MODELS: [&str; 3] = ["gltf", "glb", "zip"];
/// Extensions of look files and of pictures that hold a look.
const LOOKS: [&str; 2] = ["toml", "png"];
/// Extensions of pictures.
const PICTURES: [&str; 5] = ["png", "jpg", "jpeg", "hdr", "exr"];
/// Nobody cancels a dialog in less time than this. The portal reports a cancel and its own absence in the same way.
const SHORTEST: Duration = Duration::from_millis(300);

/// Waits for the user's choice. Returns nothing if the user cancels the dialog.
///
/// # Errors
/// The desktop shows no dialog.
pub(super) fn choose(dialog: Dialog) -> Result<Vec<PathBuf>, NoDialog> {
    let start = Instant::now();
    let one = |path| vec![path];
    let chosen = match dialog {
        Dialog::File => {
            let files = rfd::FileDialog::new().set_title("Open a model, environment or shader");
            files.add_filter("Models, environments, shaders", &EXTENSIONS).add_filter("All files", &["*"]).pick_files()
        }
        Dialog::Beside => {
            let files = rfd::FileDialog::new().set_title("Add a model");
            files.add_filter("Models", &MODELS).add_filter("All files", &["*"]).pick_files()
        }
        Dialog::Look => {
            let files = rfd::FileDialog::new().set_title("Open a look");
            files.add_filter("Looks", &LOOKS).add_filter("All files", &["*"]).pick_file().map(one)
        }
        Dialog::Tree => {
            rfd::FileDialog::new().set_title("Open a shader tree, or a folder with a model").pick_folder().map(one)
        }
        Dialog::Picture => {
            let files = rfd::FileDialog::new().set_title("A picture to compare with");
            files.add_filter("Pictures", &PICTURES).add_filter("All files", &["*"]).pick_file().map(one)
        }
        Dialog::SecondTree => rfd::FileDialog::new().set_title("A shader tree to compare with").pick_folder().map(one),
        Dialog::New => rfd::FileDialog::new().set_title("A folder for the shaders").pick_folder().map(one),
    };
    answer(chosen, start.elapsed())
}

fn answer(chosen: Option<Vec<PathBuf>>, after: Duration) -> Result<Vec<PathBuf>, NoDialog> {
    if chosen.is_none() && after < SHORTEST { Err(NoDialog) } else { Ok(chosen.unwrap_or_default()) }
}

/// Writes the built-in shaders, as `specula new` does, and returns their folder: the given one, or if it holds other files, a folder inside
/// it.
///
/// # Errors
/// A message: the folder cannot be written.
pub(super) fn write_tree(folder: PathBuf) -> Result<PathBuf, String> {
    let holds_files = std::fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some());
    let folder = if holds_files { folder.join("specula-shaders") } else { folder };
    let folder = std::path::absolute(&folder).unwrap_or(folder);
    embedded::write_to(&folder, None)
        .map(|_| folder.clone())
        .map_err(|error| format!("cannot write the shaders to {}: {error}", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cancel_is_told_from_a_missing_portal() {
        let paths = ["a.glb", "b.glb"].map(PathBuf::from).to_vec();
        assert_eq!(answer(Some(paths.clone()), Duration::ZERO), Ok(paths));
        assert_eq!(answer(None, Duration::from_secs(2)), Ok(Vec::new()));
        assert_eq!(answer(None, Duration::from_millis(20)), Err(NoDialog));
    }

    #[test]
    fn a_tree_is_written_beside_other_files_but_never_over_one() {
        let working = tempfile::tempdir().unwrap();
        let folder = working.path().join("shaders");
        assert_eq!(write_tree(folder.clone()), Ok(folder.clone()));
        assert!(folder.join("user.glsl").is_file());
        assert_eq!(write_tree(folder.clone()), Ok(folder.join("specula-shaders")));
        assert!(write_tree(folder).unwrap_err().contains("not empty"));
    }
}
