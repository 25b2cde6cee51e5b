//! Records of a window's session, for the process that takes its place when the device is lost or the driver crashes.
//!
//! `specula view` runs the window as a child process. The child's [`Recorder`] keeps three files in a folder of the session: the
//! [`RecoveryState`], written before anything new reaches the device, the [`GoodTexts`], written after the device has drawn them, and each
//! [`TypedText`].
//! After a loss, [`RecoveryState::after_loss`] compares the two and decides what the next process leaves out: the texts under
//! suspicion, or else the settings.
//!
//! # Losing the device
//!
//! Drivers cannot always create a lost device again in the same process, a hung device blocks every destructor, and a
//! crash leaves no process. So all three are handled alike: the process that draws the window ends, and
//! `commands/view/supervisor.rs` starts another one with the same arguments. A signal of a crash, a panic of the
//! window's thread, and the exit codes for a lost or hung device count as losses.
//!
//! The folder of the records can be read by the user only, and is in memory where the system offers that
//! (`XDG_RUNTIME_DIR`, `/dev/shm`):
//!
//! - **Before** anything new reaches the compiler or the device, the window records its settings, model, tree,
//!   geometry, and the hashes of the changed texts (`suspects`). This takes 0.5 ms for an edit. A moving camera is
//!   recorded every 250 ms, when it comes to rest, and at each edit.
//! - **After** the device has drawn it, the window records the settings of a frame that has finished (`good`), and the
//!   texts once the picture has settled, with all of its stages and light (`good.json`).
//! - **After each key**, the window records the texts that were typed in the panel Source and not saved (`typed.json`). The next window has them
//!   as they were, unsaved, whatever the cause of the loss: they have never reached the device.
//!
//! After a loss, the suspect texts that differ from the good ones are **quarantined**, all together, since only
//! together they are known to be bad. The next window reads a `Source::Quarantined`, in which every file that differs
//! from its last good text has that text, so the picture and all modes come back first. Then the files on disk follow
//! as an ordinary edit, except the quarantined ones: each is a diagnostic, and the good text stays until one of them
//! changes. Before the first frame, the embedded texts count as good, so a tree that loses the device at once can still
//! be opened. If no text was new, settings, model and tree are **set back** to what was drawn last, and a message names
//! the differences. The camera stays.
//!
//! A row of losses ends with a frame of a new text, or after a minute. The third loss in a row ends the session with
//! exit code 3 and the names of the quarantined files. While a row lasts, the window is in safe mode and builds no
//! pipelines ahead of time, since nothing would be suspected if that crashed. The event `restarted` reports what
//! happened. Commands without a window end with exit code 3.
//!
//! Limits: after a loss, the next window needs a device at once; if the driver is still resetting it and offers none,
//! the session ends. A setting that loses the device before the picture has settled is blamed on the texts, and an edit
//! on top of one that has not settled is set back with it.

mod files;
mod paths;
mod recorder;
mod typed;

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::settings::Settings;
use crate::shader::{Source, TreePath, text_hash};

use files::{read, unfinished, write};
pub use recorder::Recorder;
pub use typed::{TypedText, keep_typed};

/// The environment variable with the folder of the session, by which a process knows that it is the child.
pub const VARIABLE: &str = "SPECULA_SESSION";
/// Exit code of a child whose device was lost. Its parent does not pass it on.
pub const LOST: u8 = 75;
/// Exit code of a child whose device does not respond. Its parent does not pass it on.
pub const HUNG: u8 = 76;
/// The session ends after this many losses in a row.
pub const MOST_LOSSES: u32 = 3;

const STATE: &str = "state.json";
const GOOD: &str = "good.json";

/// The user's settings, model and shader tree.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SessionState {
    /// The settings.
    #[serde(serialize_with = "shared::serialize", deserialize_with = "shared::deserialize")]
    pub settings: Arc<Settings>,
    /// The model's file; `None` is the built-in one.
    #[serde(default, with = "paths::optional")]
    pub model: Option<PathBuf>,
    /// The scene of the model's file (`--scene`); `None` is the file's own.
    #[serde(default)]
    pub scene: Option<usize>,
    /// The shader tree's folder or file; `None` is the tree in the program.
    #[serde(default, with = "paths::optional")]
    pub tree: Option<PathBuf>,
}

