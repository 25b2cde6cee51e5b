//! Compares the picture with another one: that of an older version of the shaders, one that the user has kept, that of a second
//! shader tree, or a picture from a file.
//!
//! The other side of a comparison is rendered by a second `View`, so neither side disturbs the accumulation buffer or
//! the history of the other; its left columns are copied over the newest frame. Until the other side is ready, the
//! present comparison stays. After a lost device, the next window does not restore the comparison.

mod file;
mod labels;
mod tree;
mod write;

use std::path::PathBuf;
use std::sync::Arc;

use super::{LastComplete, Version, Versions, Viewer};
use crate::app::OtherPicture;
use crate::app::command::{Command, CompareWith};
use crate::capture::VersionPicture;
use crate::comparison::{Comparison, Still};
use crate::events::{Event, emit};
use crate::frame::FrameState;
use crate::gpu::GpuError;
use crate::render::BoundFrame;
use crate::shader::ShaderSet;
use file::PictureFile;
use tree::TreePicture;
pub(super) use write::write_files;

/// The answer to a request for a comparison that a newer one has replaced.
const REPLACED: &str = "the comparison was ended or replaced before it was shown";

/// The other picture, and how much of it is shown.
pub(in crate::app) struct Compare {
    with: Option<With>,
    /// The file or tree that is being read or compiled. It replaces `with` once it is ready; after a failure, `with` stays.
    opening: Option<Opening>,
    /// The number of the last request to read, scale or compile.
    number: u64,
    /// Whether the other picture was part of the last frame.
    is_drawn: bool,
    /// Where the border between both pictures is: the part of the width that shows the other one, 0..1.
    pub(in crate::app) wipe: f32,
    /// Whether only the other one is shown (Space).
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
    /// The part of the picture that was measured, as fractions of its size.
    pub(in crate::app) part: egui::Rect,
}

enum With {
    /// A version of the shaders, by its number.
    Version(u64),
    /// A picture with all its settings, and the number of its version.
    Kept(Box<LastComplete>, u64),
    /// A picture from a file.
    File(PictureFile),
    /// The picture of another shader tree.
    Tree(Box<TreePicture>),
}

/// The other side of the comparison while it is being opened.
enum Opening {
    /// A file that is being read, and the number of the request.
    File(u64, PathBuf),
    /// A tree that is being compiled.
    Tree(Box<TreePicture>),
}

/// The other picture, as a frame draws it for a comparison.
pub(in crate::app) struct Reference {
    /// The frame that draws it. For a picture from a file, the frame of the picture beside it.
    pub(in crate::app) frame: BoundFrame,
    /// The picture from a file, with the number of the request that made it.
    pub(in crate::app) still: Option<(u64, Arc<Still>)>,
    /// The part of the width that shows it, from the left, 0..1.
    pub(in crate::app) part: f32,
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            with: None,
            opening: None,
            number: 0,
            is_drawn: false,
            wipe: 0.5,
            is_held: false,
            measuring: None,
            difference: None,
            shows_map: false,
        }
    }
}

impl Compare {
    /// Whether both pictures are on screen with a border between them.
    pub(in crate::app) fn is_on(&self) -> bool {
        self.with.is_some()
    }

    /// Whether the other picture is shown alone.
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

    /// Whether a picture or tree for the comparison is being read or compiled.
    pub(in crate::app) fn is_opening(&self) -> bool {
        self.opening.is_some()
    }

    /// Whether both pictures were part of the last frame.
    pub(in crate::app) fn is_drawn(&self) -> bool {
        self.is_drawn && self.is_on() && !self.is_opening()
    }

    /// Compares with something else.
    fn set(&mut self, with: Option<With>) {
        (self.difference, self.measuring, self.shows_map) = (None, None, false);
        (self.with, self.is_drawn) = (with, false);
    }

    /// Ends the comparison, but not the numbers of its requests, whose answers may still come.
    fn end(&mut self) {
        *self = Self { number: self.number, ..Self::default() };
    }

