//! Files that are dragged over the window and dropped on it, which come one by one.
//!
//! On X11, winit 0.30 asks for the dragged files at each movement until it has them, and forgets them at the drop. An answer that comes after
//! the drop is kept for the next drag, which then drops the files of the one before. Such an answer looks like a drag of the files that were
//! just dropped, and [`forget`] ends it.

use std::path::PathBuf;

use winit::window::Window;

/// The files of the drag and the drop under way.
#[derive(Default)]
pub(super) struct Drops {
    /// Dragged over the window since the last drop.
    hovered: Vec<PathBuf>,
    dropped: Vec<PathBuf>,
    /// The files of the last drop, until the next drag.
    last: Vec<PathBuf>,
}

/// An event of files that came together.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum DropEvent {
    Dropped(Vec<PathBuf>),
    /// The files of the last drop are dragged again, though perhaps by nobody.
    Repeated,
}

impl Drops {
    /// A file is dragged over the window.
    pub(super) fn hover(&mut self, path: PathBuf) {
        self.hovered.push(path);
    }

    /// A file is dropped.
    pub(super) fn release(&mut self, path: PathBuf) {
        self.hovered.clear();
        self.dropped.push(path);
    }

    /// The events since the last call, once winit has told all of them.
    pub(super) fn take_events(&mut self) -> Vec<DropEvent> {
        let mut happened = Vec::new();
        if !self.dropped.is_empty() {
            self.last.clone_from(&self.dropped);
            happened.push(DropEvent::Dropped(std::mem::take(&mut self.dropped)));
        }
        if !self.hovered.is_empty() && std::mem::take(&mut self.last) == std::mem::take(&mut self.hovered) {
            happened.push(DropEvent::Repeated);
        }
        happened
    }
}

/// Lets winit forget the dragged files: it hears that the drag has left the window and come back, so it asks for them at its next movement.
#[cfg(target_os = "linux")]
pub(super) fn forget(window: &Window) {
    use winit::raw_window_handle::{HasWindowHandle as _, RawWindowHandle};

    let id = match window.window_handle().map(|handle| handle.as_raw()) {
        Ok(RawWindowHandle::Xlib(handle)) => u32::try_from(handle.window).ok(),
        Ok(RawWindowHandle::Xcb(handle)) => Some(handle.window.get()),
        _ => None,
    };
    let told = id.map_or(Ok(()), tell_of_return);
    if let Err(error) = told {
        tracing::debug!("cannot end the drag of files that were dropped: {error}");
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn forget(_: &Window) {}

/// Sends a window the messages of a drag of files that leaves it and enters it again.
#[cfg(target_os = "linux")]
fn tell_of_return(window: u32) -> Result<(), Box<dyn std::error::Error>> {
    use x11rb::protocol::xproto::{ClientMessageEvent, ConnectionExt as _, EventMask};
    use x11rb::wrapper::ConnectionExt as _;

    /// Version 5 of the protocol, in the byte where a message has it.
    const VERSION: u32 = 5 << 24;

    let (server, _) = x11rb::connect(None)?;
    let names = ["XdndLeave", "XdndEnter", "text/uri-list"];
    let [leave, enter, list] = names.map(|name| server.intern_atom(false, name.as_bytes()));
    let list = list?.reply()?.atom;
    for (kind, data) in [(leave, [0; 5]), (enter, [0, VERSION, list, 0, 0])] {
        let message = ClientMessageEvent::new(32, window, kind?.reply()?.atom, data);
        server.send_event(false, window, EventMask::NO_EVENT, message)?;
    }
    // A server that finds a connection closed does not read what was sent on it before.
    Ok(server.sync()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_of_the_files_that_were_dropped_is_told_once() {
        let mut drops = Drops::default();
        let files = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let both = files(&["a.glb", "b.glb"]);
        both.iter().for_each(|file| drops.hover(file.clone()));
        assert_eq!(drops.take_events(), []);
        both.iter().for_each(|file| drops.release(file.clone()));
        assert_eq!(drops.take_events(), [DropEvent::Dropped(both.clone())]);
        both.iter().for_each(|file| drops.hover(file.clone()));
        assert_eq!(drops.take_events(), [DropEvent::Repeated]);
        both.iter().for_each(|file| drops.hover(file.clone()));
        assert_eq!(drops.take_events(), [], "it is another drag of these files");
        // A late answer may come with the drop, and another drag is none.
        drops.release("a.glb".into());
        drops.hover("a.glb".into());
        assert_eq!(drops.take_events(), [DropEvent::Dropped(files(&["a.glb"])), DropEvent::Repeated]);
        drops.release("a.glb".into());
        drops.take_events();
        drops.hover("b.glb".into());
        assert_eq!(drops.take_events(), []);
    }
}
