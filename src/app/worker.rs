//! The thread that compiles shaders and builds pipelines, so that the window never waits for either.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
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
    pub(super) own_lights: usize,
    pub(super) samples: u32,
    pub(super) scene_format: vk::Format,
}

impl Needs {
    /// The pipelines that these shaders must have.
    pub(super) fn wanted(&self, shaders: &ShaderSet) -> Wanted {
        let (samples, format) = (self.samples, self.scene_format);
        Wanted::new(&self.settings, shaders, &self.materials, self.own_lights, samples, format, Renderer::OUTPUT_FORMAT)
    }
}

/// What the worker sends.
pub(super) enum WorkerMessage {
    /// A reload is finished.
    Reloaded {
        reload: Box<Reload>,
        /// From the first file event to the settled set.
        detect_ms: f64,
        /// What the tree is called, for the panel.
        tree: String,
    },
    /// Pipelines were added to a set, or why not.
    Built(Result<(), String>),
}

/// Files that have changed, and when.
struct Edit {
    change: Change,
    since: Instant,
    settled: Instant,
}

enum Request {
    Edit(Edit),
    Tree(Source),
    Build { set: Arc<PipelineSet>, wanted: Wanted },
}

/// Sends requests, and counts those that make a reload under way stale.
#[derive(Clone)]
struct Outbox {
    requests: Sender<Request>,
    edits: Arc<AtomicU64>,
}

impl Outbox {
    fn send(&self, request: Request) {
        if !matches!(request, Request::Build { .. }) {
            self.edits.fetch_add(1, Ordering::SeqCst);
        }
        // The thread is gone only when the window is.
        let _ = self.requests.send(request);
    }

    fn edit(&self, change: Change, since: Instant) {
        self.send(Request::Edit(Edit { change, since, settled: Instant::now() }));
    }
}

/// The window's end of the worker. Dropping it ends the thread and waits for it: a process must not end inside its driver.
pub(super) struct Worker {
    outbox: Option<Outbox>,
    needs: Arc<Mutex<Needs>>,
    thread: Option<JoinHandle<()>>,
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
        let edits = Arc::new(AtomicU64::new(0));
        let needs = Arc::new(Mutex::new(needs));
        let mut thread = Thread {
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            reloader: Reloader::new(gpu, layouts, compiler, source),
            compiler: compiler.clone(),
            needs: needs.clone(),
            inbox,
            edits: edits.clone(),
            taken: 0,
            proxy,
        };
        let thread = std::thread::spawn(move || thread.run());
        let worker = Self { outbox: Some(Outbox { requests, edits }), needs, thread: Some(thread) };
        worker.change(Change::All, Instant::now());
        worker
    }

    /// Tells what the window would draw now.
    pub(super) fn need(&self, needs: Needs) {
        *self.needs.lock().unwrap_or_else(PoisonError::into_inner) = needs;
    }

    /// Files have changed, first seen at `since`.
    pub(super) fn change(&self, change: Change, since: Instant) {
        if let Some(outbox) = &self.outbox {
            outbox.edit(change, since);
        }
    }

    /// The same for the watcher's thread, which must end before the worker does.
    pub(super) fn changes(&self) -> impl Fn(Change, Instant) + Send + 'static {
        let outbox = self.outbox.clone();
        move |change, since| {
            if let Some(outbox) = &outbox {
                outbox.edit(change, since);
            }
        }
    }

    /// Adds pipelines to a set; the newest wish wins.
    pub(super) fn build(&self, set: &Arc<PipelineSet>, wanted: &Wanted) {
        self.send(Request::Build { set: set.clone(), wanted: wanted.clone() });
    }

    /// Takes another shader tree.
    pub(super) fn open_tree(&self, source: Source) {
        self.send(Request::Tree(source));
    }

    fn send(&self, request: Request) {
        if let Some(outbox) = &self.outbox {
            outbox.send(request);
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        if let Some(outbox) = self.outbox.take() {
            // Whatever is under way is stale now.
            outbox.edits.fetch_add(1, Ordering::SeqCst);
        }
        if let Some(thread) = self.thread.take() {
            // A panic there has been printed.
            let _ = thread.join();
        }
    }
}

