//! The system's change notifications, and where there are none.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

use notify::event::{AccessKind, AccessMode, EventKind, ModifyKind};
use notify::{Event, RecommendedWatcher, RecursiveMode, Watcher as _};

use super::mounts::Mounts;

/// Polling interval without notifications.
pub(super) const POLL: Duration = Duration::from_millis(500);

/// Watches single directories. Directories are named without symbolic links, because events have the name that a directory
/// was first watched under.
pub struct Notifier {
    /// `Err` says why there are no notifications at all.
    system: Result<RecommendedWatcher, String>,
    watched: BTreeSet<PathBuf>,
    /// Directories watched since [`Self::begin`]. What happened in them before sent no event.
    fresh: BTreeSet<PathBuf>,
    /// Directories whose changes are not all notified: whether they hold content, and the reason.
    polled: BTreeMap<PathBuf, (bool, String)>,
    mounts: Option<Mounts>,
    has_told: bool,
}

impl Notifier {
    /// `send` receives events on a thread of the system's watcher. `Err` in place of `send` is a reason to poll instead.
    pub fn new(send: Result<impl FnMut(notify::Result<Event>) + Send + 'static, String>) -> Self {
        let system = send.and_then(|mut send| {
            let filtered = move |event: notify::Result<Event>| {
                // The directories above a tree have events of many other files, and every read of a file is an event.
                if event.as_ref().map_or(true, |event| event.need_rescan() || matters(event.kind)) {
                    send(event);
                }
            };
            notify::recommended_watcher(filtered).map_err(|error| reason(&error))
        });
        let (watched, fresh, polled) = (BTreeSet::new(), BTreeSet::new(), BTreeMap::new());
        Self { system, watched, fresh, polled, mounts: None, has_told: false }
    }

    /// Begins a new plan.
    pub fn begin(&mut self) {
        self.fresh.clear();
        self.polled.clear();
        self.mounts = None;
    }

    /// Watches a directory of the plan. `has_content` is false for a directory that paths only lead through.
    pub fn watch(&mut self, directory: &Path, has_content: bool) {
        let Ok(system) = &mut self.system else { return };
        let kind = if has_content { self.mounts.get_or_insert_with(Mounts::read).shared(directory) } else { None };
        if let Some(kind) = kind {
            let why = format!("other machines may write to this {kind} mount");
            self.polled.insert(directory.to_owned(), (true, why));
        }
        if self.watched.contains(directory) {
            return;
        }
        match system.watch(directory, RecursiveMode::NonRecursive) {
            Ok(()) => {
                self.watched.insert(directory.to_owned());
                self.fresh.insert(directory.to_owned());
            }
            Err(error) => {
                let is = |kind| matches!(&error.kind, notify::ErrorKind::Io(error) if error.kind() == kind);
                // The directory is gone again, which is an event of its parent.
                let is_gone = matches!(error.kind, notify::ErrorKind::PathNotFound) || is(std::io::ErrorKind::NotFound);
                // Directories above the user's own often cannot be read, and they rarely change.
                let is_foreign = !has_content && is(std::io::ErrorKind::PermissionDenied);
                if !is_gone && !is_foreign {
                    let polled = self.polled.entry(directory.to_owned()).or_insert((false, reason(&error)));
                    polled.0 |= has_content;
                }
            }
        }
    }

    /// Ends a plan: stops watching the directories that it does not contain.
    pub fn end(&mut self, is_planned: impl Fn(&Path) -> bool) {
        let gone: Vec<PathBuf> = self.watched.iter().filter(|directory| !is_planned(directory)).cloned().collect();
        for directory in gone {
            self.forget(&directory);
        }
    }

    /// Drops the watches of `path` and everything below it, which belong to directories that may have moved. Returns whether
    /// there were any.
    pub fn forget_below(&mut self, path: &Path) -> bool {
        let below: Vec<PathBuf> =
            self.watched.range(path.to_owned()..).take_while(|watched| watched.starts_with(path)).cloned().collect();
        for directory in &below {
            self.forget(directory);
        }
        !below.is_empty()
    }

    fn forget(&mut self, directory: &Path) {
        self.watched.remove(directory);
        if let Ok(system) = &mut self.system {
            // The system drops the watch of a deleted directory by itself.
            let _ = system.unwatch(directory);
        }
    }

    /// Whether a directory was watched for the first time by this plan.
    pub fn is_fresh(&self, directory: &Path) -> bool {
        self.fresh.contains(directory)
    }

    /// Whether some changes are found only by polling.
    pub fn must_poll(&self) -> bool {
        self.system.is_err() || !self.polled.is_empty()
    }

    /// Reports once why polling is needed. `main` is the directory that the user knows.
    pub fn tell(&mut self, main: Option<&Path>) {
        // The outermost directory with content represents all.
        let polled = self.polled.iter().find(|(_, (has_content, _))| *has_content).or(self.polled.iter().next());
        let (directory, why) = match (&self.system, polled) {
            (Err(why), _) => (main, why),
            (Ok(_), Some((directory, (_, why)))) => (Some(directory.as_path()), why),
            (Ok(_), None) => return,
        };
        if let Some(directory) = directory.filter(|_| !self.has_told) {
            let (directory, every) = (directory.display(), POLL.as_millis());
            crate::message::tell(format_args!(
                "no change notifications for {directory} ({why}); looking every {every} ms instead"
            ));
            self.has_told = true;
        }
    }
}

/// The system's message, and the limit to raise.
fn reason(error: &notify::Error) -> String {
    const TOO_MANY_FILES: i32 = 24;
    match &error.kind {
        notify::ErrorKind::MaxFilesWatch => "all watches are in use: raise fs.inotify.max_user_watches".to_owned(),
        notify::ErrorKind::Io(io) if cfg!(target_os = "linux") && io.raw_os_error() == Some(TOO_MANY_FILES) => {
            format!("{io}: raise fs.inotify.max_user_instances")
        }
        notify::ErrorKind::Io(io) => io.to_string(),
        _ => error.to_string(),
    }
}

/// Whether an event can mean finished content. Every read sends events, too, and so does every piece of a long write.
fn matters(kind: EventKind) -> bool {
    match kind {
        EventKind::Access(AccessKind::Close(AccessMode::Write)) => true,
        EventKind::Access(_) => false,
        EventKind::Modify(ModifyKind::Name(_)) | EventKind::Remove(_) | EventKind::Create(_) => true,
        // Only Linux reports that a file was closed. Elsewhere the settling time must suffice.
        EventKind::Modify(_) | EventKind::Any => cfg!(not(target_os = "linux")),
        EventKind::Other => false,
    }
}
