//! The pixels of a screen, and their changes, as its X server tells them. Changes come by the DAMAGE extension, version 1.1: x11rb knows it only
//! with a feature that winit leaves off, and with it winit would be built twice, so the requests are written as bytes (damageproto.txt,
//! section 7).

use std::io::IoSlice;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

use image::RgbaImage;
use x11rb::connection::{Connection as _, RequestConnection as _};
use x11rb::protocol::xproto::{ConnectionExt as _, ImageFormat};
use x11rb::rust_connection::RustConnection;

/// Minor opcodes.
const QUERY_VERSION: u8 = 0;
const CREATE: u8 = 1;
const SUBTRACT: u8 = 3;
/// One report once the damaged region is no longer empty.
const NON_EMPTY: u32 = 3;

/// The root window of a display: its pixels, and its changes since they were forgotten.
pub struct RootWindow {
    server: Arc<RustConnection>,
    screen: usize,
    changes: Receiver<()>,
}

impl RootWindow {
    /// Watches the first screen of a display until its server ends.
    pub fn watch(display: &str) -> Self {
        let (sender, changes) = channel();
        let (server, screen) = x11rb::connect(Some(display)).unwrap();
        let extension = server.extension_information("DAMAGE").unwrap().expect("an X server with DAMAGE");
        let opcode = extension.major_opcode;
        let version = request(opcode, QUERY_VERSION, &[1, 1]);
        server.send_request_with_reply::<u8>(&[IoSlice::new(&version)], Vec::new()).unwrap().raw_reply().unwrap();
        let (id, root) = (server.generate_id().unwrap(), server.setup().roots[screen].root);
        send(&server, &request(opcode, CREATE, &[id, root, NON_EMPTY]));
        let subtract = request(opcode, SUBTRACT, &[id, 0, 0]);
        let server = Arc::new(server);
        let reporter = server.clone();
        std::thread::spawn(move || report(&reporter, extension.first_event, &subtract, &sender));
        Self { server, screen, changes }
    }

    /// The pixels as they are now. The server copies them between two requests, so no picture that a program puts there is half in them. It
    /// takes requests of a connection in their order: a change that is not in the copy is reported after it.
    pub fn pixels(&self) -> RgbaImage {
        let root = &self.server.setup().roots[self.screen];
        let (width, height) = (root.width_in_pixels, root.height_in_pixels);
        let image = self.server.get_image(ImageFormat::Z_PIXMAP, root.root, 0, 0, width, height, !0);
        let bgrx = image.unwrap().reply().unwrap().data;
        let rgba = bgrx.chunks_exact(4).flat_map(|bgrx| [bgrx[2], bgrx[1], bgrx[0], 255]).collect();
        RgbaImage::from_raw(width.into(), height.into(), rgba).expect("4 bytes for each pixel")
    }

    /// Forgets the changes so far.
    pub fn forget_changes(&self) {
        self.changes.try_iter().for_each(drop);
    }

    /// Waits for a change. Returns whether one has come.
    pub fn changes_before(&self, deadline: Instant) -> bool {
        self.changes.recv_timeout(deadline.saturating_duration_since(Instant::now())).is_ok()
    }
}

/// Passes each report on, and asks for the next one.
fn report(server: &RustConnection, notify: u8, subtract: &[u8], to: &Sender<()>) {
    while let Ok(event) = server.wait_for_raw_event() {
        // The upper bit marks events of other clients.
        if event[0] & 0x7f == notify {
            send(server, subtract);
            if to.send(()).is_err() {
                return;
            }
        }
    }
}

/// A request: opcodes, its length in words, its words.
fn request(major: u8, minor: u8, words: &[u32]) -> Vec<u8> {
    let length = (words.len() as u16 + 1).to_ne_bytes();
    [major, minor].into_iter().chain(length).chain(words.iter().flat_map(|word| word.to_ne_bytes())).collect()
}

/// Sends a request without a reply. The server may have ended.
fn send(server: &RustConnection, request: &[u8]) {
    let _ = server.send_request_without_reply(&[IoSlice::new(request)], Vec::new()).map(drop);
    let _ = server.flush();
}