impl SessionState {
    /// Whether both show the same from two places: see [`Settings::is_alike`].
    pub fn is_alike(&self, other: &Self) -> bool {
        (&self.model, self.scene, &self.tree) == (&other.model, other.scene, &other.tree)
            && (Arc::ptr_eq(&self.settings, &other.settings) || self.settings.is_alike(&other.settings))
    }

    /// The same state with the camera and the directions of orbiting lights of `other`.
    fn placed_as(&self, other: &Self) -> Self {
        Self { settings: Arc::new(self.settings.placed_as(&other.settings)), ..self.clone() }
    }

    /// The names of what differs, as `shader.TOON_BANDS`; settings by their path in `--set`.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let mut out = Vec::new();
        let value = |settings: &Settings| serde_json::to_value(settings).unwrap_or_default();
        differences(&value(&self.settings), &value(&other.settings), "", &mut out);
        out.extend((self.model != other.model).then(|| "the model".to_owned()));
        out.extend((self.scene != other.scene).then(|| "the scene".to_owned()));
        out.extend((self.tree != other.tree).then(|| "the shader tree".to_owned()));
        out
    }
}

/// Settings in the records, which have no shared values.
mod shared {
    use super::{Arc, Deserialize as _, Serialize as _, Settings};

    pub(super) fn serialize<S: serde::Serializer>(settings: &Settings, to: S) -> Result<S::Ok, S::Error> {
        settings.serialize(to)
    }

    pub(super) fn deserialize<'a, D: serde::Deserializer<'a>>(from: D) -> Result<Arc<Settings>, D::Error> {
        Settings::deserialize(from).map(Arc::new)
    }
}

fn differences(a: &Value, b: &Value, path: &str, out: &mut Vec<String>) {
    let (Value::Object(a), Value::Object(b)) = (a, b) else {
        if a != b {
            out.push(path.to_owned());
        }
        return;
    };
    let names: std::collections::BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    for name in names {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        differences(a.get(name).unwrap_or(&Value::Null), b.get(name).unwrap_or(&Value::Null), &path, out);
    }
}

/// Size and place of the window, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// Size without the frame of the window manager.
    pub size: (u32, u32),
    /// Upper left corner on the desktop, where the window system tells it.
    pub at: Option<(i32, i32)>,
}

/// The last loss, for messages.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Loss {
    /// The reason, as "the graphics device was lost".
    pub cause: String,
    /// Names of the settings that were reset, since no text was new.
    pub reset: Vec<String>,
}

/// The record of a process for its successor: the state of its session, and the texts that the device has not drawn yet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RecoveryState {
    /// Losses in a row so far.
    pub losses: u32,
    /// The last loss.
    pub loss: Option<Loss>,
    /// The state of the session; `None` before the first frame.
    pub work: Option<SessionState>,
    /// The state that the device has drawn without a fault.
    pub good: Option<SessionState>,
    /// Texts that the device has not drawn yet, by path and [`text_hash`]: a loss is blamed on them.
    pub suspects: BTreeMap<String, u64>,
    /// Texts that are not compiled until one of them changes.
    pub quarantined: BTreeMap<String, u64>,
    /// The window.
    pub window: Option<Geometry>,
    /// Whether the user has closed the window. What fails after that is no loss.
    pub is_closed: bool,
}

impl RecoveryState {
    /// The state that was recorded in a session's folder; the default if there is none.
    pub fn read(folder: &Path) -> Self {
        read(folder, STATE).unwrap_or_default()
    }

