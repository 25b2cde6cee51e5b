//! Records a window's work while it goes on.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::typed::{self, TypedText};
use super::{Geometry, GoodTexts, RecoveryState, SessionState};
use crate::message;
use crate::shader::{TreePath, text_hash};

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
    /// The texts in `typed.json`.
    typed: Vec<TypedText>,
    /// The thread that writes the texts.
    writing: Option<JoinHandle<()>>,
    start: Instant,
    /// When camera and window were last compared with the record.
    checked: Instant,
    /// Whether the camera of `state` is newer than that of the record.
    is_stale: bool,
}

impl Recorder {
    /// A recorder in a session's folder, or one that records nothing. `state` and `good` are what the folder has.
    pub fn new(folder: Option<PathBuf>, state: RecoveryState, good: GoodTexts) -> Self {
        let (start, checked) = (Instant::now(), Instant::now());
        let typed = folder.as_deref().map(typed::read).unwrap_or_default();
        Self(Arc::new(Mutex::new(Inner {
            folder,
            state,
            attempt: 0,
            good,
            generation: 0,
            typed,
            writing: None,
            start,
            checked,
            is_stale: false,
        })))
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
        if !is_same {
            inner.state.work = Some(work.clone());
            inner.is_stale = true;
        }
        if !is_alike || inner.checked.elapsed() > CAMERA_INTERVAL {
            inner.checked = Instant::now();
            let window = Some(window());
            if inner.is_stale || inner.state.window != window {
                inner.state.window = window;
                inner.write();
            }
        }
        inner.attempt
    }

    /// Records a camera that moved less than 250 ms before the window came to rest. Returns when to call again, unless all is recorded.
    pub fn rest(&self) -> Option<Duration> {
        let mut inner = self.lock();
        let wait = CAMERA_INTERVAL.saturating_sub(inner.checked.elapsed());
        if inner.is_stale && wait.is_zero() {
            inner.checked = Instant::now();
            inner.write();
        }
        inner.is_stale.then_some(wait)
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

    /// Records that the device has drawn the shaders of this generation, with their light. The first time for each generation, their texts
    /// become the good ones. A thread writes them, since they take milliseconds.
    pub fn drawn_all(&self, generation: u64, texts: &BTreeMap<TreePath, Arc<str>>) {
        let mut inner = self.lock();
        if inner.folder.is_none() || inner.generation == generation {
            return;
        }
        inner.generation = generation;
        let tree = inner.state.work.as_ref().and_then(|work| work.tree.clone());
        let (recorder, texts, before) = (self.clone(), texts.clone(), inner.writing.take());
        let write = move || {
            let _ = before.map(JoinHandle::join);
            let texts = texts.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect();
            recorder.keep_texts(GoodTexts { tree, texts });
        };
        match std::thread::Builder::new().name("specula-recorder".to_owned()).spawn(write) {
            Ok(thread) => inner.writing = Some(thread),
            Err(error) => inner.fail(&error),
        }
    }

    fn keep_texts(&self, good: GoodTexts) {
        let folder = Some(self.lock()).filter(|inner| inner.good != good).and_then(|inner| inner.folder.clone());
        let written = folder.as_ref().map(|folder| good.write(folder));
        let mut inner = self.lock();
        match written {
            Some(Err(error)) => return inner.fail(&error),
            Some(Ok(())) => (inner.state.losses, inner.good) = (0, good),
            None => {}
        }
        let Inner { state, good, .. } = &mut *inner;
        let is_drawn =
            |path: &String, hash: u64| good.texts.get(path).is_none_or(|text| text_hash(&Ok(text.clone())) == hash);
        state.suspects.retain(|path, hash| !is_drawn(path, *hash));
        inner.write();
    }

    /// The texts that were typed and not saved.
    pub fn typed(&self) -> Vec<TypedText> {
        self.lock().typed.clone()
    }

    /// Records the texts that were typed and not saved.
    pub fn record_typed(&self, now: Vec<TypedText>) {
        let mut inner = self.lock();
        if inner.typed == now {
            return;
        }
        if let Some(Err(error)) = inner.folder.as_ref().map(|folder| typed::write(folder, &now)) {
            inner.fail(&error);
        }
        inner.typed = now;
    }

    /// Records that the user has closed the window.
    pub fn close(&self) {
        let mut inner = self.lock();
        inner.state.is_closed = true;
        inner.write();
    }

    /// Writes everything, before the process ends because the device was lost.
    pub fn finish(&self) {
        let writing = self.lock().writing.take();
        let _ = writing.map(JoinHandle::join);
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
        self.is_stale = false;
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
