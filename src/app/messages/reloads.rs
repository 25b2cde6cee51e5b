//! Takes reloads of the shaders, and their diagnostics.

use crate::app::actions::edits::follow_edits;
use crate::app::actions::exercises::check_again;
use crate::app::engine::Engine;
use crate::app::state::arrangement::Preset;
use crate::app::state::recent::Kind;
use crate::app::state::workspace::PanelRequest;
use crate::app::state::{EndlessLoop, FirstFrame, State};
use crate::events::{CompletedEvent, Event, ReloadEvent, emit};
use crate::message::{self, print_error};
use crate::pipeline::{Outcome, Reload, endless_loop};
use crate::settings::GROUND;
use crate::shader::{Diagnostic, Severity, ShaderSet, expression};
use std::sync::Arc;

/// Looks for the line of a loop that did not end, on another thread. The diagnostic comes as a message.
pub(in crate::app) fn on_endless_loop(state: &mut State, engine: &mut Engine, words: [u32; 2]) {
    let is_known = state.endless_loop.as_ref().is_some_and(|known| known.words == words);
    let Some(shaders) = state.session.shaders.clone().filter(|_| !is_known) else { return };
    state.endless_loop = Some(EndlessLoop { words, diagnostic: None });
    let (gpu, compiler, source) = (engine.gpu.clone(), engine.compiler.clone(), state.source.clone());
    engine.threads.explain(words, move || endless_loop(&gpu, words, &shaders, &compiler, &source));
}
/// Shows the panels for a single file, which has no model, or those of before for a tree.
pub(in crate::app) fn arrange_for(state: &mut State, is_single_file: bool) {
    if !is_single_file && !state.learning.holds(state.shader.location.as_deref()) {
        state.shader.last_tree.clone_from(&state.shader.location);
    }
    let was_single_file = std::mem::replace(&mut state.shader.is_single_file, is_single_file);
    match (was_single_file, is_single_file) {
        (false, true) => state.workspace.request(PanelRequest::ArrangeTemporarily(Preset::Toy)),
        (true, false) => state.workspace.request(PanelRequest::ArrangeAsBefore),
        _ => {}
    }
}

/// Remembers the shader tree on disk, if it compiles.
pub(in crate::app) fn remember_tree(state: &mut State, outcome: &Outcome) {
    if let (Outcome::Ready(_), Some(tree)) = (outcome, state.source.location()) {
        state.recent.remember(Kind::Tree, tree);
    }
}

/// Accepts the stages of a reload that the picture did not need.
pub(in crate::app) fn on_completed(state: &mut State, engine: &mut Engine, reload: &Reload) {
    let generation = state.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    state.shader.log.compiled(&reload.report, matches!(reload.outcome, Outcome::Ready(_)));
    state.stages.invalidate();
    match &reload.outcome {
        Outcome::Unchanged { .. } => return,
        Outcome::Failed(diagnostics) => {
            // The generation never settles, so the exercise is not measured.
            state.learning.checking = None;
            show_errors(state, diagnostics);
        }
        Outcome::Ready(set) => {
            state.set_diagnostics(set.shaders.warnings.clone());
            tell_expression(state, &set.shaders);
            state.session.shaders = Some(set.shaders.clone());
            engine.resources.set_pipelines(set);
            follow_edits(state, engine, &set.shaders);
            state.versions.complete(&set.shaders);
            engine.generations.complete(set);
            if !state.names_checked || state.session.mode().is_none() {
                check_names(state);
            }
            tell_repaired(state);
        }
    }
    let event = CompletedEvent::new(reload, generation);
    state.shader.log.completed(&event);
    emit(&state.events, &Event::Completed(event));
}

fn show_errors(state: &mut State, diagnostics: &[Diagnostic]) {
    state.shader.is_broken = true;
    for diagnostic in diagnostics {
        print_error(diagnostic.full());
        emit(&state.events, &Event::Diagnostic(diagnostic));
    }
    state.set_diagnostics(diagnostics.to_vec());
}

