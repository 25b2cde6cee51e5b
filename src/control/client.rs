//! A reader of events and answers. A thread of its own writes to it, so a reader that does not read holds nobody up.

use std::collections::VecDeque;
use std::io::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Bytes that a client may leave unread.
const MOST_UNREAD: usize = 16 << 20;
/// Commands of a client that may be unanswered. The next one is read only once one of them has been answered.
const MOST_OPEN: usize = 64;

/// The number of the last client.
static LAST: AtomicU64 = AtomicU64::new(0);

/// Time between two questions whether to wait any longer.
const ASK_AGAIN: Duration = Duration::from_millis(100);

/// Ends the connection to a client.
pub type HangUp = Box<dyn Fn() + Send + Sync>;

/// A client that reads lines.
#[derive(Clone)]
pub struct Client(Arc<Shared>);

struct Shared {
    /// Tells clients apart.
    number: u64,
    queue: Mutex<Queue>,
    changed: Condvar,
    hang_up: Option<HangUp>,
}

#[derive(Default)]
struct Queue {
    lines: VecDeque<Arc<str>>,
    bytes: usize,
    is_writing: bool,
    is_closed: bool,
    /// Commands without an answer.
    open: usize,
}

impl Client {
    /// Starts the thread that writes to `writer`. A client that leaves too much unread is disconnected; without `hang_up`, it
    /// misses events until it reads again, but no answers: its next command is read only then.
    pub fn start(writer: impl Write + Send + 'static, hang_up: Option<HangUp>) -> Self {
        let number = LAST.fetch_add(1, Ordering::Relaxed) + 1;
        let client = Self(Arc::new(Shared { number, queue: Mutex::default(), changed: Condvar::new(), hang_up }));
        let shared = client.0.clone();
        let started = std::thread::Builder::new().name("specula-client".to_owned()).spawn(move || shared.write(writer));
        if started.is_err() {
            client.close();
        }
        client
    }

    /// A number that no other client of this process has; never 0.
    pub fn number(&self) -> u64 {
        self.0.number
    }

    /// Sends a line, without its line break. Returns at once.
    pub fn send(&self, line: &Arc<str>) {
        self.push(line, false);
    }

    /// [`Self::send`] for the answer to a command.
    pub(super) fn answer(&self, line: &Arc<str>) {
        self.push(line, self.0.hang_up.is_none());
    }

    fn push(&self, line: &Arc<str>, is_owed: bool) {
        let mut queue = self.0.lock();
        if queue.is_closed {
            return;
        }
        if queue.bytes + line.len() > MOST_UNREAD && !is_owed {
            drop(queue);
            if self.0.hang_up.is_some() {
                self.close();
            }
            return;
        }
        queue.bytes += line.len();
        queue.lines.push_back(line.clone());
        self.0.changed.notify_all();
    }

    /// Ends the connection.
    pub fn close(&self) {
        let mut queue = self.0.lock();
        queue.is_closed = true;
        queue.lines.clear();
        drop(queue);
        if let Some(hang_up) = &self.0.hang_up {
            hang_up();
        }
        self.0.changed.notify_all();
    }

    /// Whether the client no longer reads.
    pub fn is_closed(&self) -> bool {
        self.0.lock().is_closed
    }

    /// Counts a command that is to be answered. Blocks while too many are, or while too many answers are unread.
    pub(super) fn begin(&self) {
        let mut queue = self.0.lock();
        while (queue.open >= MOST_OPEN || queue.bytes > MOST_UNREAD) && !queue.is_closed {
            queue = self.0.changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
        }
        queue.open += 1;
    }

    /// Counts a command as answered.
    pub(super) fn end(&self) {
        let mut queue = self.0.lock();
        queue.open = queue.open.saturating_sub(1);
        self.0.changed.notify_all();
    }

    /// Waits until all commands are answered, the client no longer reads, or `gives_up` says so, which is asked a few times a second.
    pub fn wait_for_answers(&self, gives_up: impl Fn() -> bool) {
        let mut queue = self.0.lock();
        while queue.open > 0 && !queue.is_closed {
            queue = self.0.changed.wait_timeout(queue, ASK_AGAIN).unwrap_or_else(PoisonError::into_inner).0;
            if gives_up() {
                return;
            }
        }
    }

