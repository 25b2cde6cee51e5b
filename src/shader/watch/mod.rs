//! Reports which files changed, once their writers are done. Knows no shaders: any directory, any files.
//!
//! The watcher watches directories, never single files: editors save by renaming over, by truncating and writing, or by
//! deleting and creating. It watches every directory that the path to a file leads through, the targets of symbolic links
//! included, so it also sees when a directory is removed and written again, and when a link is made to lead elsewhere.
//!
//! A changed file is reported under the name that the caller gave: the root as given, joined with the path below it; a single
//! file exactly as given. A file that has several such names is reported under each of them.
//!
//! Where the system has no notifications (its watches are used up), and on network mounts, which other machines write to,
//! the watcher looks at all files every 500 ms. `SPECULA_POLL=1` in the environment makes it do so everywhere.
//!
//! A plain save settles after 2 ms. A batch (a checkout, a deleted file) settles after 30 ms of silence, or after 150
//! ms at most. Content hashes drop saves that change nothing.

mod fingerprint;
mod mounts;
mod notifier;
mod plan;
mod state;
mod trail;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, unbounded};
use notify::Event;

use fingerprint::{Fingerprint, fingerprint};
use notifier::{Notifier, POLL};
use state::{Touched, WatchState};

/// A save of one existing, closed file is complete; this delay covers an editor's backup file beside it.
const SETTLE_SAVE: Duration = Duration::from_millis(2);
/// A batch with more files (a checkout), or with a missing file (an editor that deletes and creates), is delivered after this
/// long without events.
const SETTLE: Duration = Duration::from_millis(30);
/// A batch is delivered at the latest this long after its first event.
const SETTLE_CAP: Duration = Duration::from_millis(150);
/// The environment variable that disables notifications.
const POLL_VARIABLE: &str = "SPECULA_POLL";

/// Files that changed together.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Each file's content differs from what it was, or the file came or went. The paths are those that the caller gave:
    /// the root joined with the path below it, or a single file's path.
    pub paths: BTreeSet<PathBuf>,
    /// When the first event arrived: reload times count from here.
    pub first_event: Instant,
}

/// Why watching cannot start.
#[derive(Debug, thiserror::Error)]
pub enum WatchError {
    /// The root does not exist, or is not a directory.
    #[error("{}: cannot watch: {source}", path.display())]
    Root {
        /// As given.
        path: PathBuf,
        /// The system's message.
        source: std::io::Error,
    },
    /// The system cannot start a thread.
    #[error("cannot start the thread that watches for changes: {0}")]
    Thread(std::io::Error),
}

enum Message {
    Event(notify::Result<Event>),
    Files(Vec<PathBuf>),
    Stop,
}

/// Watches a directory tree and single files on its own thread, until dropped.
#[derive(Debug)]
pub struct Watcher {
    messages: Sender<Message>,
    thread: Option<JoinHandle<()>>,
}

impl Watcher {
    /// Watches all of `root` (if any) and `files`, wherever they are; `on_batch` is called on the watcher's thread. A file need
    /// not exist yet. Relative paths are resolved against the working directory.
    ///
    /// Create the watcher *before* reading the files: it reports changes from the content that it finds now.
    ///
    /// # Errors
    /// The root is not a directory, or the system grants no thread.
    pub fn new(
        root: Option<&Path>,
        files: &[PathBuf],
        on_batch: impl FnMut(Batch) + Send + 'static,
    ) -> Result<Self, WatchError> {
        let poll = std::env::var_os(POLL_VARIABLE).is_some_and(|value| !value.is_empty() && value != "0");
        let without = poll.then(|| format!("{POLL_VARIABLE} is set"));
        Self::start(root, files, without, on_batch)
    }

