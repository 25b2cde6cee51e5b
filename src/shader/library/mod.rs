//! The shader tree as a transaction: takes changed paths, and returns either a complete new set or diagnostics. In the
//! second case the old set remains.
//!
//! The library keeps the include graph, including the paths where an include was not found, so creating such a file
//! later is an edit too. It compiles the dirty stages from one snapshot of the tree, reflects them, checks them against
//! the contract and reads the annotations.
//!
//! **What is on screen comes first** (`update_first`, `finish`). The picture, the debug modes and path tracing are
//! stages of their own. If an edit reaches stages that are on screen, only these are compiled, and the set appears with
//! the others `pending`: no frame can show them. They follow once the frame is on screen, in a set of the same
//! generation. An error in them is reported as any other, and disables their modes until it is repaired, but not the
//! picture. In a window, stages that bake light follow too; until then the picture shows the previous light. Anything
//! unusual, such as an annotation of a constant that only pending stages have, compiles the whole tree at once.

mod beside;
pub mod check;
mod emptied;
mod gone;
mod link;
mod missing;
mod passes;
mod slot;
mod state;
mod update;
mod watch;
mod watched;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use crate::shader::annotation::texture::is_image_extension;
use crate::shader::compile::Compiler;
use crate::shader::contract;
use crate::shader::diagnostic::{Diagnostic, unique};
use crate::shader::expression;
use crate::shader::glsl::is_same_code;
use crate::shader::incremental::FileCache;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{Source, TreePath};
use beside::fragment_of;
use link::Linked;
use slot::{Done, StageSlot, Start, build};
use watched::View;

pub use slot::Stage;
pub use state::Library;
pub use update::{Change, Report, ShaderSet, Update};

impl Library {
    /// A library with the entry points `stages`, and every other stage of the tree that declares a pass.
    pub fn new(source: Source, compiler: Arc<Compiler>, stages: &[&str]) -> Self {
        let slots: Vec<StageSlot> = stages.iter().map(|path| StageSlot::new(TreePath::from(*path))).collect();
        let (cache, source, idle) = (FileCache::default(), Arc::new(source), BTreeSet::new());
        let (fixed, beside) = (slots.len(), BTreeSet::new());
        let (set, failed, relink, watched, is_part, is_whole) = (None, false, false, None, false, false);
        Self {
            source,
            compiler,
            cache,
            slots,
            fixed,
            idle,
            beside,
            set,
            tree: 0,
            before: 0,
            failed,
            relink,
            watched,
            is_part,
            is_whole,
        }
    }

    /// Gives the tree its number ([`ShaderSet::tree`]) and goes on with the generations of the library that this one follows.
    pub fn follow(&mut self, before: &Self, tree: usize) {
        (self.before, self.tree) = (before.generation(), tree);
    }

    /// Number of the tree: [`ShaderSet::tree`].
    pub fn tree(&self) -> usize {
        self.tree
    }

    /// The newest generation; 0 before the first.
    fn generation(&self) -> u64 {
        self.set.as_ref().map_or(self.before, |set| set.generation)
    }

    /// A library whose source holds a part of a tree: the constants that `when=` names may be in other files.
    pub fn of_part(source: Source, compiler: Arc<Compiler>, stages: &[&str]) -> Self {
        Self { is_part: true, ..Self::new(source, compiler, stages) }
    }

    /// Selects whether edits compile whole stages instead of edited functions, for `specula bench reload --edits`.
    pub fn compile_whole(&mut self, is_whole: bool) {
        self.is_whole = is_whole;
    }

    /// The tree.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Reads the tree from another source. Its next update must name the files whose texts this changes.
    pub fn set_source(&mut self, source: Source) {
        self.source = Arc::new(source);
        self.relink = true;
    }

    /// The compiler.
    pub fn compiler(&self) -> &Arc<Compiler> {
        &self.compiler
    }

    /// The last good set.
    pub fn set(&self) -> Option<&Arc<ShaderSet>> {
        self.set.as_ref()
    }

    /// The entry points.
    pub fn stages(&self) -> impl Iterator<Item = &TreePath> {
        self.slots.iter().map(|slot| &slot.path)
    }

    /// The first error of one of these stages.
    pub fn error_of(&self, stages: &BTreeSet<String>) -> Option<&Diagnostic> {
        let slots = self.slots.iter().filter(|slot| stages.contains(slot.path.as_str()));
        slots.filter_map(|slot| slot.current.as_ref()?.as_ref().err()).find_map(|broken| broken.diagnostics.first())
    }

    /// Every path whose change can affect the result, including paths where an include was not found.
    pub fn dependencies(&self) -> BTreeSet<TreePath> {
        let mut out = BTreeSet::from([TreePath::from(contract::INTERFACE_FILE)]);
        out.extend(self.slots.iter().flat_map(StageSlot::dependencies).cloned());
        out.retain(|path| !expression::is_virtual(path));
        out
    }

