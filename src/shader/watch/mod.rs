//! Tells which files changed, once they have come to rest. Knows no shaders: any directory, any files.
//!
//! Directories are watched, never single files: editors save by renaming over, by truncating and writing, by deleting and
//! creating. The root's parent is watched too, so a root moved away and back is seen.

mod fingerprint;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, unbounded};
use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind};
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher as _};

use crate::shader::source::directory;
use fingerprint::{Fingerprint, fingerprint};

/// A save of one file that is there and closed is complete; this long covers an editor's own backup file beside it.
const SETTLE_SAVE: Duration = Duration::from_millis(3);
/// A batch with more files (a checkout), or with one that is gone (an editor that deletes and creates), is delivered when nothing
/// happened for this long.
const SETTLE: Duration = Duration::from_millis(30);
/// A batch is delivered at the latest this long after its first event.
const SETTLE_CAP: Duration = Duration::from_millis(150);

/// Files that changed together.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Absolute paths without symbolic links in the root; each file's content differs from what it was, or it came or went.
    pub paths: BTreeSet<PathBuf>,
    /// When the first event arrived: reload times count from here.
    pub first_event: Instant,
}

/// Why watching cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum WatchError {
    /// The root does not exist, or is no directory.
    #[error("{}: cannot watch: {source}", path.display())]
    Root {
        /// As given.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The system refuses.
    #[error("cannot watch for changes: {0}; on Linux, raise fs.inotify.max_user_watches or max_user_instances")]
    System(#[from] notify::Error),
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
    /// Watches all of `root` (if any) and `files` wherever they are; `on_batch` is called on the watcher's thread.
    ///
    /// Create the watcher *before* reading the files: content found now is the content that changes are measured from.
    ///
    /// # Errors
    /// A root that cannot be resolved, or a system that grants no watch.
    pub fn new(
        root: Option<&Path>,
        files: &[PathBuf],
        on_batch: impl FnMut(Batch) + Send + 'static,
    ) -> Result<Self, WatchError> {
        let root = match root {
            Some(path) => {
                Some(path.canonicalize().map_err(|source| WatchError::Root { path: path.to_owned(), source })?)
            }
            None => None,
        };
        let (messages, inbox) = unbounded();
        let events = messages.clone();
        let system = notify::recommended_watcher(move |event| {
            // After a stop nobody listens, and nobody needs to.
            let _ = events.send(Message::Event(event));
        })?;
        let mut state =
            State { system, root, files: BTreeSet::new(), watched: BTreeSet::new(), known: BTreeMap::new() };
        state.watch_root()?;
        state.set_files(files);
        state.learn();
        let thread =
            std::thread::Builder::new().name("specula-watch".to_owned()).spawn(move || run(state, &inbox, on_batch));
        let thread = thread.map_err(|error| WatchError::System(notify::Error::io(error)))?;
        Ok(Self { messages, thread: Some(thread) })
    }

    /// Replaces the files watched beside the root: those of another model, say.
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

/// Collects events until they settle, then delivers what differs.
fn run(mut state: State, inbox: &Receiver<Message>, mut on_batch: impl FnMut(Batch)) {
    let mut pending: BTreeSet<PathBuf> = BTreeSet::new();
    let mut first: Option<Instant> = None;
    let mut last = Instant::now();
    loop {
        let message = match first {
            None => inbox.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some(first) => inbox.recv_deadline((last + state.settle(&pending)).min(first + SETTLE_CAP)),
        };
        match message {
            Ok(Message::Event(Ok(event))) => {
                let touched = state.candidates(&event);
                if !touched.is_empty() {
                    last = Instant::now();
                    first.get_or_insert(last);
                    pending.extend(touched);
                }
            }
            Ok(Message::Event(Err(error))) => tracing::warn!("watching for changes: {error}"),
            Ok(Message::Files(files)) => state.set_files(&files),
            Ok(Message::Stop) | Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                let paths = state.changed(std::mem::take(&mut pending));
                if let Some(first_event) = first.take().filter(|_| !paths.is_empty()) {
                    on_batch(Batch { paths, first_event });
                }
            }
        }
    }
}

struct State {
    system: RecommendedWatcher,
    root: Option<PathBuf>,
    /// Single files outside the root.
    files: BTreeSet<PathBuf>,
    /// Directories watched for `files`.
    watched: BTreeSet<PathBuf>,
    /// Content of every file that exists.
    known: BTreeMap<PathBuf, Fingerprint>,
}

impl State {
    fn watch_root(&mut self) -> Result<(), notify::Error> {
        let Some(root) = &self.root else { return Ok(()) };
        self.system.watch(root, RecursiveMode::Recursive)?;
        if let Some(parent) = root.parent() {
            self.system.watch(parent, RecursiveMode::NonRecursive)?;
        }
        Ok(())
    }

    fn set_files(&mut self, files: &[PathBuf]) {
        let outside = |path: &PathBuf| !self.root.as_ref().is_some_and(|root| path.starts_with(root));
        // The directory is resolved and not the file: a link that is replaced must be seen.
        let resolve = |path: &PathBuf| Some(path.parent()?.canonicalize().ok()?.join(path.file_name()?));
        let absolute = files.iter().filter_map(|path| resolve(&std::path::absolute(path).ok()?));
        self.files = absolute.filter(outside).collect();
        let parents: BTreeSet<PathBuf> = self.files.iter().filter_map(|path| Some(path.parent()?.to_owned())).collect();
        let root_parent = self.root.as_ref().and_then(|root| Some(root.parent()?.to_owned()));
        for gone in self.watched.difference(&parents).filter(|path| Some(*path) != root_parent.as_ref()) {
            // It may have been deleted meanwhile.
            let _ = self.system.unwatch(gone);
        }
        for new in parents.difference(&self.watched).filter(|path| Some(*path) != root_parent.as_ref()) {
            if let Err(error) = self.system.watch(new, RecursiveMode::NonRecursive) {
                tracing::warn!("{}: not watched: {error}", new.display());
            }
        }
        self.watched = parents;
        let (root, files) = (&self.root, &self.files);
        self.known.retain(|path, _| root.as_ref().is_some_and(|root| path.starts_with(root)) || files.contains(path));
        for path in &self.files {
            if let Some(found) = fingerprint(path) {
                self.known.entry(path.clone()).or_insert(found);
            }
        }
    }

    /// How long to wait for more after these. A file that is gone and was never known is an editor's temporary one.
    fn settle(&self, pending: &BTreeSet<PathBuf>) -> Duration {
        let mut real = pending.iter().filter(|path| path.is_file() || self.known.contains_key(*path));
        let (one, two, more) = (real.next(), real.next(), real.next());
        let is_save = more.is_none() && [one, two].into_iter().flatten().all(|path| path.is_file());
        if is_save { SETTLE_SAVE } else { SETTLE }
    }

    /// Takes the present content as known.
    fn learn(&mut self) {
        let files = self.root.iter().flat_map(|root| walk(root)).chain(self.files.iter().cloned());
        let found: Vec<_> = files.filter_map(|path| Some((fingerprint(&path)?, path))).collect();
        self.known = found.into_iter().map(|(content, path)| (path, content)).collect();
    }

    /// The files that an event may have changed.
    fn candidates(&mut self, event: &Event) -> BTreeSet<PathBuf> {
        if event.need_rescan() {
            return self.everything();
        }
        let mut out = BTreeSet::new();
        if !matters(event.kind) {
            return out;
        }
        for path in &event.paths {
            if Some(path) == self.root.as_ref() {
                if matches!(event.kind, EventKind::Access(_)) {
                    continue;
                }
                self.rewatch_root();
                return self.everything();
            }
            let inside = self.root.as_ref().is_some_and(|root| path.starts_with(root));
            if !inside && !self.files.contains(path) {
                continue;
            }
            if path.is_dir() {
                // Files that were there before the new directory was watched sent no event.
                out.extend(walk(path));
            }
            // What lay under a directory that went away; the path itself is one of them when it was a file.
            let below = self.known.range(path.clone()..).take_while(|(known, _)| known.starts_with(path));
            out.extend(below.map(|(known, _)| known.clone()));
            // While a new file is empty its writer has it open, and its close comes as an event of its own.
            if !(is_creation(event.kind) && is_being_written(path)) {
                out.insert(path.clone());
            }
        }
        out
    }

    /// The root came or went: watches hang on the old directory, wherever it is now.
    fn rewatch_root(&mut self) {
        let Some(root) = self.root.clone() else { return };
        let _ = self.system.unwatch(&root);
        if root.is_dir()
            && let Err(error) = self.system.watch(&root, RecursiveMode::Recursive)
        {
            tracing::warn!("{}: not watched: {error}", root.display());
        }
    }

    fn everything(&self) -> BTreeSet<PathBuf> {
        let present = self.root.iter().flat_map(|root| walk(root));
        present.chain(self.known.keys().cloned()).chain(self.files.iter().cloned()).collect()
    }

    /// Those of `candidates` whose content differs from what was known; it is known then.
    fn changed(&mut self, candidates: BTreeSet<PathBuf>) -> BTreeSet<PathBuf> {
        let mut out = BTreeSet::new();
        for path in candidates {
            let found = fingerprint(&path);
            let before = match found {
                Some(found) => self.known.insert(path.clone(), found),
                None => self.known.remove(&path),
            };
            if before != found {
                out.insert(path);
            }
        }
        out
    }
}

/// All files below a directory. `.git` is left out: it changes with every command and holds no shader.
fn walk(directory: &Path) -> Vec<PathBuf> {
    directory::files(directory, |name| name != ".git")
}

/// Whether an event can mean finished content. Reading sends events too, and so does every piece of a long write.
fn matters(kind: EventKind) -> bool {
    match kind {
        EventKind::Access(AccessKind::Close(AccessMode::Write)) => true,
        EventKind::Access(_) => false,
        EventKind::Modify(ModifyKind::Name(_)) | EventKind::Remove(_) | EventKind::Create(_) => true,
        // Elsewhere no system tells of closing, so the settling time has to do.
        EventKind::Modify(_) | EventKind::Any => cfg!(not(target_os = "linux")),
        EventKind::Other => false,
    }
}

fn is_creation(kind: EventKind) -> bool {
    cfg!(target_os = "linux") && matches!(kind, EventKind::Create(_))
}

/// A plain new file; links, hard or symbolic, are complete from the start.
#[cfg(unix)]
fn is_being_written(path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    path.symlink_metadata().is_ok_and(|metadata| metadata.is_file() && metadata.nlink() == 1)
}

#[cfg(not(unix))]
fn is_being_written(_path: &Path) -> bool {
    false
}

// On real directories; see `watch_tests.rs`.
#[cfg(test)]
mod tests;
