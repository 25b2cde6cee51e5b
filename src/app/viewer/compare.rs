//! Compares the picture with an earlier one: that of an older version of the shaders, or one that the user has kept.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{LastComplete, Viewer};
use crate::app::command::CompareWith;
use crate::comparison::Comparison;
use crate::events::{Event, emit};
use crate::gpu::GpuError;
use crate::render::BoundFrame;
use crate::shader::TreePath;
use crate::threads::Message;

/// The earlier picture, and how much of it is shown.
pub(in crate::app) struct Compare {
    with: Option<With>,
    /// Where the border between both pictures is: the part of the width that shows the earlier one, 0..1.
    pub(in crate::app) wipe: f32,
    /// Whether only the earlier one is shown (Space).
    is_held: bool,
    /// Whether the difference is being measured.
    pub(in crate::app) is_measuring: bool,
    /// The difference of both.
    pub(in crate::app) difference: Option<Difference>,
    /// Whether the map of the difference covers the picture.
    pub(in crate::app) shows_map: bool,
}

/// How much both pictures differ.
pub(in crate::app) struct Difference {
    /// Mean FLIP (Andersson et al. 2020), 0..1.
    pub(in crate::app) flip: f64,
    /// Largest difference of a channel of the display, 0..1.
    pub(in crate::app) largest: f64,
    /// FLIP of each pixel in magma colors.
    pub(in crate::app) map: egui::ImageData,
    /// The map on the device, once it has been shown.
    pub(in crate::app) texture: Option<egui::TextureHandle>,
}

enum With {
    /// A version of the shaders, by its number.
    Version(u64),
    /// A picture with all its settings, and how it is called.
    Kept(Box<LastComplete>, String),
}

/// The earlier picture in one frame.
pub(in crate::app) struct Reference {
    pub(in crate::app) frame: BoundFrame,
    /// The part of the width that shows it, from the left, 0..1.
    pub(in crate::app) part: f32,
}

impl Default for Compare {
    fn default() -> Self {
        Self { with: None, wipe: 0.5, is_held: false, is_measuring: false, difference: None, shows_map: false }
    }
}

impl Compare {
    /// Whether both pictures are on screen with a border between them.
    pub(in crate::app) fn is_on(&self) -> bool {
        self.with.is_some()
    }

    /// Whether the earlier picture is shown alone.
    pub(in crate::app) fn is_held(&self) -> bool {
        self.is_held
    }

    /// The version that is compared with.
    pub(in crate::app) fn version(&self) -> Option<u64> {
        match self.with {
            Some(With::Version(number)) => Some(number),
            _ => None,
        }
    }
}

impl Viewer {
    /// Takes the measured difference.
    pub(super) fn on_compared(&mut self, compared: Result<Box<Comparison>, String>) {
        self.compare.is_measuring = false;
        match compared {
            Ok(compared) if self.compare.is_on() => {
                let (flip, largest) = (compared.error, compared.largest);
                emit(self.events, &Event::Compared { flip, largest });
                let map = compared.map().to_rgb8();
                let size = [map.width() as usize, map.height() as usize];
                let map = egui::ColorImage::from_rgb(size, map.as_raw()).into();
                self.compare.difference = Some(Difference { flip, largest, map, texture: None });
            }
            Ok(_) => {}
            Err(message) => self.say(message),
        }
    }

    /// Chooses the earlier picture.
    pub(super) fn compare_with(&mut self, with: CompareWith) {
        self.compare.difference = None;
        self.compare.with = match with {
            CompareWith::Nothing => None,
            CompareWith::Version(number) => Some(With::Version(number)),
            CompareWith::ThisPicture => {
                let Some(shown) = self.shown.as_ref().filter(|shown| shown.scene.is_some()) else {
                    return self.say("There is no picture to keep yet");
                };
                let mode = shown.frame.state.mode().map_or("", |mode| mode.name.as_str());
                let label = format!("{mode}, kept");
                Some(With::Kept(Box::new(shown.clone()), label))
            }
        };
        if matches!(self.compare.with, Some(With::Kept(..))) {
            self.say("Kept this picture. Change a file or a setting and compare; Ctrl+K ends it");
        }
    }

    /// Shows only the earlier picture while `on`: that of the comparison, or the one before the last edit. Returns whether that
    /// changes what is on screen.
    pub(in crate::app) fn hold_reference(&mut self, on: bool) -> bool {
        let has_one = self.compare.is_on() || self.version_before().is_some();
        if on && !has_one {
            self.say("There is no earlier picture: no edit has been shown yet");
        }
        let is_held = on && has_one;
        std::mem::replace(&mut self.compare.is_held, is_held) != is_held
    }

