//! The captures that threads draw: what each is, and how far it is.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::capture::Turn;
use crate::control::Key;
use crate::picture::{Encoding, holds_light};

/// Most captures that are drawn or wait. Each keeps the images of its picture on the device.
const MOST: usize = 64;

/// Where a picture goes, and in which form.
#[derive(Clone, Debug)]
pub(in crate::app) struct Destination {
    /// `None` is the first free `specula-N.png`.
    pub(in crate::app) file: Option<PathBuf>,
    /// `None` is the encoding that the file's extension names.
    pub(in crate::app) encoding: Option<Encoding>,
    /// When it was asked for.
    pub(in crate::app) since: Instant,
}

impl Destination {
    /// A file whose extension names its encoding.
    pub(in crate::app) fn named(file: Option<PathBuf>) -> Self {
        Self { file, encoding: None, since: Instant::now() }
    }

    /// Whether the file holds linear light.
    pub(in crate::app) fn holds_light(&self) -> bool {
        self.encoding.map_or_else(|| self.file.as_deref().is_some_and(holds_light), Encoding::holds_light)
    }
}

/// Job of the background render thread.
#[derive(Clone, Debug)]
pub(in crate::app) enum Job {
    Picture { to: Destination, size: Option<(u32, u32)>, mode: Option<String>, frames: u32 },
    Probe { at: (u32, u32), names: Vec<String> },
    Sheet { file: PathBuf, names: Vec<String>, size: (u32, u32), columns: Option<u32> },
    Turntable { file: PathBuf, frames: u32, fps: f32, size: Option<(u32, u32)>, turn: Turn },
    Timeline { file: PathBuf, fps: f32, size: Option<(u32, u32)> },
}

impl Job {
    /// Title of the job in the panel.
    pub(in crate::app) fn title(&self) -> &'static str {
        match self {
            Self::Picture { .. } => "Picture",
            Self::Probe { .. } => "Values of a pixel",
            Self::Sheet { .. } => "Sheet of modes",
            Self::Turntable { .. } => "Turntable",
            Self::Timeline { .. } => "Timeline",
        }
    }
}

/// A capture that is under way.
pub(in crate::app) struct Running {
    pub(in crate::app) number: u64,
    pub(in crate::app) title: &'static str,
    /// Whose it is, and the identifier of its command.
    key: Key,
    /// Pictures that are done, and of how many; 0 while that is not known.
    pub(in crate::app) done: u64,
    pub(in crate::app) of: u64,
    canceled: Arc<AtomicBool>,
}

impl Running {
    /// Ends it after the picture that is being drawn.
    fn cancel(&self) {
        self.canceled.store(true, Ordering::Relaxed);
    }

    pub(in crate::app) fn is_canceled(&self) -> bool {
        self.canceled.load(Ordering::Relaxed)
    }
}

/// The captures that are under way, in the order in which they were begun.
#[derive(Default)]
pub(in crate::app) struct Captures {
    running: Vec<Running>,
    last: u64,
}

impl Captures {
    /// Adds a capture. Returns its number and what cancels it.
    pub(in crate::app) fn begin(&mut self, title: &'static str, key: Key) -> Result<(u64, Arc<AtomicBool>), String> {
        if self.running.len() >= MOST {
            return Err(format!("{MOST} captures are waiting already; send this one again when one of them has ended"));
        }
        self.last += 1;
        let canceled = Arc::new(AtomicBool::new(false));
        self.running.push(Running { number: self.last, title, key, done: 0, of: 0, canceled: canceled.clone() });
        Ok((self.last, canceled))
    }

    pub(in crate::app) fn iter(&self) -> impl Iterator<Item = &Running> {
        self.running.iter()
    }

    pub(in crate::app) fn is_empty(&self) -> bool {
        self.running.is_empty()
    }

    /// Ends the capture with this number.
    pub(in crate::app) fn cancel_one(&self, number: u64) {
        self.running.iter().filter(|running| running.number == number).for_each(Running::cancel);
    }

    /// Ends the capture of the command with this identifier. Returns whether there is one that goes on.
    pub(in crate::app) fn cancel_of(&self, key: &Key) -> bool {
        let found = self.running.iter().filter(|running| running.key == *key && !running.is_canceled());
        found.map(Running::cancel).count() > 0
    }

    /// Ends all.
    pub(in crate::app) fn cancel(&self) {
        self.running.iter().for_each(Running::cancel);
    }

    /// Takes what a thread tells about how far it is.
    pub(in crate::app) fn progress(&mut self, number: u64, done: u64, of: u64) {
        if let Some(running) = self.running.iter_mut().find(|running| running.number == number) {
            (running.done, running.of) = (done, of);
        }
    }

    /// Removes a capture that has ended.
    pub(in crate::app) fn ended(&mut self, number: u64) {
        self.running.retain(|running| running.number != number);
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    #[test]
    fn a_capture_is_refused_while_too_many_wait() {
        let mut captures = Captures::default();
        let begun: Vec<u64> = (0..MOST).map(|_| captures.begin("Picture", (0, Value::Null)).unwrap().0).collect();
        assert!(captures.begin("Picture", (0, Value::Null)).unwrap_err().contains("64 captures are waiting"));
        captures.ended(begun[0]);
        assert!(captures.begin("Picture", (0, Value::Null)).is_ok());
    }
}
