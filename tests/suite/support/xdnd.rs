//! A source of drag and drop by the XDND protocol, version 5: what a file manager does when the user drops a file on a window.

use std::path::Path;
use std::sync::mpsc::channel;

use x11rb::connection::Connection as _;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode, SelectionNotifyEvent,
    SelectionRequestEvent, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{COPY_DEPTH_FROM_PARENT, CURRENT_TIME, NONE};

use super::process::PATIENCE;

/// Version of the protocol.
const VERSION: u32 = 5;

x11rb::atom_manager! {
    Atoms: AtomsCookie {
        XdndAware,
        XdndSelection,
        XdndEnter,
        XdndPosition,
        XdndStatus,
        XdndDrop,
        XdndFinished,
        XdndActionCopy,
        URI_LIST: b"text/uri-list",
    }
}

/// Drags files over the pixel `at` of the screen and drops them on the window. Returns once the window has said that it is finished.
#[track_caller]
pub fn drop_files(display: &str, window: u32, at: (u32, u32), files: &[&Path]) {
    drag(display, window, files, move |source| source.drop_at(at));
}

/// Drops a file of a program that moves the mouse on before it answers, and gives the second of its answers after the drop.
#[track_caller]
pub fn drop_file_and_answer_late(display: &str, window: u32, at: (u32, u32), file: &Path) {
    drag(display, window, &[file], move |source| source.drop_and_answer_late(at));
}

#[track_caller]
fn drag(display: &str, window: u32, files: &[&Path], run: impl FnOnce(&Source) + Send + 'static) {
    let uri: String = files.iter().map(|file| format!("file://{}\r\n", file.display())).collect();
    let display = display.to_owned();
    let (sender, done) = channel();
    std::thread::spawn(move || {
        run(&Source::new(&display, window, uri));
        let _ = sender.send(());
    });
    done.recv_timeout(PATIENCE).expect("the window finishes the drop");
}

/// The same of one file.
#[track_caller]
pub fn drop_file(display: &str, window: u32, at: (u32, u32), file: &Path) {
    drop_files(display, window, at, &[file]);
}

/// A program that something is dragged from.
struct Source {
    server: RustConnection,
    atoms: Atoms,
    window: u32,
    target: u32,
    uri: String,
}

impl Source {
    fn new(display: &str, target: u32, uri: String) -> Self {
        let (server, screen) = x11rb::connect(Some(display)).unwrap();
        let atoms = Atoms::new(&server).unwrap().reply().unwrap();
        let root = server.setup().roots[screen].root;
        let window = server.generate_id().unwrap();
        let aux = CreateWindowAux::new();
        let (class, visual) = (WindowClass::INPUT_OUTPUT, NONE);
        server.create_window(COPY_DEPTH_FROM_PARENT, window, root, 0, 0, 1, 1, 0, class, visual, &aux).unwrap();
        server.set_selection_owner(window, atoms.XdndSelection, CURRENT_TIME).unwrap();
        let aware = server.get_property(false, target, atoms.XdndAware, AtomEnum::ANY, 0, 1).unwrap().reply().unwrap();
        let version = aware.value32().and_then(|mut words| words.next()).expect("the window takes drops (XdndAware)");
        assert!(version >= VERSION, "the window takes drops of version {version}");
        Self { server, atoms, window, target, uri }
    }

    fn drop_at(&self, at: (u32, u32)) {
        self.enter();
        self.move_to(at);
        let (mut accepted, mut asked) = (false, false);
        // A window may ask what is dragged before the drop, as it does when it shows whether it takes it.
        while !(accepted && asked) {
            match self.server.wait_for_event().unwrap() {
                Event::SelectionRequest(request) => {
                    self.answer(&request);
                    asked = true;
                }
                Event::ClientMessage(message) if message.type_ == self.atoms.XdndStatus => {
                    accepted = message.data.as_data32()[1] & 1 == 1;
                    if !asked {
                        self.move_to(at);
                    }
                }
                _ => {}
            }
        }
        self.finish();
    }

    fn drop_and_answer_late(&self, at: (u32, u32)) {
        self.enter();
        let requests = [(); 2].map(|()| {
            self.move_to(at);
            loop {
                if let Event::SelectionRequest(request) = self.server.wait_for_event().unwrap() {
                    return request;
                }
            }
        });
        self.answer(&requests[0]);
        self.finish();
        self.answer(&requests[1]);
        self.server.sync().unwrap();
    }

    fn enter(&self) {
        self.tell(self.atoms.XdndEnter, [VERSION << 24, self.atoms.URI_LIST, 0, 0]);
    }

    fn move_to(&self, (x, y): (u32, u32)) {
        self.tell(self.atoms.XdndPosition, [0, (x << 16) | y, CURRENT_TIME, self.atoms.XdndActionCopy]);
    }

    /// Drops, and returns once the window is finished.
    fn finish(&self) {
        self.tell(self.atoms.XdndDrop, [0, CURRENT_TIME, 0, 0]);
        loop {
            match self.server.wait_for_event().unwrap() {
                Event::SelectionRequest(request) => self.answer(&request),
                Event::ClientMessage(message) if message.type_ == self.atoms.XdndFinished => return,
                _ => {}
            }
        }
    }

    /// Sends a message of the protocol to the window.
    fn tell(&self, kind: u32, [a, b, c, d]: [u32; 4]) {
        let message = ClientMessageEvent::new(32, self.target, kind, [self.window, a, b, c, d]);
        self.server.send_event(false, self.target, EventMask::NO_EVENT, message).unwrap();
        self.server.flush().unwrap();
    }

    /// Hands over the URI of the file.
    fn answer(&self, request: &SelectionRequestEvent) {
        let SelectionRequestEvent { requestor, property, target, selection, time, .. } = *request;
        self.server.change_property8(PropMode::REPLACE, requestor, property, target, self.uri.as_bytes()).unwrap();
        let notify = SelectionNotifyEvent {
            response_type: x11rb::protocol::xproto::SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time,
            requestor,
            selection,
            target,
            property,
        };
        self.server.send_event(false, requestor, EventMask::NO_EVENT, notify).unwrap();
        self.server.flush().unwrap();
    }
}
