//! The checker: measures the exercise that is open after each good reload. The newest request wins, and a measurement ends between
//! two goals when a newer edit has come.

use std::sync::Arc;

use super::message::{Message, MessageSender, TaskKind};
use super::newest::Newest;
use super::results::Checked;
use crate::gpu::Gpu;
use crate::learn::{Exercise, GoalMeter, LearnError};
use crate::shader::{Compiler, Source};

/// The thread. Dropping this waits for the goal that is being measured.
pub(crate) struct Checker {
    gpu: Arc<Gpu>,
    compiler: Arc<Compiler>,
    thread: Newest<(Arc<Exercise>, Source)>,
}

impl Checker {
    pub(crate) fn new(gpu: &Arc<Gpu>, compiler: &Arc<Compiler>, sender: &MessageSender) -> Self {
        Self { gpu: gpu.clone(), compiler: compiler.clone(), thread: Newest::new(TaskKind::Checker, sender) }
    }

    /// Measures a tree. Returns the number of the request.
    pub(crate) fn check(&mut self, exercise: Arc<Exercise>, source: Source) -> u64 {
        self.thread.request((exercise, source), || {
            let mut meter = GoalMeter::new(&self.gpu, &self.compiler);
            move |sender, turn, (exercise, source)| {
                let result = match meter.check(&exercise, &source, || turn.is_superseded()) {
                    Err(LearnError::Superseded) => return,
                    result => result.map_err(|error| error.to_string()),
                };
                sender.send(Message::Checked(Checked { number: turn.number, result }));
            }
        })
    }

    /// Ends the measurement that is under way.
    pub(crate) fn supersede(&self) {
        self.thread.supersede();
    }

    /// Cancels the measurement that is under way, from another thread.
    pub(crate) fn superseding(&self) -> impl Fn() + Send + 'static {
        self.thread.superseding()
    }
}
