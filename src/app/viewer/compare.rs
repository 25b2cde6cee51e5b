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

use std::sync::Arc;

use super::Viewer;
use crate::app::command::{Command, CompareWith};
use crate::app::drawn::compare::{Difference, Reference, With};
use crate::app::drawn::generations::Generations;
use crate::app::options::OtherPicture;
use crate::app::state::shaders::versions::{Version, Versions};
use crate::capture::VersionPicture;
use crate::comparison::Comparison;
use crate::events::{Event, emit};
use crate::frame::FrameState;
use crate::gpu::GpuError;
use crate::render::BoundFrame;
use crate::shader::ShaderSet;
pub(super) use write::write_files;

/// The answer to a request for a comparison that a newer one has replaced.
const REPLACED: &str = "the comparison was ended or replaced before it was shown";

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
                let map = Arc::new(compared.map().to_rgb8());
                let part = self.compare.measured_part();
                self.compare.difference = Some(Difference { flip, largest, map, part });
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
        let Some(set) = self.generations.set(version.number).cloned() else { return Ok(None) };
        let like = self.generations.picture(version.number).map(|picture| picture.frame.clone());
        let state = self.state_like(live, &set.shaders);
        if let Some(frame) = self.resources.bind_older(&set, &state, like.as_ref())? {
            return Ok(Some(frame));
        }
        if self.is_complete && !state.pipelines.needs_pending(&set.shaders) {
            self.threads.worker.build(&set, &state.pipelines);
        }
        let picture = self.generations.picture(set.shaders.generation);
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
            let set = self.generations.set(version.number)?.clone();
            let picture = self.generations.picture(version.number);
            let picture = picture.or(self.shown.as_ref().filter(|_| version.number == newest));
            let label = format!("{}   {}", version.number, version.title());
            Some(VersionPicture { set, label, like: picture.map(|picture| picture.frame.clone()) })
        };
        versions.filter_map(of).collect()
    }

    /// Ends the comparison and drops old versions, while memory is short.
    pub(in crate::app) fn forget_references(&mut self) {
        self.compare.end();
        self.versions.drop_old();
        self.generations.keep(&self.versions);
    }

    /// Ends the comparison and drops all versions.
    pub(super) fn forget_all_references(&mut self) {
        self.compare.end();
        (self.versions, self.generations) = (Versions::default(), Generations::default());
    }

    /// Marks a version in which a loop did not end, and releases its picture.
    pub(in crate::app) fn cut_short(&mut self, number: u64) {
        self.versions.cut_short(number);
        self.generations.drop_picture(number);
    }

    /// Ends the comparison, since a loop did not end in one of both pictures.
    pub(in crate::app) fn end_comparison(&mut self) {
        if self.compare.is_on() || self.compare.is_held {
            self.compare.end();
            self.say("A loop did not end, so the comparison has ended");
        }
    }
}