    /// `without` is a reason to poll instead of using notifications.
    fn start(
        root: Option<&Path>,
        files: &[PathBuf],
        without: Option<String>,
        on_batch: impl FnMut(Batch) + Send + 'static,
    ) -> Result<Self, WatchError> {
        if let Some(path) = root {
            // This fails for anything but a directory, with the system's message.
            std::fs::read_dir(path).map_err(|source| WatchError::Root { path: path.to_owned(), source })?;
        }
        let (messages, inbox) = unbounded();
        let events = messages.clone();
        let send = move |event| {
            // After a stop there is no receiver, and none is needed.
            let _ = events.send(Message::Event(event));
        };
        let notifier = Notifier::new(without.map_or(Ok(send), Err));
        let state = WatchState::new(root.map(Path::to_owned), files, notifier);
        let thread =
            std::thread::Builder::new().name("specula-watch".to_owned()).spawn(move || run(state, &inbox, on_batch));
        Ok(Self { messages, thread: Some(thread.map_err(WatchError::Thread)?) })
    }

    /// Replaces the single files: those of another model, say. The watcher reports each under the path given here.
    pub fn set_files(&self, files: &[PathBuf]) {
        let _ = self.messages.send(Message::Files(files.to_vec()));
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        let _ = self.messages.send(Message::Stop);
        if let Some(thread) = self.thread.take() {
            // A panic in the callback was reported where it happened.
            let _ = thread.join();
        }
    }
}

/// Changes that have not settled yet.
struct Pending {
    files: BTreeSet<PathBuf>,
    /// The content of files that polling has found: no event reports when their writers are done.
    looked: BTreeMap<PathBuf, Option<Fingerprint>>,
    first: Instant,
    last: Instant,
}

impl Pending {
    fn new(now: Instant) -> Self {
        Self { files: BTreeSet::new(), looked: BTreeMap::new(), first: now, last: now }
    }

    /// When to deliver the changes, unless more happens.
    fn due(&self, state: &WatchState) -> Instant {
        let is_save = self.looked.is_empty() && state.is_save(&self.files);
        (self.last + if is_save { SETTLE_SAVE } else { SETTLE }).min(self.first + SETTLE_CAP)
    }

    /// Whether a file that polling has found has changed again. Its writer gets more time, up to the cap.
    fn is_moving(&mut self, now: Instant) -> bool {
        let mut moving = false;
        for (path, content) in &mut self.looked {
            let found = fingerprint(path);
            moving |= found != std::mem::replace(content, found);
        }
        if moving {
            self.last = now;
        }
        moving && now < self.first + SETTLE_CAP
    }
}

/// Collects events until they settle, then delivers what differs.
fn run(mut state: WatchState, inbox: &Receiver<Message>, mut on_batch: impl FnMut(Batch)) {
    let mut pending: Option<Pending> = None;
    let mut looked = Instant::now();
    loop {
        let due = pending.as_ref().map(|pending| pending.due(&state));
        let next_look = (due.is_none() && state.must_poll()).then(|| looked + POLL);
        let message = match due.or(next_look) {
            None => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some(deadline) => inbox.recv_deadline(deadline),
        };
        let now = Instant::now();
        match message {
            Ok(message) => {
                let mut touched = Touched::default();
                // Directories are read once for all pending events.
                for message in std::iter::once(message).chain(inbox.try_iter()) {
                    match message {
                        Message::Event(Ok(event)) => state.note(&event, &mut touched),
                        Message::Event(Err(error)) => tracing::warn!("watching for changes: {error}"),
                        Message::Files(files) => state.set_files(&files),
                        Message::Stop => return,
                    }
                }
                if touched.directories {
                    touched.files.extend(state.replan());
                }
                if !touched.files.is_empty() {
                    let pending = pending.get_or_insert_with(|| Pending::new(now));
                    pending.files.extend(touched.files);
                    pending.last = Instant::now();
                }
            }
            Err(RecvTimeoutError::Timeout) => match pending.take() {
                None => {
                    let found = state.look();
                    looked = Instant::now();
                    if !found.is_empty() {
                        let pending = pending.insert(Pending::new(looked));
                        pending.files.extend(found.keys().cloned());
                        pending.looked = found;
                    }
                }
                Some(mut settled) => {
                    if settled.is_moving(now) {
                        pending = Some(settled);
                        continue;
                    }
                    let paths = state.changed(settled.files);
                    if !paths.is_empty() {
                        on_batch(Batch { paths, first_event: settled.first });
                    }
                }
            },
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

// Tests on real directories.
#[cfg(test)]
mod tests;
