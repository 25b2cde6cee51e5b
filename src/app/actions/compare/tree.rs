//! Compares with the picture of a second shader tree. A thread compiles it and bakes its light.

use std::path::Path;
use std::sync::Arc;

use super::switch::{REPLACED, compare, end};
use crate::app::engine::Engine;
use crate::app::engine::compared::{Compared, TreePicture};
use crate::app::engine::last_complete::{LastComplete, target};
use crate::app::state::State;
use crate::app::state::compare::{Opening, Tree, With};
use crate::message::print_error;
use crate::pipeline::PipelineSet;
use crate::shader::{Diagnostic, Severity, Source};
use crate::threads::second_tree::SecondTree;
use crate::threads::worker::Snapshot;
use crate::threads::{Message, SecondTreeMessage};

/// Compiles the tree at a path on a thread, once it is found to be one, and then compares with it.
pub(in crate::app) fn open_second_tree(state: &mut State, engine: &mut Engine, path: &Path) {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let number = state.compare.next_number();
    state.waiting.comparison_failed(REPLACED);
    state.compare.opening = Some(Opening::Tree(Tree { number, name, has_errors: false }));
    engine.opening_tree = None;
    let path = path.to_owned();
    engine.threads.wait(move || Some(Message::SecondTreeFound(number, Source::find(&path))));
}

/// Begins to compile the tree that was found, unless the user has gone on to something else.
pub(in crate::app) fn on_second_tree_found(
    state: &mut State,
    engine: &mut Engine,
    number: u64,
    found: Result<Source, String>,
) {
    if !matches!(&state.compare.opening, Some(Opening::Tree(tree)) if tree.number == number) {
        return;
    }
    let snapshot = snapshot(state, engine);
    let (layouts, compiler) = (engine.resources.layouts().clone(), engine.compiler.clone());
    let open = |source| SecondTree::open(&mut engine.threads, number, source, (&layouts, &compiler), snapshot);
    match found.and_then(open) {
        Ok(tree) => engine.opening_tree = Some(Box::new(TreePicture { tree, set: None, like: None, asked: None })),
        Err(message) => {
            state.compare.opening = None;
            state.waiting.comparison_failed(&message);
            state.say(message);
        }
    }
}

/// The current settings, model and targets.
pub(in crate::app) fn snapshot(state: &State, engine: &Engine) -> Snapshot {
    let settings = state.session.shared_settings();
    let target = target(&engine.gpu, &settings, !state.has_window);
    let suns = state.session.revisions.suns_of(&settings);
    Snapshot { scene: state.session.scene(), settings, target, suns }
}

/// The tree with this number, as the state and as the engine know it: the one that is compared with, or that is being compiled for
/// it.
fn tree<'a>(state: &'a mut State, engine: &'a mut Engine, number: u64) -> Option<(&'a mut Tree, &'a mut TreePicture)> {
    let is_opening = engine.opening_tree.as_ref().is_some_and(|opening| opening.tree.number == number);
    let (tree, picture) = match (is_opening, &mut engine.compared) {
        (true, _) => match &mut state.compare.opening {
            Some(Opening::Tree(tree)) => (tree, engine.opening_tree.as_mut()?),
            _ => return None,
        },
        (false, Compared::Tree(picture)) => match &mut state.compare.with {
            Some(With::Tree(tree)) => (tree, picture),
            _ => return None,
        },
        _ => return None,
    };
    (picture.tree.number == number).then_some((tree, &mut **picture))
}

/// Accepts what the thread of a second tree has done.
pub(in crate::app) fn on_second_tree(state: &mut State, engine: &mut Engine, number: u64, message: SecondTreeMessage) {
    match message {
        SecondTreeMessage::Compiled(set, diagnostics) => on_compiled(state, engine, number, set, &diagnostics),
        SecondTreeMessage::Provided(provided) => {
            let Some((tree, picture)) = tree(state, engine, number) else { return };
            match (provided, &picture.asked) {
                (Ok(frame), Some(asked)) if Arc::ptr_eq(&frame.state, &asked.state) => {
                    picture.like = Some(LastComplete { settings: asked.snapshot.settings.clone(), frame: *frame });
                }
                // The frame that was requested since then follows.
                (Ok(_), _) => {}
                (Err(message), _) => {
                    let message = format!("{}: {message}", tree.name);
                    state.waiting.comparison_failed(&message);
                    state.say(message);
                }
            }
        }
    }
}

fn on_compiled(
    state: &mut State,
    engine: &mut Engine,
    number: u64,
    set: Option<Arc<PipelineSet>>,
    diagnostics: &[Diagnostic],
) {
    let Some((tree, picture)) = tree(state, engine, number) else { return };
    let errors = || diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    tree.has_errors = errors().next().is_some();
    let is_new = set.is_some() && picture.set.is_none();
    if let Some(set) = set {
        (picture.set, picture.asked) = (Some(set), None);
    }
    let first = errors().next().map(|first| {
        let more = match errors().count() {
            1 => String::new(),
            count => format!(" (and {} more)", count - 1),
        };
        let waits = if picture.set.is_none() { ". The comparison begins once it compiles" } else { "" };
        format!("{} has errors: {}{more}{waits}", tree.name, first.one_line())
    });
    if is_new && let Some((Opening::Tree(tree), picture)) = state.compare.opening.take().zip(engine.opening_tree.take())
    {
        compare(state, engine, Some((With::Tree(tree), Compared::Tree(picture))));
    }
    if let Some(message) = first {
        for diagnostic in diagnostics {
            print_error(diagnostic.full());
        }
        state.waiting.comparison_failed(&message);
        state.say(message);
    }
}

/// Ends the comparison with a second tree whose thread has panicked.
pub(in crate::app) fn second_tree_failed(state: &mut State, engine: &mut Engine, number: u64) {
    if tree(state, engine, number).is_some() {
        state.waiting.comparison_failed("the thread of the second shader tree failed");
        end(state, engine);
    }
}
