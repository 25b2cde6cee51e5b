//! The checker: measures the exercise that is open after each good reload. The newest request wins, and a measurement ends between
//! two goals when a newer edit has come.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use crossbeam_channel::{Sender, unbounded};

use super::{Message, MessageSender, TaskKind};
use crate::gpu::Gpu;
use crate::learn::{Exercise, Finding, GoalMeter, LearnError};
use crate::shader::{Compiler, Source};

/// Result of a check.
pub(crate) struct Checked {
    /// Number of the request.
    pub(crate) number: u64,
    /// A finding for each goal, or the reason why there are none.
    pub(crate) result: Result<Vec<Finding>, String>,
}

struct Request {
    number: u64,
    exercise: &'static Exercise,
    source: Source,
}

/// The checker's thread, which starts with the first request. Dropping this waits for the goal that is being measured.
pub(crate) struct Checker {
    gpu: Arc<Gpu>,
    compiler: Arc<Compiler>,
    sender: MessageSender,
    /// The number of the newest request. A measurement with another number is superseded.
    newest: Arc<AtomicU64>,
    thread: Option<(Sender<Request>, JoinHandle<()>)>,
}

impl Checker {
    pub(crate) fn new(gpu: &Arc<Gpu>, compiler: &Arc<Compiler>, sender: &MessageSender) -> Self {
        let (gpu, compiler, sender) = (gpu.clone(), compiler.clone(), sender.clone());
        Self { gpu, compiler, sender, newest: Arc::default(), thread: None }
    }

    /// Measures a tree. Returns the number of the request.
    pub(crate) fn check(&mut self, exercise: &'static Exercise, source: Source) -> u64 {
        let number = self.supersede();
        let (sender, _) = self.thread.get_or_insert_with(|| {
            let (gpu, compiler, newest) = (self.gpu.clone(), self.compiler.clone(), self.newest.clone());
            let (sender, requests) = unbounded::<Request>();
            let run = move |sender: &MessageSender| {
                let mut meter = GoalMeter::new(&gpu, &compiler);
                for Request { number, exercise, source } in requests {
                    let is_old = || newest.load(Ordering::Relaxed) != number;
                    if is_old() {
                        continue;
                    }
                    let result = match meter.check(exercise, &source, is_old) {
                        Err(LearnError::Superseded) => continue,
                        result => result.map_err(|error| error.to_string()),
                    };
                    sender.send(Message::Checked(Checked { number, result }));
                }
            };
            (sender, self.sender.spawn(TaskKind::Checker, run))
        });
        let _ = sender.send(Request { number, exercise, source });
        number
    }

    /// Cancels the measurement that is under way. Returns the number of the next request.
    pub(crate) fn supersede(&self) -> u64 {
        self.newest.fetch_add(1, Ordering::Relaxed) + 1
    }

    /// Cancels the measurement that is under way, from another thread.
    pub(crate) fn superseding(&self) -> impl Fn() + Send + 'static {
        let newest = self.newest.clone();
        move || _ = newest.fetch_add(1, Ordering::Relaxed)
    }

    /// Forgets the thread, which has panicked. The next request starts another one.
    pub(crate) fn failed(&mut self) {
        self.thread = None;
    }
}

impl Drop for Checker {
    fn drop(&mut self) {
        self.supersede();
        if let Some((sender, thread)) = self.thread.take() {
            drop(sender);
            let _ = thread.join();
        }
    }
}
