//! Compiles a tree with the editor's texts on a thread of its own. The newest texts win: those that came while others were compiled are
//! compiled next, and the stages that are left of the older ones are not.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crossbeam_channel::{Receiver, Sender, unbounded};

use super::diagnostics::{ByFile, by_file};
use super::event::Event;
use crate::frame::stages::stages;
use crate::message::catch_panic;
use crate::shader::check::check_alone;
use crate::shader::{Change, Compiler, Diagnostic, Library, Source, TreePath, Update};

/// The stage that is compiled first.
const FIRST: &str = "pbr.frag";

/// Texts to compile.
#[derive(Debug)]
struct Job {
    /// The texts that the editor has open.
    texts: BTreeMap<TreePath, Arc<str>>,
    /// Paths whose text may have changed.
    changed: BTreeSet<TreePath>,
}

/// The thread that compiles a tree. It ends with this value.
#[derive(Debug)]
pub struct Compiling {
    jobs: Sender<Job>,
}

impl Compiling {
    /// Starts the thread. Diagnostics come as events.
    ///
    /// # Errors
    /// The system grants no thread.
    pub fn start(root: &Path, compiler: &Arc<Compiler>, events: Sender<Event>) -> std::io::Result<Self> {
        let (jobs, receiver) = unbounded();
        let (root, compiler) = (root.to_owned(), Arc::clone(compiler));
        let work = move || Thread { root, compiler, library: None, jobs: receiver, known: Vec::new() }.run(&events);
        // As deep as that of the first thread: glslang is recursive.
        std::thread::Builder::new().name("specula-lsp-compile".to_owned()).stack_size(16 << 20).spawn(work)?;
        Ok(Self { jobs })
    }

    /// Compiles these texts in place of all earlier ones.
    pub fn compile(&self, texts: BTreeMap<TreePath, Arc<str>>, changed: BTreeSet<TreePath>) {
        let _ = self.jobs.send(Job { texts, changed });
    }
}

struct Thread {
    root: PathBuf,
    compiler: Arc<Compiler>,
    library: Option<Library>,
    jobs: Receiver<Job>,
    /// The diagnostics of the last update.
    known: Vec<Diagnostic>,
}

impl Thread {
    fn run(mut self, events: &Sender<Event>) {
        let mut left = BTreeSet::new();
        while let Ok(first) = self.jobs.recv() {
            let job = self.jobs.try_iter().fold(first, |older, newer| Job {
                texts: newer.texts,
                changed: older.changed.into_iter().chain(newer.changed).collect(),
            });
            let changed: BTreeSet<TreePath> = job.changed.into_iter().chain(std::mem::take(&mut left)).collect();
            let open: Vec<TreePath> = job.texts.keys().cloned().collect();
            match catch_panic(|| self.update(job.texts, changed.clone())) {
                Ok(true) => {}
                // A newer text waits.
                Ok(false) => {
                    left = changed;
                    continue;
                }
                Err(panic) => {
                    tracing::error!("compiling {} failed: {panic}", self.root.display());
                    self.library = None;
                    continue;
                }
            }
            let alone = catch_panic(|| self.alone(&open)).unwrap_or_default();
            let mut files = by_file(self.known.iter().cloned().chain(alone).collect());
            files.values_mut().for_each(|of_file| of_file.dedup());
            if events.send(Event::Diagnosed(self.root.clone(), files)).is_err() {
                return;
            }
        }
    }

    /// Updates the library and the diagnostics. Returns false if it gave up for newer texts.
    fn update(&mut self, texts: BTreeMap<TreePath, Arc<str>>, changed: BTreeSet<TreePath>) -> bool {
        let source = Source::disk(&self.root).with_editor(texts);
        let (library, change) = match &mut self.library {
            Some(library) => {
                library.set_source(source);
                (library, Change::Paths(changed))
            }
            none => (none.insert(Library::new(source, Arc::clone(&self.compiler), &stages())), Change::All),
        };
        let is_newer = || !self.jobs.is_empty();
        let mut update = library.update_first(&change, |path| path.as_str() == FIRST);
        if let Update::Ready(set, _) = &update
            && !set.pending.is_empty()
        {
            update = library.finish(is_newer);
            match update {
                Update::Unchanged { .. } if is_newer() => return false,
                // A file has changed on disk meanwhile.
                Update::Unchanged { .. } => update = library.update(&Change::All),
                _ => {}
            }
        }
        match update {
            Update::Ready(set, _) => self.known.clone_from(&set.warnings),
            Update::Failed(diagnostics, _) => self.known = diagnostics,
            Update::Unchanged { cleared: true } => {
                self.known = library.set().map(|set| set.warnings.clone()).unwrap_or_default();
            }
            Update::Unchanged { cleared: false } => {}
        }
        true
    }

    /// The diagnostics of open files that no stage includes.
    fn alone(&self, open: &[TreePath]) -> Vec<Diagnostic> {
        let Some(library) = &self.library else { return Vec::new() };
        let reached = library.dependencies();
        let rest: Vec<TreePath> = open.iter().filter(|path| !reached.contains(path)).cloned().collect();
        check_alone(library, &rest)
    }
}

/// The files that had diagnostics before and have none now.
pub fn mended(before: &ByFile, now: &ByFile) -> Vec<PathBuf> {
    before.keys().filter(|path| !now.contains_key(*path)).cloned().collect()
}
