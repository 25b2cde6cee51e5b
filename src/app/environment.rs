//! The environment on screen: baked on a thread of its own, pass by pass, while the window draws with the one before.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use winit::event_loop::EventLoopProxy;

use crate::events::{Event, emit};
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::render::{BakeControl, BakeError, Baked, PipelineSet, measured_buffer};
use crate::scene::Measured;

use super::Message;
use super::document::Document;

/// What a baking thread sends.
pub(super) enum BakeMessage {
    /// How far it is, 0..1, and what comes next.
    Progress(u64, f32, String),
    /// The result of bake number so-and-so.
    Done(u64, Box<Result<Baked, BakeError>>),
}

/// A bake that was begun.
struct Attempt {
    name: String,
    with: Arc<PipelineSet>,
    /// How far it is and what comes next; `None` when it has ended, well or not.
    progress: Option<(f32, String)>,
}

/// The environment and the measured BRDF in use, and the bake under way.
pub(super) struct Surroundings {
    pub(super) baked: Baked,
    pub(super) measured: Arc<Buffer>,
    measured_of: String,
    /// Whether a file of what is baked has changed since.
    stale: bool,
    /// The newest bake: one that failed is not tried again before something changes.
    attempt: Option<Attempt>,
    newest: Arc<AtomicU64>,
    threads: Vec<JoinHandle<()>>,
}

impl Surroundings {
    /// Until the first bake is done the flat ambient light shines.
    pub(super) fn new(gpu: &Arc<Gpu>, ambient: [f32; 3]) -> Result<Self, GpuError> {
        Ok(Self {
            baked: Baked::uniform(gpu, ambient)?,
            measured: measured_buffer(gpu, None)?,
            measured_of: String::new(),
            stale: false,
            attempt: None,
            newest: Arc::default(),
            threads: Vec::new(),
        })
    }

    /// How far the bake under way is, and what comes next.
    pub(super) fn progress(&self) -> Option<&(f32, String)> {
        self.attempt.as_ref()?.progress.as_ref()
    }

    /// The files of the environment on screen, and the one that is asked for.
    pub(super) fn files(&self, name: &str) -> Vec<PathBuf> {
        let asked = std::path::absolute(name).ok().filter(|path| path.exists());
        self.baked.files.iter().cloned().chain(asked).collect()
    }

    /// The next frame tries again, whatever is known: a file has changed.
    fn forget(&mut self) {
        self.stale = true;
        self.attempt = None;
        self.newest.fetch_add(1, Ordering::SeqCst);
    }
}

impl Drop for Surroundings {
    fn drop(&mut self) {
        // No thread may still be inside the driver when the process ends.
        self.newest.fetch_add(1, Ordering::SeqCst);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

impl Document {
    /// Begins a bake when the environment that is set, or the shaders that bake it, are others than those on screen.
    pub(super) fn bake_if_needed(&mut self, set: &Arc<PipelineSet>) {
        let wanted = &self.settings.environment;
        let all = &mut self.surroundings;
        if !wanted.is_lit() || (!all.stale && all.baked.is_for(&wanted.name, set)) {
            // Back to what is on screen: what is under way is no longer wanted.
            let is_other = |attempt: &mut Attempt| {
                attempt.progress.is_some() && (attempt.name != wanted.name || !attempt.with.bakes_like(set))
            };
            if all.attempt.take_if(is_other).is_some() {
                all.newest.fetch_add(1, Ordering::SeqCst);
            }
            return;
        }
        let is_same = |tried: &Attempt| tried.name == wanted.name && tried.with.bakes_like(set);
        if all.attempt.as_ref().is_some_and(is_same) {
            return;
        }
        all.stale = false;
        let ticket = all.newest.fetch_add(1, Ordering::SeqCst) + 1;
        let (name, with) = (wanted.name.clone(), set.clone());
        let progress = Some((0.0, String::new()));
        all.attempt = Some(Attempt { name: name.clone(), with: with.clone(), progress });
        all.threads.retain(|thread| !thread.is_finished());
        all.threads.push(bake(with, name, ticket, all.newest.clone(), self.proxy.clone()));
    }

    pub(super) fn on_bake(&mut self, message: BakeMessage) {
        let newest = self.surroundings.newest.load(Ordering::SeqCst);
        match message {
            BakeMessage::Progress(ticket, done, next) if ticket == newest => {
                if let Some(attempt) = &mut self.surroundings.attempt {
                    attempt.progress = Some((done, next));
                }
            }
            BakeMessage::Done(ticket, result) if ticket == newest => {
                if let Some(attempt) = &mut self.surroundings.attempt {
                    attempt.progress = None;
                }
                match *result {
                    Ok(baked) => {
                        emit(self.events, &Event::Bake(&baked.environment.report));
                        self.surroundings.baked = baked;
                        self.watch_files();
                    }
                    Err(BakeError::Superseded) => {}
                    Err(error) => self.say(format!("{error}\nThe environment before stays.")),
                }
            }
            BakeMessage::Progress(..) | BakeMessage::Done(..) => {}
        }
    }

    /// Reads the measured BRDF that is set, when it is another than the one in use. A bad one is told of once.
    pub(super) fn read_measured(&mut self) {
        if self.surroundings.measured_of == self.settings.measured {
            return;
        }
        self.surroundings.measured_of.clone_from(&self.settings.measured);
        let measured = match self.settings.measured.as_str() {
            "" => Ok(None),
            path => Measured::open(path.as_ref()).map(Some).map_err(|e| e.to_string()),
        };
        let buffer = measured.and_then(|m| measured_buffer(&self.gpu, m.as_ref()).map_err(|e| e.to_string()));
        match buffer {
            Ok(buffer) => self.surroundings.measured = buffer,
            Err(message) => self.say(message),
        }
    }

    /// Whether one of these files is the environment's; then it is baked anew.
    pub(super) fn environment_changed(&mut self, changed: &BTreeSet<PathBuf>) -> bool {
        let is_ours = self.surroundings.files(&self.settings.environment.name).iter().any(|f| changed.contains(f));
        if is_ours {
            self.surroundings.forget();
        }
        is_ours
    }
}

fn bake(
    set: Arc<PipelineSet>,
    name: String,
    ticket: u64,
    newest: Arc<AtomicU64>,
    proxy: EventLoopProxy<Message>,
) -> JoinHandle<()> {
    std::thread::spawn(move || {
        let tell = |message| {
            // The window may be gone by now.
            let _ = proxy.send_event(Message::Bake(message));
        };
        let progress = |done: f32, next: &str| tell(BakeMessage::Progress(ticket, done, next.to_owned()));
        let superseded = || newest.load(Ordering::SeqCst) != ticket;
        let control = BakeControl { progress: &progress, superseded: &superseded, from_disk: true };
        let result = Baked::bake(&set, &name, &control);
        tell(BakeMessage::Done(ticket, Box::new(result)));
    })
}
