//! Follows the pixels that are pinned in running windows: they tell of them on their sockets.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crossbeam_channel::Sender;

use super::event::Event;
use super::window;

/// Windows are looked for at most this often.
const LOOK: Duration = Duration::from_secs(1);

/// The windows that are followed.
#[derive(Debug, Default)]
pub struct Following {
    joined: BTreeSet<PathBuf>,
    looked: Option<Instant>,
}

impl Following {
    /// Joins the windows that run now: the one that was named, or all of the user. A thread for each ends with its window.
    pub fn look(&mut self, named: Option<&Path>, events: &Sender<Event>) {
        if self.looked.is_some_and(|looked| looked.elapsed() < LOOK) {
            return;
        }
        self.looked = Some(Instant::now());
        for socket in window::socket_files(named) {
            if !self.joined.insert(socket.clone()) {
                continue;
            }
            let (events, of) = (events.clone(), socket.clone());
            let follow = move || {
                window::follow(&of, |pinned| drop(events.send(Event::Pinned(pinned))));
                let _ = events.send(Event::WindowClosed(of));
            };
            let thread = std::thread::Builder::new().name("specula-lsp-window".to_owned());
            if let Err(error) = thread.spawn(follow) {
                tracing::error!("the window is not followed: {error}");
                self.joined.remove(&socket);
            }
        }
    }

    /// Takes note that a window has closed.
    pub fn closed(&mut self, socket: &Path) {
        self.joined.remove(socket);
    }
}
