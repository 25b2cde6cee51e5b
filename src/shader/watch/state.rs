//! The watcher's state: turns the system's events into the files whose content differs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use notify::Event;
use notify::event::{AccessKind, EventKind, ModifyKind};

use super::fingerprint::{Fingerprint, fingerprint};
use super::notifier::Notifier;
use super::plan::{Plan, is_watched};

/// The files and folders that events have touched. Files have the names that the watcher was given.
#[derive(Debug, Default)]
pub struct Touched {
    /// Files that may have changed.
    pub files: BTreeSet<PathBuf>,
    /// Whether directories or links came, went or moved, so that other directories may have to be watched.
    pub directories: bool,
}

/// The watched tree and files, and their known content.
pub struct WatchState {
    /// As given.
    root: Option<PathBuf>,
    /// As given.
    files: BTreeSet<PathBuf>,
    notifier: Notifier,
    plan: Plan,
    /// The content of every file that exists.
    known: BTreeMap<PathBuf, Fingerprint>,
}

impl WatchState {
    /// Watches `root` and `files`, and records their present content.
    pub fn new(root: Option<PathBuf>, files: &[PathBuf], notifier: Notifier) -> Self {
        let files = files.iter().cloned().collect();
        let mut state = Self { root, files, notifier, plan: Plan::default(), known: BTreeMap::new() };
        state.replan();
        let found = state.plan.files.keys().filter_map(|path| Some((path.clone(), fingerprint(path)?)));
        state.known = found.collect();
        state
    }

    /// Replaces the single files. The present content of the new ones is recorded.
    pub fn set_files(&mut self, files: &[PathBuf]) {
        self.files = files.iter().cloned().collect();
        self.replan();
        let mut known = std::mem::take(&mut self.known);
        known.retain(|path, _| self.is_watched(path));
        for path in &self.files {
            if let Some(found) = fingerprint(path) {
                known.entry(path.clone()).or_insert(found);
            }
        }
        self.known = known;
    }

    fn is_watched(&self, path: &Path) -> bool {
        self.files.contains(path) || self.root.as_ref().is_some_and(|root| path.starts_with(root))
    }

    /// Adds what an event may have changed to `touched`.
    pub fn note(&mut self, event: &Event, touched: &mut Touched) {
        if event.need_rescan() {
            // Events were lost. Watch every directory from scratch, so that each counts as changed.
            self.notifier.forget_below(Path::new(""));
            touched.directories = true;
            touched.files.extend(self.known.keys().cloned());
        }
        for path in &event.paths {
            let moved = matches!(event.kind, EventKind::Modify(ModifyKind::Name(_)) | EventKind::Remove(_));
            if moved && self.notifier.forget_below(path) {
                touched.directories = true;
            }
            self.note_entry(path, event.kind, touched);
        }
    }

    /// `path` is an entry of a watched directory.
    fn note_entry(&self, path: &Path, kind: EventKind, touched: &mut Touched) {
        let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return };
        let Some(place) = self.plan.places.get(folder) else { return };
        let in_tree = !place.tree_names.is_empty() && is_watched(&name.to_string_lossy());
        let ends = place.entries.get(name);
        if !in_tree && ends.is_none() {
            return;
        }
        if !matches!(kind, EventKind::Access(AccessKind::Close(_))) {
            let was_way = ends.is_some_and(|paths| paths.values().any(|ends| !ends));
            let was_directory = self.plan.places.contains_key(path);
            let is_way = path.symlink_metadata().is_ok_and(|now| now.is_dir() || now.is_symlink());
            touched.directories |= was_way || was_directory || is_way;
        }
        // A new, empty file is still open in its writer, and closing it is another event.
        if is_creation(kind) && is_being_written(path) {
            return;
        }
        if in_tree {
            touched.files.extend(place.tree_names.iter().map(|folder| folder.join(name)));
        }
        touched.files.extend(ends.iter().flat_map(|paths| paths.keys()).filter(|path| self.is_file(path)).cloned());
    }

    /// Whether a path that the plan follows stands for a file: paths lead to the root, too.
    fn is_file(&self, path: &Path) -> bool {
        self.root.as_deref() != Some(path) || self.files.contains(path)
    }

    /// Updates which directories are watched. Returns the files to check: they appeared, disappeared or moved, or may have
    /// changed before their directory was watched.
    pub fn replan(&mut self) -> BTreeSet<PathBuf> {
        let notifier = &mut self.notifier;
        notifier.begin();
        let plan = Plan::new(self.root.as_deref(), &self.files, &mut |path, content| notifier.watch(path, content));
        notifier.end(|directory| plan.places.contains_key(directory));
        let first = self.files.first().and_then(|file| file.parent());
        notifier.tell(self.root.as_deref().or(first));

        let old = std::mem::replace(&mut self.plan, plan);
        let gone = self.known.keys().filter(|path| !self.plan.files.contains_key(*path));
        let differs = |(path, real): &(&PathBuf, &PathBuf)| {
            let is_fresh = real.parent().is_some_and(|folder| self.notifier.is_fresh(folder));
            match old.files.get(*path) {
                Some(before) => is_fresh || before != *real,
                // The creation of a file in a directory that is already watched is an event of its own.
                None => is_fresh || !old.has_directory_of(path, real),
            }
        };
        let found = self.plan.files.iter().filter(differs).map(|(path, _)| path);
        gone.chain(found).cloned().collect()
    }

    /// Whether some changes are found only by polling.
    pub fn must_poll(&self) -> bool {
        self.notifier.must_poll()
    }

    /// Checks every file; returns those whose content differs from the recorded one, with their content.
    pub fn look(&mut self) -> BTreeMap<PathBuf, Option<Fingerprint>> {
        self.replan();
        let all = self.plan.files.keys().chain(self.known.keys());
        let found = all.map(|path| (path.clone(), fingerprint(path)));
        found.filter(|(path, found)| self.known.get(path) != found.as_ref()).collect()
    }

    /// Whether these files are one save: all exist. A missing file that was never recorded is an editor's temporary one.
    pub fn is_save(&self, files: &BTreeSet<PathBuf>) -> bool {
        let mut real = files.iter().filter(|path| path.is_file() || self.known.contains_key(*path));
        let (one, two, more) = (real.next(), real.next(), real.next());
        more.is_none() && [one, two].into_iter().flatten().all(|path| path.is_file())
    }

    /// Those of `files` whose content differs from the recorded one, which is then updated.
    pub fn changed(&mut self, files: BTreeSet<PathBuf>) -> BTreeSet<PathBuf> {
        let mut out = BTreeSet::new();
        // The caller may have replaced the files since the event.
        for path in files.into_iter().filter(|path| self.is_watched(path)).collect::<Vec<_>>() {
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

fn is_creation(kind: EventKind) -> bool {
    cfg!(target_os = "linux") && matches!(kind, EventKind::Create(_))
}

/// A plain new file. Links, hard or symbolic, are complete from the start.
#[cfg(unix)]
fn is_being_written(path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    path.symlink_metadata().is_ok_and(|metadata| metadata.is_file() && metadata.nlink() == 1)
}

#[cfg(not(unix))]
fn is_being_written(_path: &Path) -> bool {
    false
}
