//! Compares with the picture of a second shader tree. A thread compiles it and bakes its light.

use std::path::Path;
use std::sync::Arc;

use super::REPLACED;
use crate::app::drawn::compare::tree::{LastAsked, TreePicture};
use crate::app::drawn::compare::{Opening, With};
use crate::app::drawn::last_complete::{LastComplete, target};
use crate::app::viewer::Viewer;
use crate::gpu::GpuError;
use crate::message::print_error;
use crate::pipeline::PipelineSet;
use crate::render::BoundFrame;
use crate::shader::{Diagnostic, Severity, Source};
use crate::threads::SecondTreeMessage;
use crate::threads::second_tree::{Needs, SecondTree};
use crate::threads::worker::Snapshot;

impl Viewer {
    /// Compiles a tree on a thread, and then compares with it.
    ///
    /// # Errors
    /// The path is no shader tree, or the tree cannot be watched.
    pub(in crate::app) fn open_second_tree(&mut self, path: &Path) -> Result<(), String> {
        let tree = self.second_tree(path)?;
        self.comparison_failed(REPLACED);
        self.compare.opening = Some(Opening::Tree(Box::new(tree)));
        Ok(())
    }

    fn second_tree(&mut self, path: &Path) -> Result<TreePicture, String> {
        let source = Source::find(path)?;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let (number, snapshot) = (self.compare.next_number(), self.snapshot());
        let (layouts, compiler) = (self.resources.layouts().clone(), self.compiler.clone());
        let tree = SecondTree::open(&mut self.threads, number, source, (&layouts, &compiler), snapshot)?;
        Ok(TreePicture { name, tree, set: None, has_errors: false, like: None, asked: None })
    }

    /// The current settings, model and targets.
    fn snapshot(&self) -> Snapshot {
        let settings = self.session.shared_settings();
        let target = target(&self.gpu, &settings);
        let suns = self.session.revisions.suns_of(&settings);
        Snapshot { scene: self.session.scene(), settings, target, suns }
    }

    /// Accepts what the thread of a second tree has done.
    pub(in crate::app::viewer) fn on_second_tree(&mut self, number: u64, message: SecondTreeMessage) {
        match message {
            SecondTreeMessage::Compiled(set, diagnostics) => self.on_second_tree_compiled(number, set, &diagnostics),
            SecondTreeMessage::Provided(provided) => {
                let Some(tree) = self.compare.tree(number) else { return };
                match (provided, &tree.asked) {
                    (Ok(frame), Some(asked)) if Arc::ptr_eq(&frame.state, &asked.state) => {
                        tree.like = Some(LastComplete { settings: asked.snapshot.settings.clone(), frame: *frame });
                    }
                    // The frame that was requested since then follows.
                    (Ok(_), _) => {}
                    (Err(message), _) => {
                        let message = format!("{}: {message}", tree.name);
                        self.comparison_failed(&message);
                        self.say(message);
                    }
                }
            }
        }
    }

    fn on_second_tree_compiled(&mut self, number: u64, set: Option<Arc<PipelineSet>>, diagnostics: &[Diagnostic]) {
        let Some(tree) = self.compare.tree(number) else { return };
        let errors = || diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
        tree.has_errors = errors().next().is_some();
        let is_new = set.is_some() && tree.set.is_none();
        if let Some(set) = set {
            (tree.set, tree.asked) = (Some(set), None);
        }
        let first = errors().next().map(|first| {
            let more = match errors().count() {
                1 => String::new(),
                count => format!(" (and {} more)", count - 1),
            };
            let waits = if tree.set.is_none() { ". The comparison begins once it compiles" } else { "" };
            format!("{} has errors: {}{more}{waits}", tree.name, first.one_line())
        });
        if is_new && let Some(Opening::Tree(tree)) = self.compare.opening.take() {
            self.compare.set(Some(With::Tree(tree)));
        }
        if let Some(message) = first {
            for diagnostic in diagnostics {
                print_error(diagnostic.full());
            }
            self.comparison_failed(&message);
            self.say(message);
        }
    }

    /// Ends the comparison with a second tree whose thread has panicked.
    pub(in crate::app::viewer) fn second_tree_failed(&mut self, number: u64) {
        if self.compare.tree(number).is_some() {
            self.comparison_failed("the thread of the second shader tree failed");
            self.compare.end();
        }
    }

    /// Renders the second tree with the current settings once its resources are ready.
    pub(super) fn picture_of_tree(&mut self, live: &BoundFrame) -> Result<Option<BoundFrame>, GpuError> {
        let Some(With::Tree(tree)) = &self.compare.with else { return Ok(None) };
        let Some(set) = tree.set.clone() else { return Ok(None) };
        let like = tree.like.as_ref().map(|like| like.frame.clone());
        let state = self.state_like(live, &set.shaders);
        let is_pending = state.pipelines.needs_pending(&set.shaders);
        if !is_pending && let Some(frame) = self.resources.bind_older(&set, &state, like.as_ref())? {
            return Ok(Some(frame));
        }
        // The main picture comes first, and its light is likely to be the second tree's as well.
        let snapshot = (self.is_complete && !is_pending).then(|| {
            let mut snapshot = self.snapshot();
            // The mouse may preview a mode.
            if let Some(mode) = live.state.mode() {
                Arc::make_mut(&mut snapshot.settings).mode.clone_from(&mode.slug);
            }
            snapshot
        });
        let Some(With::Tree(tree)) = &mut self.compare.with else { return Ok(None) };
        let is_asked = tree.asked.as_ref().is_some_and(|asked| asked.has_needs_of(&state));
        if let Some(snapshot) = snapshot.filter(|_| !is_asked) {
            let resources = self.resources.clone();
            tree.tree.provide(Needs { snapshot: snapshot.clone(), resources, set, state: state.clone() });
            tree.asked = Some(LastAsked { state, snapshot });
        }
        let Some(With::Tree(tree)) = &self.compare.with else { return Ok(None) };
        Ok(tree.like.as_ref().map(|like| self.interim(like, self.clock, live.state.size)))
    }

    /// Releases the picture of the second tree, which holds the model on the device.
    pub(in crate::app::viewer) fn forget_second_picture(&mut self) {
        if let Some(With::Tree(tree)) = &mut self.compare.with {
            (tree.like, tree.asked) = (None, None);
        }
    }
}