    /// The paths of a watcher that was given the root and the files of the source, as a change of this tree.
    pub fn change_of<'p>(&self, paths: impl IntoIterator<Item = &'p PathBuf>) -> Change {
        Change::Paths(paths.into_iter().flat_map(|path| self.source.changed(path)).collect())
    }

    /// Updates the library from the files, all or nothing: on any error the last good set remains.
    pub fn update(&mut self, change: &Change) -> Update {
        self.update_first(change, |_| false)
    }

    /// [`Library::update`] in two steps. If the change reaches stages for which `is_first` returns true, only these are
    /// compiled, and if they are good, the new set appears at once. Its other stages are [`ShaderSet::pending`] until
    /// [`Library::finish`] compiles them.
    pub fn update_first(&mut self, change: &Change, is_first: impl Fn(&TreePath) -> bool) -> Update {
        // The stages of a pass come together.
        let is_first = |path: &TreePath| is_first(path) || is_first(&fragment_of(path));
        let start = Instant::now();
        let source = Arc::clone(&self.source);
        let snapshot = Snapshot::new(&source);
        self.find_passes(change, &snapshot);
        let view = self.view(snapshot);
        let snapshot = &view.snapshot;
        let mut report = Report { changed: self.changed(change), ..Report::default() };

        let stale = self.stale(change, &view);
        if !stale.moved && self.slots.iter().all(|slot| slot.current.is_some()) && stale.compile.is_empty() {
            return Update::Unchanged { cleared: false };
        }
        let (first, rest): (Vec<_>, Vec<_>) = stale.compile.into_iter().partition(|(_, path)| is_first(path));
        let is_whole = matches!(change, Change::All);
        self.compile(&first, &view, is_whole, &mut report, || false);
        let is_complete = rest.is_empty() && self.slots.iter().all(StageSlot::is_good);
        if !is_complete && first.iter().any(|(index, _)| self.slots[*index].is_new()) {
            for (index, _) in &rest {
                self.slots[*index].current = None;
            }
            // An error may come from a stage that is not compiled yet, so only a complete update reports it.
            let firsts_are_good = self.slots.iter().all(|slot| !is_first(&slot.path) || slot.is_good());
            if let Some(Ok(linked)) = firsts_are_good.then(|| self.link(snapshot, true)) {
                report.compile_ms = start.elapsed().as_secs_f64() * 1e3;
                return self.commit(linked, self.next_generation(), snapshot, report);
            }
        }
        self.compile(&rest, &view, is_whole, &mut report, || false);
        let linked = self.link(snapshot, false);
        report.compile_ms = start.elapsed().as_secs_f64() * 1e3;
        self.conclude(linked, self.next_generation(), snapshot, report)
    }

    /// The first update, in two steps: [`Library::finish`] compiles the stages of debug modes, and unless `with_all_passes`
    /// the passes that are off.
    pub fn first_picture(&mut self, with_all_passes: bool) -> Update {
        let source = Arc::clone(&self.source);
        let snapshot = Snapshot::new(&source);
        self.find_passes(&Change::All, &snapshot);
        let mut later = self.replacing(&snapshot);
        later.extend([expression::STAGE, expression::VERTEX].map(TreePath::from));
        if !with_all_passes {
            later.extend(self.passes_off(&snapshot));
        }
        self.update_first(&Change::All, |path| !later.contains(path))
    }

    /// Compiles the stages that [`Library::update_first`] has left. The new set has the same generation. On an error
    /// the set stays, without the stages that are still pending. Ends early if `superseded` returns that a newer edit
    /// waits, or if the files have changed since.
    pub fn finish(&mut self, superseded: impl Fn() -> bool + Sync) -> Update {
        let pending = self.set.as_ref().filter(|set| !set.pending.is_empty());
        let Some(generation) = pending.map(|set| set.generation) else { return Update::Unchanged { cleared: false } };
        let start = Instant::now();
        let source = Arc::clone(&self.source);
        let view = self.view(Snapshot::new(&source));
        let snapshot = &view.snapshot;
        if self.slots.iter().any(|slot| !slot.is_current(view.of(&slot.path))) {
            return Update::Unchanged { cleared: false };
        }
        let rest = self.slots.iter().map(|slot| slot.path.clone()).enumerate();
        let rest: Vec<_> = rest.filter(|(index, _)| self.slots[*index].current.is_none()).collect();
        let mut report = Report::default();
        self.compile(&rest, &view, false, &mut report, superseded);
        if self.slots.iter().any(|slot| slot.current.is_none()) {
            return Update::Unchanged { cleared: false };
        }
        let linked = self.link(snapshot, false);
        report.compile_ms = start.elapsed().as_secs_f64() * 1e3;
        self.conclude(linked, generation, snapshot, report)
    }

    fn next_generation(&self) -> u64 {
        self.generation() + 1
    }

    /// Compiles stages in parallel. If `is_whole`, no stage reuses its last module. Once `superseded` returns true, no
    /// further stage begins.
    fn compile(
        &mut self,
        stages: &[(usize, TreePath)],
        view: &View<'_>,
        is_whole: bool,
        report: &mut Report,
        superseded: impl Fn() -> bool + Sync,
    ) {
        let (compiler, cache) = (&self.compiler, &self.cache);
        let start_of = |(index, _): &(usize, TreePath)| self.slots[*index].start(is_whole || self.is_whole);
        let starts: Vec<Start<'_>> = stages.iter().map(start_of).collect();
        let compiled: Vec<(usize, Done)> = stages
            .par_iter()
            .zip(starts)
            .filter(|_| !superseded())
            .map(|((index, path), start)| {
                let build = || view.explained(path, build(compiler, view.of(path), cache, path, start));
                (*index, view.refused(path).unwrap_or_else(build))
            })
            .collect();
        for (index, Done { outcome, ms }) in compiled {
            let slot = &mut self.slots[index];
            report.stages.extend(ms.map(|ms| (slot.path.to_string(), ms)));
            report.failed.extend(outcome.is_err().then(|| slot.path.to_string()));
            slot.accept(outcome, is_whole);
        }
    }

    fn changed(&self, change: &Change) -> Vec<String> {
        let Change::Paths(paths) = change else { return Vec::new() };
        let known = self.dependencies();
        let shown = paths.iter().filter(|path| known.contains(path)).map(|path| self.source.display_path(path));
        shown.filter(|path| is_of_author(path)).collect()
    }

    /// Restores results that are already known for the current text, and lists the stages to compile.
    fn stale(&mut self, change: &Change, view: &View<'_>) -> Stale {
        let paths = match change {
            Change::All => {
                let compile = self.slots.iter().map(|slot| slot.path.clone()).enumerate().collect();
                return Stale { moved: true, compile };
            }
            Change::Paths(paths) => paths,
        };
        // The version counts even if no stage includes the file.
        let moved = std::mem::take(&mut self.relink) || paths.contains(&TreePath::from(contract::INTERFACE_FILE));
        let is_image = |path: &TreePath| path.extension().is_some_and(is_image_extension);
        let mut stale = Stale { moved: moved || paths.iter().any(is_image), compile: Vec::new() };
        for (index, slot) in self.slots.iter_mut().enumerate() {
            // The texts of an expression follow those of its pass, which they do not include.
            let hit =
                expression::is_watched(&slot.path) || slot.dependencies().any(|dependency| paths.contains(dependency));
            // Always check a failed stage again: its dependencies are known only up to the error.
            if matches!(slot.current, Some(Ok(_))) && !hit {
                continue;
            }
            match slot.recall(view.of(&slot.path)) {
                Some(moved) => stale.moved |= moved,
                None => stale.compile.push((index, slot.path.clone())),
            }
        }
        stale
    }

    fn conclude(
        &mut self,
        linked: Result<Linked, Vec<Diagnostic>>,
        generation: u64,
        snapshot: &Snapshot<'_>,
        mut report: Report,
    ) -> Update {
        match linked {
            Ok(linked) => self.commit(linked, generation, snapshot, report),
            Err(diagnostics) => {
                self.failed = true;
                let explained = diagnostics.into_iter().map(|diagnostic| self.source.explained(diagnostic));
                let diagnostics = unique(explained.chain(self.source.refusals()).collect());
                let mut diagnostics = match self.source.root().filter(|root| !root.is_dir()) {
                    Some(root) => vec![gone(root)],
                    None => {
                        self.with_gone(self.with_renamed(self.with_emptied(diagnostics, snapshot), snapshot), snapshot)
                    }
                };
                let waiting = self.waiting(&diagnostics, snapshot);
                if let Some(first) = diagnostics.first_mut().filter(|_| !waiting.is_empty()) {
                    first.notes.push(format!("other edits wait until this is repaired: {}", waiting.join(", ")));
                }
                report.waiting = waiting;
                Update::Failed(diagnostics, report)
            }
        }
    }

    /// The files, as displayed, whose code differs from the last good one and that no diagnostic is about.
    fn waiting(&self, diagnostics: &[Diagnostic], snapshot: &Snapshot<'_>) -> Vec<String> {
        let texts = self.set.iter().flat_map(|set| &set.texts);
        let edited = texts.filter(|(path, text)| snapshot.read(path).is_ok_and(|now| !is_same_code(&now, text)));
        let shown = edited.map(|(path, _)| self.source.display_path(path));
        shown
            .filter(|path| is_of_author(path) && diagnostics.iter().all(|diagnostic| diagnostic.file != *path))
            .collect()
    }
}

/// The error about a tree whose folder is gone, in place of one for each of its stages.
fn gone(root: &Path) -> Diagnostic {
    let error = Diagnostic::error(root.display().to_string(), "the folder of the shaders is gone");
    error.with_help("the picture comes from its last version; move it back, or open another tree")
}

/// Whether a file, as displayed, is one on disk: the stages of a single opened file are written by Specula.
fn is_of_author(shown: &str) -> bool {
    !shown.starts_with("embedded:")
}

struct Stale {
    /// Whether to link again without compiling, for example after an edit was reverted.
    moved: bool,
    compile: Vec<(usize, TreePath)>,
}

// These tests run the compiler.
#[cfg(test)]
mod tests;
