//! The writer writes texts to the files of the shader tree, one after the other, in the order in which that was asked for.

use std::thread::JoinHandle;

use crossbeam_channel::{Sender, unbounded};

use super::message::{Message, MessageSender, TaskKind};

/// Writes a text, and says what came of it.
type Write = Box<dyn FnOnce() -> Message + Send>;

/// The thread, which starts with the first text. Dropping this waits until all are written.
pub(crate) struct Writer {
    sender: MessageSender,
    thread: Option<(Sender<Write>, JoinHandle<()>)>,
}

impl Writer {
    pub(super) fn new(sender: &MessageSender) -> Self {
        Self { sender: sender.clone(), thread: None }
    }

    /// Writes a text after all before, and sends the message.
    pub(crate) fn write(&mut self, write: impl FnOnce() -> Message + Send + 'static) {
        if self.thread.is_none() {
            let (queue, writes) = unbounded::<Write>();
            let write_all = move |sender: &MessageSender| {
                writes.iter().for_each(|write| sender.guarded(TaskKind::Writer, |sender| sender.send(write())));
            };
            self.thread = self.sender.spawn(TaskKind::Writer, write_all).map(|thread| (queue, thread));
        }
        // Without a thread, the window has been told.
        if let Some((queue, _)) = &self.thread {
            drop(queue.send(Box::new(write)));
        }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        if let Some((queue, thread)) = self.thread.take() {
            drop(queue);
            let _ = thread.join();
        }
    }
}
