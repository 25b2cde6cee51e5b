//! A thread that works on the newest of its requests.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use crossbeam_channel::{Sender, unbounded};

use super::message::{MessageSender, TaskKind};

/// A request with its number.
type Numbered<T> = (u64, T);

/// The window's handle of the thread, which starts with the first request. Dropping it ends the work before its next step and waits for that.
pub(crate) struct Newest<T> {
    task: TaskKind,
    sender: MessageSender,
    /// Number of the newest request.
    newest: Arc<AtomicU64>,
    thread: Option<(Sender<Numbered<T>>, JoinHandle<()>)>,
}

/// A request that is being worked on.
pub(super) struct Turn<'a> {
    /// Number of the request.
    pub(super) number: u64,
    newest: &'a AtomicU64,
}

impl Turn<'_> {
    /// Whether a newer request has come, or nobody wants a result any more.
    pub(super) fn is_superseded(&self) -> bool {
        self.newest.load(Ordering::SeqCst) != self.number
    }
}

impl<T: Send + 'static> Newest<T> {
    pub(super) fn new(task: TaskKind, sender: &MessageSender) -> Self {
        Self { task, sender: sender.clone(), newest: Arc::default(), thread: None }
    }

    /// Requests work instead of what was requested before. Returns the number of the request. Without a thread, or after it has panicked, one
    /// starts that works with what `start` returns.
    pub(super) fn request<W>(&mut self, request: T, start: impl FnOnce() -> W) -> u64
    where
        W: FnMut(&MessageSender, &Turn<'_>, T) + Send + 'static,
    {
        let number = self.supersede();
        self.thread.take_if(|(_, thread)| thread.is_finished());
        if self.thread.is_none() {
            let (queue, requests) = unbounded();
            let (mut work, newest) = (start(), self.newest.clone());
            let run = move |sender: &MessageSender| {
                while let Ok(first) = requests.recv() {
                    let (number, request) = requests.try_iter().last().unwrap_or(first);
                    let turn = Turn { number, newest: &newest };
                    if !turn.is_superseded() {
                        work(sender, &turn, request);
                    }
                }
            };
            self.thread = self.sender.spawn(self.task.clone(), run).map(|thread| (queue, thread));
        }
        if let Some((queue, _)) = &self.thread {
            // Fails only after the thread has panicked, which the window reports.
            let _ = queue.send((number, request));
        }
        number
    }
}

impl<T> Newest<T> {
    /// Ends the work that is under way before its next step. Returns a new number.
    pub(crate) fn supersede(&self) -> u64 {
        self.newest.fetch_add(1, Ordering::SeqCst) + 1
    }

    /// [`Newest::supersede`] for another thread.
    pub(super) fn superseding(&self) -> impl Fn() + Send + 'static {
        let newest = self.newest.clone();
        move || _ = newest.fetch_add(1, Ordering::SeqCst)
    }
}

impl<T> Drop for Newest<T> {
    fn drop(&mut self) {
        self.supersede();
        if let Some((queue, thread)) = self.thread.take() {
            drop(queue);
            let _ = thread.join();
        }
    }
}