    fn next_number(&mut self) -> u64 {
        self.number += 1;
        self.number
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
                let part = self.compare.measured_part();
                self.compare.difference = Some(Difference { flip, largest, map, texture: None, part });
            }
            Ok(_) => {}
            Err(message) => self.say(message),
        }
    }

    /// Begins the comparison that the command line asks for.
    pub(super) fn compare_at_start(&mut self, with: Option<OtherPicture>) {
        let with = with.map(|with| match with {
            OtherPicture::File(path) => CompareWith::File(path),
            OtherPicture::Tree(path) => CompareWith::Tree(path),
        });
        with.into_iter().for_each(|with| self.execute(Command::Compare(with)));
    }

    /// Chooses the other picture. The present one stays until the other is there.
    pub(super) fn compare_with(&mut self, with: CompareWith) {
        let with = match with {
            CompareWith::File(path) => return self.open_picture(&path),
            CompareWith::Tree(path) => return self.open_second_tree(&path).unwrap_or_else(|message| self.say(message)),
            CompareWith::Nothing => None,
            CompareWith::Version(number) => Some(With::Version(number)),
            CompareWith::ThisPicture => {
                let is_whole = !self.is_cut_short();
                let Some(shown) = self.shown.as_ref().filter(|shown| is_whole && shown.scene().is_some()) else {
                    return self.say("There is no complete picture to keep");
                };
                let restored = self.edits.restored.as_ref().map(|restored| restored.number);
                Some(With::Kept(Box::new(shown.clone()), restored.unwrap_or_else(|| self.shown_generation())))
            }
        };
        self.compare.opening = None;
        self.compare.set(with);
        self.comparison_failed(REPLACED);
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
    fn reference_label(&self) -> Option<String> {
        let before = self.version_before();
        let number = match &self.compare.with {
            Some(With::Kept(..)) => return Some("kept".to_owned()),
            Some(With::File(file)) => return Some(file.label()),
            Some(With::Tree(tree)) => return Some(tree.label()),
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

    /// The other picture with the camera of now. An older version and a second tree follow all settings as soon as their pipelines for
    /// them are built; until then, and with settings that need another light, it is the last picture that they had on screen.
    ///
    /// # Errors
    /// No memory left.
    pub(in crate::app) fn reference(&mut self, live: &BoundFrame) -> Result<Option<Reference>, GpuError> {
        let part = if self.compare.is_held { 1.0 } else { self.compare.wipe };
        let drawn = |frame| Reference { frame, still: None, part };
        let reference = match &self.compare.with {
            Some(With::Kept(kept, _)) => Some(drawn(self.interim(kept, self.clock, live.state.size))),
            Some(With::File(_)) => {
                let still = self.picture_that_fits(live.state.size);
                still.map(|still| Reference { frame: live.clone(), still: Some(still), part })
            }
            Some(With::Tree(_)) => self.picture_of_tree(live)?.map(drawn),
            Some(With::Version(number)) => self.picture_of_version(Some(*number), live)?.map(drawn),
            None => {
                let before = self.version_before().filter(|_| self.compare.is_held);
                self.picture_of_version(before, live)?.map(drawn)
            }
        };
        self.compare.is_drawn = reference.is_some();
        Ok(reference)
    }

    fn picture_of_version(&mut self, number: Option<u64>, live: &BoundFrame) -> Result<Option<BoundFrame>, GpuError> {
        let Some(version) = number.and_then(|number| self.versions.get(number)) else {
            self.compare.with = None;
            return Ok(None);
        };
        let (set, like) = (version.set.clone(), version.picture.as_ref().map(|picture| picture.frame.clone()));
        let state = self.state_like(live, &set.shaders);
        if let Some(frame) = self.resources.bind_older(&set, &state, like.as_ref())? {
            return Ok(Some(frame));
        }
        if self.is_complete && !state.pipelines.needs_pending(&set.shaders) {
            self.threads.worker.build(&set, &state.pipelines);
        }
        let picture = self.versions.get(set.shaders.generation).and_then(|version| version.picture.as_ref());
        Ok(picture.map(|picture| self.interim(picture, self.clock, live.state.size)))
    }

    /// The picture of now with other shaders.
    fn state_like(&mut self, live: &BoundFrame, shaders: &Arc<ShaderSet>) -> Arc<FrameState> {
        // The mouse may preview a mode.
        let mode = live.state.mode().map_or_else(|| self.session.settings.mode.clone(), |mode| mode.slug.clone());
        let selected = std::mem::replace(&mut self.session.settings.mode, mode);
        let state = self.session.frame_state_of(shaders, self.clock, live.state.size, live.state.pipelines.target);
        self.session.settings.mode = selected;
        state
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
        self.compare.end();
        self.versions.drop_old();
    }

    /// Ends the comparison and drops all versions.
    pub(super) fn forget_all_references(&mut self) {
        self.compare.end();
        self.versions = Versions::default();
    }

    /// Ends the comparison, since a loop did not end in one of both pictures.
    pub(in crate::app) fn end_comparison(&mut self) {
        if self.compare.is_on() || self.compare.is_held {
            self.compare.end();
            self.say("A loop did not end, so the comparison has ended");
        }
    }
}
