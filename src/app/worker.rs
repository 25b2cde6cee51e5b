//! The thread that compiles shaders and builds pipelines, so that the window never waits for either.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, unbounded};
use winit::event_loop::EventLoopProxy;

use crate::gpu::{Gpu, SetLayouts, vk};
use crate::render::{MaterialVariant, Outcome, PipelineSet, Reload, Reloader, Renderer, Wanted, tree_name};
use crate::settings::Settings;
use crate::shader::{Change, Compiler, ShaderSet, Source};

use super::Message;

/// What the window would draw right now; a reload builds pipelines for this.
#[derive(Clone)]
pub(super) struct Needs {
    pub(super) settings: Settings,
    pub(super) materials: BTreeSet<MaterialVariant>,
    pub(super) samples: u32,
    pub(super) scene_format: vk::Format,
}

impl Needs {
    /// The pipelines that these shaders must have.
    pub(super) fn wanted(&self, shaders: &ShaderSet) -> Result<Wanted, String> {
        let (samples, format) = (self.samples, self.scene_format);
        Wanted::new(&self.settings, shaders, &self.materials, samples, format, Renderer::OUTPUT_FORMAT)
    }
}

/// What the worker sends.
pub(super) enum WorkerMessage {
    /// A reload is finished.
    Reloaded {
        reload: Box<Reload>,
        /// From the first file event to the settled set.
        detect_ms: f64,
        /// All that the tree's files are called in messages, for the panel.
        tree: String,
    },
    /// Pipelines were added to a set, or why not.
    Built(Result<(), String>),
}

enum Request {
    Change { change: Change, since: Instant, settled: Instant },
    Build { set: Arc<PipelineSet>, wanted: Wanted },
    Tree(Source),
}

/// The window's end of the worker. Dropping it ends the thread.
pub(super) struct Worker {
    requests: Sender<Request>,
    needs: Arc<Mutex<Needs>>,
}

impl Worker {
    /// Starts the thread, which at once compiles the whole tree.
    pub(super) fn start(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        source: Source,
        needs: Needs,
        compiler: &Arc<Compiler>,
        proxy: EventLoopProxy<Message>,
    ) -> Self {
        let (requests, inbox) = unbounded();
        let needs = Arc::new(Mutex::new(needs));
        let mut thread = Thread {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            reloader: Reloader::new(gpu, layouts, compiler, source),
            compiler: compiler.clone(),
            needs: needs.clone(),
            inbox,
            proxy,
        };
        std::thread::spawn(move || thread.run());
        let worker = Self { requests, needs };
        worker.change(Change::All, Instant::now());
        worker
    }

    /// Tells what the window would draw now.
    pub(super) fn need(&self, needs: Needs) {
        *self.needs.lock().unwrap_or_else(PoisonError::into_inner) = needs;
    }

    /// Files have changed, first seen at `since`.
    pub(super) fn change(&self, change: Change, since: Instant) {
        let _ = self.requests.send(Request::Change { change, since, settled: Instant::now() });
    }

    /// A sender for the watcher's thread.
    pub(super) fn changes(&self) -> impl Fn(Change, Instant) + Send + 'static {
        let requests = self.requests.clone();
        move |change, since| {
            let _ = requests.send(Request::Change { change, since, settled: Instant::now() });
        }
    }

    /// Adds pipelines to a set.
    pub(super) fn build(&self, set: &Arc<PipelineSet>, wanted: &Wanted) {
        let _ = self.requests.send(Request::Build { set: set.clone(), wanted: wanted.clone() });
    }

    /// Takes another shader tree.
    pub(super) fn open_tree(&self, source: Source) {
        let _ = self.requests.send(Request::Tree(source));
    }
}

struct Thread {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    reloader: Reloader,
    compiler: Arc<Compiler>,
    needs: Arc<Mutex<Needs>>,
    inbox: Receiver<Request>,
    proxy: EventLoopProxy<Message>,
}

impl Thread {
    fn run(&mut self) {
        while let Ok(request) = self.inbox.recv() {
            match request {
                Request::Change { change, since, settled } => self.reload(change, since, settled),
                Request::Build { set, wanted } => self.build(&set, &wanted),
                Request::Tree(source) => self.open_tree(source),
            }
        }
    }

    fn open_tree(&mut self, source: Source) {
        self.reloader = Reloader::new(&self.gpu, &self.layouts, &self.compiler, source);
        self.reload(Change::All, Instant::now(), Instant::now());
    }

    /// Reloads with everything that has changed by now; edits that wait in the inbox join this one.
    fn reload(&mut self, mut change: Change, since: Instant, settled: Instant) {
        let mut later = Vec::new();
        for request in self.inbox.try_iter() {
            match request {
                Request::Change { change: more, .. } => change = change.and(more),
                other => later.push(other),
            }
        }
        let needs = self.needs.clone();
        let wanted = |shaders: &ShaderSet| {
            let needs = needs.lock().unwrap_or_else(PoisonError::into_inner).clone();
            // A value that no longer fits an edited constant must not stop the edit: the constant's default is shown.
            needs.wanted(shaders).or_else(|_| {
                let settings = Settings { shader: Default::default(), ..needs.settings.clone() };
                Needs { settings, ..needs }.wanted(shaders)
            })
        };
        let inbox = &self.inbox;
        let reload = self.reloader.update(change, wanted, || !inbox.is_empty());
        let ready = match &reload.outcome {
            Outcome::Ready(set) => Some(set.clone()),
            _ => None,
        };
        let tree = tree_name(self.reloader.library().source());
        let detect_ms = settled.duration_since(since).as_secs_f64() * 1e3;
        let message = WorkerMessage::Reloaded { reload: Box::new(reload), detect_ms, tree };
        let _ = self.proxy.send_event(Message::Worker(message));
        for request in later {
            match request {
                Request::Build { set, wanted } => self.build(&set, &wanted),
                Request::Tree(source) => self.open_tree(source),
                Request::Change { .. } => {}
            }
        }
        if let Some(set) = ready {
            self.build_ahead(&set);
        }
    }

    fn build(&mut self, set: &Arc<PipelineSet>, wanted: &Wanted) {
        let built = set.build(wanted).map_err(|e| e.to_string());
        let _ = self.proxy.send_event(Message::Worker(WorkerMessage::Built(built)));
        self.build_ahead(set);
    }

    /// Builds the modes before and after the one on screen, which `[` and `]` ask for next, unless there is other work.
    fn build_ahead(&self, set: &Arc<PipelineSet>) {
        let needs = self.needs.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let modes = &set.shaders.modes;
        let (Ok(wanted), false) = (needs.wanted(&set.shaders), modes.is_empty()) else { return };
        let at = modes.iter().position(|m| m.id == wanted.mode).unwrap_or(0);
        for neighbor in [(at + 1) % modes.len(), (at + modes.len() - 1) % modes.len()] {
            if !self.inbox.is_empty() {
                return;
            }
            // A neighbor that the driver refuses is told about when it is asked for.
            let _ = set.build(&wanted.with_mode(&modes[neighbor]));
        }
    }
}
