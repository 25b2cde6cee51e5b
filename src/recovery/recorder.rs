//! Records a window's work while it goes on.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::{Geometry, GoodTexts, RecoveryState, SessionState};
use crate::message;
use crate::shader::{ShaderSet, TreePath, text_hash};

/// How often a moving camera and the window's position are recorded.
const CAMERA_INTERVAL: Duration = Duration::from_millis(250);
/// A process that has lived this long ends a row of losses.
const LONG_LIFE: Duration = Duration::from_secs(60);

/// Writes [`RecoveryState`] and [`GoodTexts`] into the folder of the session. Clones record the same session.
#[derive(Clone)]
pub struct Recorder(Arc<Mutex<Inner>>);

struct Inner {
    /// `None` if there is no supervisor to read the records.
    folder: Option<PathBuf>,
    state: RecoveryState,
    /// Number of the session state in `state`, which increases with every change except those of the camera.
    attempt: u64,
    /// The texts in `good.json`, and the generation of their set in this process.
    good: GoodTexts,
    generation: u64,
    start: Instant,
    /// When camera and window were last compared with the record.
    checked: Instant,
}

impl Recorder {
    /// A recorder in a session's folder, or one that records nothing. `state` and `good` are what the folder has.
    pub fn new(folder: Option<PathBuf>, state: RecoveryState, good: GoodTexts) -> Self {
        let (start, checked) = (Instant::now(), Instant::now());
        Self(Arc::new(Mutex::new(Inner { folder, state, attempt: 0, good, generation: 0, start, checked })))
    }

    /// Safe mode: the previous process was lost and no new text has been drawn since. Then nothing is built ahead of time,
    /// because no text would be suspected.
    pub fn is_safe_mode(&self) -> bool {
        self.lock().state.losses > 0
    }

    /// The record of the previous process.
    pub fn state(&self) -> RecoveryState {
        self.lock().state.clone()
    }

    /// Records that these texts are about to be compiled and used, in addition to the current suspects. `quarantined` texts are
    /// not used. Returns the previous suspects.
    pub fn try_texts(
        &self,
        texts: BTreeMap<TreePath, u64>,
        quarantined: BTreeMap<TreePath, u64>,
    ) -> BTreeMap<String, u64> {
        let mut inner = self.lock();
        let before = inner.state.suspects.clone();
        inner.state.suspects.extend(texts.into_iter().map(|(path, hash)| (path.to_string(), hash)));
        inner.state.quarantined = quarantined.into_iter().map(|(path, hash)| (path.to_string(), hash)).collect();
        inner.write();
        before
    }

    /// Records that the texts of the last [`Recorder::try_texts`] do not compile, so that they never reach the device.
    pub fn take_back(&self, before: BTreeMap<String, u64>) {
        let mut inner = self.lock();
        inner.state.suspects = before;
        inner.write();
    }

    /// Records the state that the next frame shows, before it is submitted. Returns its number for [`Recorder::drawn`]. A moving
    /// camera and the `window` are recorded at intervals.
    pub fn begin(&self, work: &SessionState, window: impl FnOnce() -> Geometry) -> u64 {
        let mut inner = self.lock();
        let is_alike = inner.state.work.as_ref().is_some_and(|old| old.is_alike(work));
        let is_same = inner.state.work.as_ref() == Some(work);
        inner.attempt += u64::from(!is_alike);
        inner.state.work = Some(work.clone());
        if !is_alike || inner.checked.elapsed() > CAMERA_INTERVAL {
            inner.checked = Instant::now();
            let window = Some(window());
            if !is_same || inner.state.window != window {
                inner.state.window = window;
                inner.write();
            }
        }
        inner.attempt
    }

    /// Records that the device has drawn the state with this number.
    pub fn drawn(&self, attempt: u64) {
        let mut inner = self.lock();
        let is_new = match (&inner.state.work, &inner.state.good) {
            (Some(work), Some(good)) => !work.is_alike(good),
            _ => true,
        };
        if attempt == inner.attempt && is_new {
            inner.state.good = inner.state.work.clone();
            inner.write();
        }
    }

    /// Records that the device has drawn these shaders, with their light. The first time for each set, their texts become the
    /// good ones.
    pub fn drawn_all(&self, shaders: &ShaderSet) {
        let mut inner = self.lock();
        if inner.folder.is_none() || inner.generation == shaders.generation {
            return;
        }
        inner.generation = shaders.generation;
        let tree = inner.state.work.as_ref().and_then(|work| work.tree.clone());
        let texts = shaders.texts.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect();
        let good = GoodTexts { tree, texts };
        let is_drawn =
            |path: &String, hash: u64| good.texts.get(path).is_none_or(|text| text_hash(&Ok(text.clone())) == hash);
        inner.state.suspects.retain(|path, hash| !is_drawn(path, *hash));
        if inner.good != good {
            inner.state.losses = 0;
            inner.good = good;
            if let Some(Err(error)) = inner.folder.as_ref().map(|folder| inner.good.write(folder)) {
                inner.fail(&error);
            }
        }
        inner.write();
    }

    /// Writes everything, before the process ends because the device was lost.
    pub fn finish(&self) {
        self.lock().write();
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    fn write(&mut self) {
        if self.start.elapsed() > LONG_LIFE {
            self.state.losses = 0;
        }
        if let Some(Err(error)) = self.folder.as_ref().map(|folder| self.state.write(folder)) {
            self.fail(&error);
        }
    }

    /// Stops recording: the window continues, but nothing of it survives a loss.
    fn fail(&mut self, error: &std::io::Error) {
        // The folder is removed when the program ends.
        if self.folder.take().is_some_and(|folder| !folder.exists()) {
            return;
        }
        message::warn(format_args!("the session cannot be recorded ({error}), so a lost device would end it"));
    }
}
