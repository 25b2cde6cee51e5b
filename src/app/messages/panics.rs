//! Reports threads that have panicked.

use crate::app::actions::compare::file::on_picture_fits;
use crate::app::actions::compare::tree::second_tree_failed;
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::inspection::Shown;
use crate::threads::TaskKind;

/// Reports that a thread has panicked, and treats its work as failed.
pub(in crate::app) fn on_panic(state: &mut State, engine: &mut Engine, task: TaskKind, text: &str) {
    let thread = task.thread();
    match task {
        TaskKind::Worker => {
            engine.threads.worker.panicked();
            state.shader.compiling = false;
        }
        TaskKind::Loader(number) => state.model.loading &= !engine.threads.loader.is_newest(number),
        TaskKind::Baker(number) => {
            let failed = engine.threads.baker.ended(number);
            failed.into_iter().for_each(|key| engine.resources.set_environment(key, None));
        }
        TaskKind::Tables(key) => {
            if engine.threads.baker.has_tables(&key) {
                engine.resources.set_tables(key, None);
            }
        }
        TaskKind::MeasuredBrdf(key) => {
            if engine.threads.baker.has_read(&key) {
                engine.resources.set_measured(key, None);
            }
        }
        TaskKind::LoopDiagnosis(words) => {
            if state.endless_loop.as_ref().is_some_and(|endless| endless.words == words) {
                state.endless_loop = None;
            }
        }
        TaskKind::Checker => state.learning.checking = None,
        TaskKind::Measurer => {
            // The same question would panic again, so it stays asked until another one comes.
            let inspector = &mut state.inspection;
            if let Some(asked) = &inspector.asked {
                let now = Err("the measurement failed".to_owned());
                inspector.curves = Some(Shown { of: asked.material, now, before: None });
            }
        }
        TaskKind::Finder => state.inspection.fail_search(),
        TaskKind::PixelTracer => state.traces.fail("the trace failed"),
        TaskKind::GuestTracer => state.guests.fail("the trace failed"),
        TaskKind::OperationChecker => state.checks.fail("the checks failed"),
        TaskKind::Timekeeper => state.costs.fail("the measurement failed"),
        TaskKind::Capture(number) => state.captures.ended(number),
        TaskKind::ToolPipelines => {}
        TaskKind::SecondTree(number) => second_tree_failed(state, engine, number),
        TaskKind::ImageScaling(number) => {
            on_picture_fits(state, engine, number, Err("the picture could not be scaled".to_owned()));
        }
        TaskKind::Writer => {
            for number in state.text_writes.end_all() {
                state.waiting.text_written(number, Err("writing the file failed"));
            }
        }
        TaskKind::External => (state.choosing, state.compare.measuring) = (None, None),
        TaskKind::PathTracing(key) => {
            if engine.threads.baker.has_path_tracing(&key) {
                engine.resources.set_path_tracing(key, None);
            }
        }
    }
    state.keep_saying(format!("Specula's {thread} thread failed ({text}). Please report this; your files are safe"));
}
