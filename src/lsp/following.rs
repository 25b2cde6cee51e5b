//! Follows the pixels that are pinned in running windows: they tell of them on their sockets.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crossbeam_channel::Sender;

use super::event::Event;
use super::traced::Pinned;
use super::window;

/// Windows are looked for at most this often.
const LOOK: Duration = Duration::from_secs(1);

/// The windows that are followed.
#[derive(Debug, Default)]
pub struct Following {
    joined: BTreeSet<PathBuf>,
    looked: Option<Instant>,
    /// The pixel that each window has told of last.
    pixels: BTreeMap<PathBuf, Option<(u32, u32)>>,
    /// Whether the editor has unpinned the pixel, so that only a click pins another one.
    pub is_muted: bool,
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

    /// Takes note of what a window tells. Returns whether the user has clicked there since it told last.
    pub fn is_click(&mut self, pinned: &Pinned) -> bool {
        let before = self.pixels.insert(pinned.socket.clone(), pinned.pixel);
        before.is_some_and(|before| before != pinned.pixel) && !pinned.moved
    }

    /// Takes note that a window has closed.
    pub fn closed(&mut self, socket: &Path) {
        self.joined.remove(socket);
        self.pixels.remove(socket);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_pixel_is_a_click_and_another_picture_is_none() {
        let mut following = Following::default();
        let pinned = |socket: &str, pixel| Pinned { socket: socket.into(), tree: None, pixel, moved: false };
        for (socket, pixel, is_click) in [
            ("a", Some((1, 2)), false),
            ("a", Some((1, 2)), false),
            ("b", None, false),
            ("a", Some((3, 2)), true),
            ("b", Some((1, 2)), true),
            ("b", None, true),
        ] {
            assert_eq!(following.is_click(&pinned(socket, pixel)), is_click, "{socket} {pixel:?}");
        }
        let moved = Pinned { moved: true, ..pinned("a", Some((2, 1))) };
        assert!(!following.is_click(&moved) && !following.is_click(&moved), "a window of another size");
        following.closed(Path::new("a"));
        assert!(!following.is_click(&pinned("a", Some((9, 9)))), "another window of the name");
    }
}
