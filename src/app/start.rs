//! Starts the window's work: its stores as the last window left them, the threads, and the first load.

use std::path::Path;
use std::sync::Arc;

use super::actions::compare::compare_at_start;
use super::actions::files::begin_loading;
use super::actions::sessions::report_loss;
use super::actions::watch::watch_tree;
use super::engine::capture_view::CaptureView;
use super::engine::compared::Compared;
use super::engine::generations::Generations;
use super::engine::last_complete::target;
use super::engine::{Engine, ToolsState};
use super::options::{AppOptions, Early};
use super::state::State;
use super::state::adaptive::Previews;
use super::state::exercise::Learning;
use super::state::hint::Hint;
use super::state::last_session::{LastSession, LastSessions};
use super::state::model::ModelStatus;
use super::state::recent::Recent;
use super::state::text_writes::TextWrites;
use crate::gpu::{Gpu, GpuError, SetLayouts};
use crate::render::Resources;
use crate::threads::worker::{Snapshot, Worker};
use crate::threads::{MessageSender, Threads};

/// Starts the threads, and the first load. A session that does not have a window neither knows nor changes what windows remember.
///
/// # Errors
/// No memory on the device.
pub(super) fn start(
    gpu: &Arc<Gpu>,
    layouts: &Arc<SetLayouts>,
    options: AppOptions,
    early: Early,
    (sender, has_window): (&MessageSender, bool),
) -> Result<(State, Engine), GpuError> {
    let mut text_writes = TextWrites::default();
    text_writes.restore(options.texts);
    let (source, recorder) = (text_writes.over(options.source), options.recorder);
    let location = source.location().map(Path::to_owned);
    let mut state = State {
        has_window,
        text_writes,
        model: ModelStatus { path: options.model.clone(), scene: options.load_options.scene, ..Default::default() },
        events: early.events,
        start: options.start,
        recent: if has_window { Recent::restored() } else { Recent::default() },
        last_sessions: if has_window { LastSessions::restored(location.as_deref()) } else { LastSessions::default() },
        hint: if has_window { Hint::restored() } else { Hint::default() },
        learning: if has_window { Learning::restored() } else { Learning::default() },
        follows_lights: options.follows_lights,
        follows_environment: options.follows_environment,
        load_options: options.load_options,
        offers_session: options.plain.is_some(),
        plain: options.plain,
        device: format!("{} · Vulkan {}", gpu.info().name, gpu.info().api),
        tells_statistics: gpu.tells_statistics(),
        previews: Previews::new(gpu.info().kind == "cpu"),
        ..State::new(options.settings, source.clone())
    };
    if state.last_sessions.is_always() {
        state.traces.file = state.last_sessions.here.as_ref().and_then(LastSession::file);
    }
    let session = &state.session;
    let lights = &session.settings.lights;
    let resources = Resources::new(gpu, layouts, lights.ambient_color.map(|c| c * lights.ambient_strength))?;
    let snapshot = Snapshot {
        settings: session.shared_settings(),
        scene: None,
        target: target(gpu, &session.settings, !has_window),
        suns: session.revisions.suns_of(&session.settings),
    };
    let worker = Worker::start((gpu, layouts), &options.compiler, source.clone(), snapshot, &recorder, sender);
    let threads = Threads::start((gpu, layouts), &options.compiler, worker, early.watcher, sender);
    let mut engine = Engine {
        tools: ToolsState::default(),
        gpu: gpu.clone(),
        resources,
        compared: Compared::default(),
        opening_tree: None,
        threads,
        recorder,
        shown: None,
        generations: Generations::default(),
        compiler: options.compiler,
        capture_view: if has_window { CaptureView::default() } else { CaptureView::kept() },
    };
    watch_tree(&mut state, &mut engine, &source);
    if has_window {
        engine.find_exercise(&source);
    }
    engine.threads.loader.upload(early.reading);
    begin_loading(&mut state, options.model);
    report_loss(&mut state, &engine);
    compare_at_start(&mut state, &mut engine, options.compare);
    Ok((state, engine))
}