pub(in crate::app) fn on_reload(state: &mut State, engine: &mut Engine, reload: &Reload, detect_ms: f64) {
    let generation = state.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    let is_good = !matches!(reload.outcome, Outcome::Failed(_) | Outcome::Unchanged { cleared: false });
    state.shader.log.compiled(&reload.report, is_good);
    state.shader.told = None;
    state.stages.invalidate();
    match &reload.outcome {
        Outcome::Unchanged { .. } => state.traces.saved.edited_silently(),
        Outcome::Ready(_) => state.traces.saved.forget(),
        Outcome::Failed(_) => {}
    }
    match &reload.outcome {
        Outcome::Unchanged { cleared: false } => check_again(state, engine),
        Outcome::Unchanged { cleared: true } => {
            check_again(state, engine);
            state.endless_loop = None;
            state.session.diagnostics.clear();
            tell_repaired(state);
            report(state, ReloadEvent::new(reload, generation, detect_ms, 0.0));
        }
        Outcome::Failed(diagnostics) => {
            state.learning.checking = None;
            show_errors(state, diagnostics);
            report(state, ReloadEvent::new(reload, generation, detect_ms, 0.0));
        }
        Outcome::Ready(set) => {
            state.endless_loop = None;
            state.session.diagnostics.clone_from(&set.shaders.warnings);
            for warning in &state.session.diagnostics {
                print_error(warning.full());
                if warning.severity == Severity::Error {
                    emit(&state.events, &Event::Diagnostic(warning));
                }
            }
            // The worker drops requests for older sets, so those of a comparison are sent again.
            engine.threads.worker.built();
            state.shader.in_use = state.source.location().map(Into::into);
            let event = ReloadEvent::new(reload, set.shaders.generation, detect_ms, 0.0);
            state.first_frame = Some(FirstFrame { generation: set.shaders.generation, event });
            tell_expression(state, &set.shaders);
            if state.session.shaders.as_ref().is_some_and(|before| before.tree != set.shaders.tree) {
                state.playback.begin();
            }
            state.session.shaders = Some(set.shaders.clone());
            engine.resources.set_pipelines(set);
            follow_edits(state, engine, &set.shaders);
            check_names(state);
            if set.shaders.is_complete() {
                tell_repaired(state);
            }
        }
    }
}

/// Tells the terminal, which shows the errors still, that all shaders compile again.
fn tell_repaired(state: &mut State) {
    if !state.has_errors() && std::mem::take(&mut state.shader.is_broken) {
        message::tell("the shaders compile again");
    }
}

/// Tells why the watched expression cannot be shown, once for each reason.
fn tell_expression(state: &mut State, shaders: &ShaderSet) {
    let before = state.session.shaders.as_ref().and_then(|shaders| shaders.expression_error());
    let Some(error) = shaders.expression_error().filter(|error| before != Some(*error)) else { return };
    print_error(error.full());
    emit(&state.events, &Event::Diagnostic(error));
    state.waiting.fail(&error.one_line());
}

/// Shows the diagnostic of a loop that did not end, unless a newer picture has taken its place.
pub(in crate::app) fn show_endless_loop(state: &mut State, words: [u32; 2], diagnostic: Option<Diagnostic>) {
    let Some(endless) = state.endless_loop.as_mut().filter(|endless| endless.words == words) else { return };
    let Some(diagnostic) = diagnostic else { return };
    print_error(diagnostic.full());
    emit(&state.events, &Event::Diagnostic(&diagnostic));
    endless.diagnostic = Some(diagnostic);
    let others = std::mem::take(&mut state.session.diagnostics);
    state.set_diagnostics(others);
}

pub(in crate::app) fn report(state: &mut State, event: ReloadEvent) {
    emit(&state.events, &Event::Reload(event.clone()));
    state.shader.log.finished(&event);
    state.stages.invalidate();
    // No file has changed if only another expression is watched.
    let is_of_watch = |stage: &String| expression::is_watched(&stage.as_str().into());
    let is_watch = event.changed.is_empty() && !event.stages.is_empty() && event.stages.iter().all(is_of_watch);
    // Numbers that are dragged, and an older version in place of the newest, are no saves.
    if state.has_files() && state.edits.draft.as_ref().is_none() && state.edits.restored.is_none() {
        state.hint.saved(&event);
    }
    let changed = if is_watch { vec![expression::MODE.to_owned()] } else { event.changed.clone() };
    state.shader.last = Some(ReloadEvent { changed, ..event });
}

/// Reports settings and modes that the shaders lack. The settings stay, because the next edit may declare them.
/// Unknown names are reported once, when all stages have compiled: a stage that is pending may declare them.
pub(in crate::app) fn check_names(state: &mut State) {
    let is_complete = state.session.shaders.as_ref().is_some_and(|shaders| shaders.is_complete());
    // The window switches the ground on by itself, and a tree need not have one.
    let lacks = |shaders: &Arc<ShaderSet>| shaders.graph.pass(GROUND).is_none();
    if is_complete && !state.names_checked && state.session.shaders.as_ref().is_some_and(lacks) {
        state.session.settings.passes.remove(GROUND);
    }
    let mut problems = state.session.problems(is_complete && !state.names_checked);
    state.names_checked |= is_complete;
    let settings = &state.session.settings;
    let is_expression = settings.mode == expression::MODE && !settings.expression.at.is_empty();
    if is_complete && !is_expression && state.session.mode().is_none() {
        let mode = &state.session.settings.mode;
        problems
            .push(format!("there is no mode '{mode}', so the final picture is shown; `specula modes` lists all modes"));
    }
    if !problems.is_empty() {
        state.say(problems.join("\n"));
    }
}
