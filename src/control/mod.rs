//! Commands from outside, as JSON lines on stdin or on a local socket, and the lines that answer them. `crate::app::command` carries
//! them out; this module knows neither window nor device, nor the commands.
//!
//! A thread for each input reads lines and sends the name and the fields of a command with its `Reply` to the window's thread. A `Reply` is answered exactly once, also when it is dropped. A client's lines are written by a thread of
//! its own; 16 MiB unread end a client of the socket, and cost stdout lines. A client may have 64 commands open; its
//! next line is read when one is answered, so a flood fills a pipe and not the memory. All events of a window go
//! through these threads, so a reader that does not read never stops it. The supervisor forwards its stdin to the
//! child, and to the next child after a loss.

mod client;
mod line;
mod reader;
mod reply;
mod socket;

use std::io::Read;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, unbounded};

pub use client::{Client, Clients};
pub(crate) use line::kind;
pub use reader::MOST_BYTES;
pub(crate) use reply::{Asked, Key, Reply};
pub use socket::{Socket, remove_sockets, socket_path};

use crate::message::warn;

/// The programs outside: subscribers of events, and the commands that they send.
pub struct Control {
    clients: Clients,
    sender: Sender<Asked>,
    asked: Receiver<Asked>,
    socket: Option<Socket>,
}

/// How long the end of the program waits for clients to receive their last lines.
const FAREWELL: Duration = Duration::from_millis(500);

impl Control {
    /// No clients.
    pub fn new() -> Self {
        let (sender, asked) = unbounded();
        Self { clients: Clients::default(), sender, asked, socket: None }
    }

    /// Prints events on stdout, and returns the client for it.
    pub fn print_events(&self) -> Client {
        let stdout = Client::start(std::io::stdout(), None);
        self.clients.add(stdout.clone());
        stdout
    }

    /// Reads commands on a thread until `input` ends; the end of the input ends nothing else. Answers go to `client`. `then` runs
    /// at the end, and may return a last line.
    pub fn read(
        &self,
        input: impl Read + Send + 'static,
        client: Client,
        then: impl FnOnce(&Client) -> Option<String> + Send + 'static,
    ) {
        let sender = self.sender.clone();
        let work = move || {
            reader::read(input, &client, &sender);
            let last = then(&client);
            last.iter().for_each(|line| reader::read(line.as_bytes(), &client, &sender));
        };
        if let Err(error) = std::thread::Builder::new().name("specula-stdin".to_owned()).spawn(work) {
            warn(format_args!("no command from standard input is carried out: {error}"));
        }
    }

    /// Accepts clients on a socket, whose file is removed with this value.
    pub fn listen(&mut self, socket: Socket) {
        socket.accept(self.clients.clone(), self.sender.clone());
        self.socket = Some(socket);
    }

    /// All event subscribers.
    pub fn clients(&self) -> &Clients {
        &self.clients
    }

    /// The commands.
    pub(crate) fn asked(&self) -> Receiver<Asked> {
        self.asked.clone()
    }

    /// The path of the socket.
    pub fn socket(&self) -> Option<&std::path::Path> {
        self.socket.as_ref().map(Socket::path)
    }
}

impl Default for Control {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Control {
    fn drop(&mut self) {
        self.clients.flush(FAREWELL);
    }
}