    /// The generation of the shaders on screen.
    pub(in crate::app) fn shown_generation(&self) -> u64 {
        self.shown.as_ref().map_or(0, |shown| shown.frame.state.shaders.generation)
    }

    /// The number of the version before that on screen.
    fn version_before(&self) -> Option<u64> {
        self.versions.before(self.shown_generation()).map(|version| version.number)
    }

    /// What the earlier picture is called, while one is shown.
    pub(in crate::app) fn reference_label(&self) -> Option<String> {
        let before = self.version_before();
        let number = match &self.compare.with {
            Some(With::Kept(_, label)) => return Some(label.clone()),
            Some(With::Version(number)) => *number,
            None => before.filter(|_| self.compare.is_held)?,
        };
        let next = self.versions.iter().find(|version| version.number > number)?;
        Some(if Some(number) == before {
            format!("before the edit of {}", next.title())
        } else {
            format!("version {number}")
        })
    }

    /// The earlier picture with the camera of now. An older version follows all settings as soon as its pipelines for them are
    /// built; until then, and with settings that need another light, it is the last picture that it had on screen.
    ///
    /// # Errors
    /// No memory left.
    pub(in crate::app) fn reference(&mut self, live: &BoundFrame) -> Result<Option<Reference>, GpuError> {
        let part = if self.compare.is_held { 1.0 } else { self.compare.wipe };
        let number = match &self.compare.with {
            Some(With::Kept(kept, _)) => {
                let frame = self.interim(kept, self.clock, live.state.size);
                return Ok(Some(Reference { frame, part }));
            }
            Some(With::Version(number)) => Some(*number),
            None => self.version_before().filter(|_| self.compare.is_held),
        };
        let Some(version) = number.and_then(|number| self.versions.get(number)) else {
            self.compare.with = None;
            return Ok(None);
        };
        let (set, like) = (version.set.clone(), version.picture.as_ref().map(|picture| picture.frame.clone()));
        let state = self.session.frame_state_of(&set.shaders, self.clock, live.state.size, live.state.pipelines.target);
        let state = Arc::new(state);
        if let Some(frame) = self.resources.bind_older(&set, &state, like.as_ref())? {
            return Ok(Some(Reference { frame, part }));
        }
        if self.is_complete && !state.pipelines.needs_pending(&set.shaders) {
            self.threads.worker.build(&set, &state.pipelines);
        }
        let picture = self.versions.get(set.shaders.generation).and_then(|version| version.picture.as_ref());
        let frame = picture.map(|picture| self.interim(picture, self.clock, live.state.size));
        Ok(frame.map(|frame| Reference { frame, part }))
    }

    /// Ends the comparison and drops old versions, while memory is short.
    pub(in crate::app) fn forget_references(&mut self) {
        self.compare = Compare::default();
        self.versions.drop_old();
    }

    /// The files in which a version differs from the version on screen, with its text of each. Empty for a tree without a folder.
    pub(in crate::app) fn files_of_version(&self, number: u64) -> Vec<(PathBuf, Arc<str>)> {
        let newest = self.session.shaders.as_ref().map(|shaders| &shaders.texts);
        let all = self.source.root().zip(self.versions.get(number)).zip(newest);
        let Some(((root, version), newest)) = all else { return Vec::new() };
        let differs = |(path, text): &(&TreePath, &Arc<str>)| newest.get(*path) != Some(*text);
        let texts = version.set.shaders.texts.iter().filter(differs);
        texts.map(|(path, text)| (root.join(path.as_str()), text.clone())).collect()
    }

    /// Writes the texts of a version over the files in which it differs from the version on screen, on a thread of its own.
    pub(super) fn write_version(&mut self, number: u64) {
        let files = self.files_of_version(number);
        self.threads.wait(move || {
            let names: Vec<&str> = files.iter().filter_map(|(path, _)| path.file_name()?.to_str()).collect();
            let written = files.iter().try_for_each(|(path, text)| write_text(path, text));
            let done = || format!("Wrote version {number} of {}", names.join(", "));
            Some(Message::Say(written.map_or_else(|message| message, |()| done())))
        });
    }
}

/// Writes a text over a file, which keeps its byte order mark.
fn write_text(path: &Path, text: &str) -> Result<(), String> {
    let error = |error: std::io::Error| format!("cannot write {}: {error}", path.display());
    let mark: &[u8] = b"\xef\xbb\xbf";
    let has_mark = std::fs::read(path).map_err(error)?.starts_with(mark);
    let bytes = [if has_mark { mark } else { b"" }, text.as_bytes()].concat();
    std::fs::write(path, bytes).map_err(error)
}