    /// Waits until all lines are written, at most until `deadline`.
    fn flush(&self, deadline: Instant) {
        let mut queue = self.0.lock();
        while !queue.is_closed && (queue.is_writing || !queue.lines.is_empty()) {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return;
            }
            queue = self.0.changed.wait_timeout(queue, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes lines until the client is closed.
    fn write(&self, mut writer: impl Write) {
        loop {
            let mut queue = self.lock();
            queue.is_writing = false;
            self.changed.notify_all();
            let line = loop {
                if queue.is_closed {
                    return;
                }
                match queue.lines.pop_front() {
                    Some(line) => break line,
                    None => queue = self.changed.wait(queue).unwrap_or_else(PoisonError::into_inner),
                }
            };
            queue.is_writing = true;
            drop(queue);
            let written = writeln!(writer, "{line}").and_then(|()| writer.flush());
            let mut queue = self.lock();
            queue.bytes -= line.len();
            if written.is_err() {
                (queue.is_closed, queue.is_writing) = (true, false);
                queue.lines.clear();
                self.changed.notify_all();
                return;
            }
        }
    }
}

/// All subscribers of events.
#[derive(Clone, Default)]
pub struct Clients(Arc<Mutex<Vec<Client>>>);

impl Clients {
    /// Adds a subscriber.
    pub fn add(&self, client: Client) {
        let mut clients = self.lock();
        clients.retain(|client| !client.is_closed());
        clients.push(client);
    }

    /// Whether there are no subscribers.
    pub fn is_empty(&self) -> bool {
        self.lock().is_empty()
    }

    /// Sends a line to all subscribers.
    pub fn send(&self, line: &str) {
        let line: Arc<str> = line.into();
        let mut clients = self.lock();
        clients.retain(|client| !client.is_closed());
        clients.iter().for_each(|client| client.send(&line));
    }

    /// Waits until all subscribers have received all lines, at most for this long.
    pub fn flush(&self, most: Duration) {
        let clients = self.lock().clone();
        let deadline = Instant::now() + most;
        clients.iter().for_each(|client| client.flush(deadline));
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Client>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::io;
    use std::sync::mpsc::{Receiver, Sender, channel};

    use super::*;

    /// A writer that waits for a permit before each line.
    struct Slow(Receiver<()>, Arc<Mutex<Vec<u8>>>);

    impl Write for Slow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.recv().map_err(io::Error::other)?;
            self.1.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn slow(hang_up: Option<HangUp>) -> (Client, Sender<()>, Arc<Mutex<Vec<u8>>>) {
        let ((permit, permits), written) = (channel(), Arc::default());
        (Client::start(Slow(permits, Arc::clone(&written)), hang_up), permit, written)
    }

    #[test]
    fn a_reader_that_does_not_read_holds_nobody_up() {
        let (told, hung_up) = channel();
        let hang_up: HangUp = Box::new(move || {
            let _ = told.send(());
        });
        let (lazy, _permit, _) = slow(Some(hang_up));
        let (stdout, permits, written) = slow(None);
        let clients = Clients::default();
        clients.add(lazy.clone());
        clients.add(stdout.clone());
        let long = "x".repeat(MOST_UNREAD / 4);
        (0..8).for_each(|_| clients.send(&long));
        assert!(lazy.is_closed() && hung_up.recv().is_ok());
        assert!(!stdout.is_closed(), "stdout only misses lines");
        stdout.answer(&"an answer".into());
        (0..100).for_each(|_| {
            let _ = permits.send(());
        });
        clients.flush(Duration::from_secs(60));
        let answer = "an answer\n".len();
        assert_eq!(written.lock().unwrap().len(), 4 * (long.len() + 1) + answer, "all but answers is missed");
        clients.send("next");
        clients.flush(Duration::from_secs(60));
        assert!(written.lock().unwrap().ends_with(b"\nnext\n"));
    }

    #[test]
    fn a_writer_that_fails_closes_the_client() {
        let (client, permits, _) = slow(None);
        drop(permits);
        client.send(&"line".into());
        client.flush(Instant::now() + Duration::from_secs(60));
        assert!(client.is_closed());
    }
}
