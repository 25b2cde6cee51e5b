//! Commands about looks: settings in a file.

use std::path::PathBuf;

use serde::Deserialize;
use serde_json::json;

use super::file::choose;
use super::spec::{Spec, Until};
use crate::app::state::dialog::Dialog;
use crate::picture::{numbered_as, write_look};

/// Fields of `save-look`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct SaveLook {
    /// `None` for the next free name in the working directory.
    file: Option<PathBuf>,
}

pub(in crate::app) static SAVE_LOOK: Spec<SaveLook> = Spec::new("save-look", |state, _, SaveLook { file }| {
    let file = file.unwrap_or_else(|| numbered_as("specula-look", "toml"));
    write_look(&state.session.settings, &file)?;
    let whole = std::path::absolute(&file).unwrap_or_else(|_| file.clone());
    state.say(format!("wrote {}", whole.display()));
    Ok(Until::Now(json!({ "file": file })))
})
.takes(
    r#""file"?: "look.toml""#,
    "Writes all settings to a look file, which `open` and --look read. Without a file to specula-look-N.toml. Result: file",
)
.arguments(|_| SaveLook::default())
.label("Save the look", "settings preset TOML write file");

/// Opens a look that the user chooses in the file dialog.
pub(in crate::app) static CHOOSE_LOOK: Spec<()> =
    Spec::fallible("choose-look", |state, engine, ()| choose(state, engine, Dialog::Look))
        .label("Open a look", "settings preset TOML PNG picture file load")
        .of_window();