struct Thread {
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    reloader: Reloader,
    compiler: Arc<Compiler>,
    needs: Arc<Mutex<Needs>>,
    inbox: Receiver<Request>,
    edits: Arc<AtomicU64>,
    /// How many of `edits` were taken out of the inbox.
    taken: u64,
    proxy: EventLoopProxy<Message>,
}

impl Thread {
    fn run(&mut self) {
        while let Ok(first) = self.inbox.recv() {
            // Everything that waits is taken at once: edits join, and of several wishes for pipelines the newest counts.
            let (mut edit, mut build) = (None::<Edit>, None);
            for request in std::iter::once(first).chain(self.inbox.try_iter().collect::<Vec<_>>()) {
                match request {
                    Request::Edit(new) => {
                        self.taken += 1;
                        edit = Some(match edit {
                            Some(old) => Edit { change: old.change.and(new.change), since: old.since, ..new },
                            None => new,
                        });
                    }
                    Request::Tree(source) => {
                        self.taken += 1;
                        self.reloader = Reloader::new(&self.gpu, &self.layouts, &self.compiler, source);
                        let now = Instant::now();
                        edit = Some(Edit { change: Change::All, since: now, settled: now });
                        build = None;
                    }
                    Request::Build { set, wanted } => build = Some((set, wanted)),
                }
            }
            if let Some(edit) = edit {
                self.reload(edit);
            }
            if let Some((set, wanted)) = build.filter(|_| !self.is_stale()) {
                let built = set.build(&wanted).map_err(|e| e.to_string());
                self.tell(WorkerMessage::Built(built));
                self.build_ahead(&set);
            }
        }
    }

    /// Whether a newer edit waits, or the window is closing.
    fn is_stale(&self) -> bool {
        self.edits.load(Ordering::SeqCst) > self.taken
    }

    fn needs(&self) -> Needs {
        self.needs.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn tell(&self, message: WorkerMessage) {
        // The window may be gone by now.
        let _ = self.proxy.send_event(Message::Worker(message));
    }

    fn reload(&mut self, edit: Edit) {
        let (needs, edits, taken) = (self.needs.clone(), self.edits.clone(), self.taken);
        let wanted = move |shaders: &ShaderSet| needs.lock().unwrap_or_else(PoisonError::into_inner).wanted(shaders);
        let reload = self.reloader.update(edit.change, wanted, || edits.load(Ordering::SeqCst) > taken);
        let ready = match &reload.outcome {
            Outcome::Ready(set) => Some(set.clone()),
            _ => None,
        };
        let tree = tree_name(self.reloader.library().source());
        let detect_ms = edit.settled.duration_since(edit.since).as_secs_f64() * 1e3;
        self.tell(WorkerMessage::Reloaded { reload: Box::new(reload), detect_ms, tree });
        // At the start the model needs both cores; the window asks again once it is there.
        if let Some(set) = ready.filter(|set| set.shaders.generation > 1) {
            self.build_ahead(&set);
        }
    }

    /// Builds the modes before and after the one on screen, which `[` and `]` ask for next, unless there is other work.
    fn build_ahead(&self, set: &Arc<PipelineSet>) {
        let (needs, modes) = (self.needs(), &set.shaders.modes);
        let wanted = needs.wanted(&set.shaders);
        let Some(at) = modes.iter().position(|m| m.id == wanted.mode) else { return };
        for neighbor in [(at + 1) % modes.len(), (at + modes.len() - 1) % modes.len()] {
            if !self.inbox.is_empty() || self.is_stale() {
                return;
            }
            // A neighbor that the driver refuses is told about when it is asked for.
            let _ = set.build(&wanted.with_mode(&modes[neighbor], needs.settings.view.tonemap));
        }
    }
}