    /// Records the state.
    ///
    /// # Errors
    /// The system's.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        write(folder, STATE, self)
    }

    /// The record that the next process starts with, after a panic of the window's thread with this `cause`: a fault of Specula. Neither a
    /// text nor a setting is suspected, unless the next process fails, too.
    #[must_use]
    pub fn after_panic(mut self, cause: &str) -> Self {
        self.losses += 1;
        self.suspects.clear();
        self.loss = Some(Loss { cause: cause.to_owned(), reset: Vec::new() });
        self
    }

    /// The record that the next process starts with, after a loss with this `cause`. New texts are suspected first. If there are
    /// none, the state is reset to what was drawn last, except for the camera and the lights' directions. `good` are the texts
    /// that the device has drawn.
    #[must_use]
    pub fn after_loss(mut self, cause: &str, good: &GoodTexts) -> Self {
        self.losses += 1;
        let embedded = Source::embedded();
        let is_new = |(path, hash): &(&String, &u64)| {
            let text = good.texts.get(*path).cloned().map(Ok);
            // The last good frame did not use the file.
            text_hash(&text.unwrap_or_else(|| embedded.read(&TreePath::from(path.as_str())))) != **hash
        };
        let new: BTreeMap<String, u64> =
            self.suspects.iter().filter(is_new).map(|(path, hash)| (path.clone(), *hash)).collect();
        let in_good_tree = self.work.as_ref().is_none_or(|work| work.tree == good.tree);
        let mut reset = Vec::new();
        if in_good_tree && !new.is_empty() {
            self.quarantined.extend(new);
        } else if let (Some(work), Some(good)) = (&mut self.work, &self.good)
            && !work.is_alike(good)
        {
            let placed = good.placed_as(work);
            reset = work.differences(&placed);
            *work = placed;
        }
        self.suspects.clear();
        self.loss = Some(Loss { cause: cause.to_owned(), reset });
        self
    }

    /// The tree to read: [`Source::quarantined`] if the device was lost while it was in use.
    pub fn source(&self, tree: Source, good: GoodTexts) -> Source {
        let (Some(loss), Some(location)) = (&self.loss, tree.location()) else { return tree };
        if good.tree.as_deref() != Some(location) {
            return tree;
        }
        let path = |text: &String| TreePath::parse(text);
        let texts = good.texts.iter().filter_map(|(name, text)| Some((path(name)?, text.clone()))).collect();
        let quarantined = self.quarantined.iter().filter_map(|(name, hash)| Some((path(name)?, *hash))).collect();
        Source::quarantined(&tree, &texts, quarantined, &format!("{} while this text was in use", loss.cause))
    }
}

/// The texts of the shaders that the device has drawn last.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GoodTexts {
    /// The tree's folder or file.
    #[serde(default, with = "paths::optional")]
    pub tree: Option<PathBuf>,
    /// Texts by path.
    pub texts: BTreeMap<String, String>,
}

impl GoodTexts {
    /// The texts that differ from those of the built-in shaders, in whose place they were drawn.
    pub fn over_built_in(&self) -> BTreeMap<TreePath, Arc<str>> {
        let built_in = Source::embedded();
        let text = |(name, text): (&String, &String)| {
            let path = TreePath::parse(name)?;
            (built_in.read(&path).ok().as_ref() != Some(text)).then(|| (path, Arc::from(text.as_str())))
        };
        self.texts.iter().filter_map(text).collect()
    }

    /// The texts that were recorded in a session's folder. Before the first frame, the embedded texts count as good for every
    /// tree.
    pub fn read(folder: &Path, tree: Option<&Path>) -> Self {
        read(folder, GOOD).unwrap_or_else(|| {
            let embedded = Source::embedded();
            let text = |path: TreePath| Some((path.to_string(), embedded.read(&path).ok()?));
            Self { tree: tree.map(Path::to_owned), texts: embedded.list().into_iter().filter_map(text).collect() }
        })
    }

    fn write(&self, folder: &Path) -> io::Result<()> {
        write(folder, GOOD, self)
    }
}

/// Removes the folder of a session, if it contains nothing but the records.
pub fn remove_folder(folder: &Path) {
    // Under another name, since a thread may still be recording.
    let ended = folder.with_extension("ended");
    if fs::rename(folder, &ended).is_err() {
        return;
    }
    for name in [STATE, GOOD, typed::TYPED] {
        let _ = fs::remove_file(ended.join(name));
        let _ = fs::remove_file(unfinished(&ended, name));
    }
    let _ = fs::remove_dir(ended);
}

#[cfg(test)]
mod tests;
