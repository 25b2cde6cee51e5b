//! Compares the picture with an earlier one: that of an older version of the shaders, or one that the user has kept.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{LastComplete, Version, Versions, Viewer};
use crate::app::command::CompareWith;
use crate::capture::VersionPicture;
use crate::comparison::Comparison;
use crate::events::{Event, emit};
use crate::gpu::GpuError;
use crate::picture;
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
    /// The number of the measurement that is under way.
    pub(in crate::app) measuring: Option<u64>,
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

/// The earlier picture, as a frame draws it for a comparison.
pub(in crate::app) struct Reference {
    pub(in crate::app) frame: BoundFrame,
    /// The part of the width that shows it, from the left, 0..1.
    pub(in crate::app) part: f32,
}

impl Default for Compare {
    fn default() -> Self {
        Self { with: None, wipe: 0.5, is_held: false, measuring: None, difference: None, shows_map: false }
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
    pub(super) fn on_compared(&mut self, number: u64, compared: Result<Box<Comparison>, String>) {
        // The result of pictures that have changed since counts for nothing.
        if self.compare.measuring.take_if(|measuring| *measuring == number).is_none() {
            return;
        }
        match compared {
            Ok(compared) if self.compare.is_on() => {
                let (flip, largest) = (compared.error, compared.largest);
                emit(&self.events, &Event::Compared { flip, largest });
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
        (self.compare.difference, self.compare.measuring, self.compare.shows_map) = (None, None, false);
        self.compare.with = match with {
            CompareWith::Nothing => None,
            CompareWith::Version(number) => Some(With::Version(number)),
            CompareWith::ThisPicture => {
                let is_whole = !self.is_cut_short();
                let Some(shown) = self.shown.as_ref().filter(|shown| is_whole && shown.scene.is_some()) else {
                    return self.say("There is no whole picture to keep");
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

    /// Label of the earlier picture; `None` if no comparison is shown.
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
        // The mouse may preview a mode.
        let mode = live.state.mode().map_or_else(|| self.session.settings.mode.clone(), |mode| mode.slug.clone());
        let selected = std::mem::replace(&mut self.session.settings.mode, mode);
        let state = self.session.frame_state_of(&set.shaders, self.clock, live.state.size, live.state.pipelines.target);
        self.session.settings.mode = selected;
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

    /// Inputs for a picture of each version, oldest first.
    pub(in crate::app) fn version_pictures(&self) -> Vec<VersionPicture> {
        let newest = self.shown_generation();
        let versions =
            self.versions.iter().filter(|version| version.number == newest || self.versions.can_show(version, newest));
        let of = |version: &Version| {
            let picture = version.picture.as_ref().or(self.shown.as_ref().filter(|_| version.number == newest));
            let label = format!("{}   {}", version.number, version.title());
            VersionPicture { set: version.set.clone(), label, like: picture.map(|picture| picture.frame.clone()) }
        };
        versions.map(of).collect()
    }

    /// Ends the comparison and drops old versions, while memory is short.
    pub(in crate::app) fn forget_references(&mut self) {
        self.compare = Compare::default();
        self.versions.drop_old();
    }

    /// Ends the comparison and drops all versions.
    pub(super) fn forget_all_references(&mut self) {
        (self.compare, self.versions) = (Compare::default(), Versions::default());
    }

    /// Ends the comparison, since a loop did not end in one of both pictures.
    pub(in crate::app) fn end_comparison(&mut self) {
        if self.compare.is_on() || self.compare.is_held {
            self.compare = Compare::default();
            self.say("A loop did not end, so the comparison has ended");
        }
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

    /// Writes the texts of a version over the files in which it differs from the version on screen, on a thread of its own. What is
    /// on disk and was never shown, such as an edit with an error, is kept beside each file.
    pub(super) fn write_version(&mut self, number: u64) {
        let (files, newest) = (self.files_of_version(number), self.session.shaders.clone());
        let Some((newest, root)) = newest.zip(self.source.root().map(Path::to_owned)) else { return };
        self.threads.wait(move || {
            let shown = |path: &Path| {
                let path = path.strip_prefix(&root).ok()?.to_str()?;
                newest.texts.get(&TreePath::from(path)).cloned()
            };
            let files: Vec<_> = files.into_iter().map(|(path, text)| (shown(&path), path, text)).collect();
            let names: Vec<&str> = files.iter().filter_map(|(_, path, _)| path.file_name()?.to_str()).collect();
            let done = || format!("Wrote version {number} of {}", names.join(", "));
            Some(Message::Say(write_files(&files).map_or_else(|message| message, |()| done())))
        });
    }
}

/// A file to write: the text that is shown, its path, and the new text.
pub(super) type Write = (Option<Arc<str>>, PathBuf, Arc<str>);

/// Writes files whole, all or none as far as reading them tells. A file keeps its byte order mark.
pub(super) fn write_files(files: &[Write]) -> Result<(), String> {
    let mark: &[u8] = b"\xef\xbb\xbf";
    let mut writes = Vec::new();
    for (shown, path, text) in files {
        let error = |error: std::io::Error| format!("cannot write {}: {error}. Nothing was written", path.display());
        let old = match std::fs::read(path) {
            Err(missing) if missing.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            read => read.map_err(error)?,
        };
        let (has_mark, old_text) = (old.starts_with(mark), old.strip_prefix(mark).unwrap_or(&old));
        let is_known = old.is_empty() || old_text == text.as_bytes();
        if !is_known && shown.as_ref().is_none_or(|shown| old_text != shown.as_bytes()) {
            let beside = path.with_extension(format!("{}.bak", path.extension().unwrap_or_default().display()));
            std::fs::write(&beside, &old).map_err(error)?;
        }
        writes.push((path, [if has_mark { mark } else { b"" }, text.as_bytes()].concat()));
    }
    writes.iter().try_for_each(|(path, bytes)| {
        picture::replace_file(path, bytes).map_err(|error| format!("cannot write {}: {error}", path.display()))
    })
}
