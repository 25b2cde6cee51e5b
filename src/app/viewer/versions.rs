//! The versions of the shaders that were on screen, with what each changed, what it cost and how it looked.
//!
//! When shaders of a new generation come on screen, the window keeps the previous ones as a version: their
//! `PipelineSet` and the last frame that they rendered. A version can be rendered again with the current settings:
//! `Resources::bind_older` binds the settings to the version's own pipelines, which the worker builds if they are
//! missing, and to the light of the version's last frame, because light baked by newer shaders would not be the
//! version's. Where that light does not fit (another environment was chosen since), the last frame itself is shown. A
//! version in which a loop did not end is not rendered again. When memory runs out, versions are dropped first.

use std::cell::OnceCell;
use std::collections::VecDeque;
use std::sync::Arc;

use chrono::{DateTime, Local};

use super::LastComplete;
use crate::app::state::shaders::difference::{Line, difference};
use crate::events::ReloadEvent;
use crate::pipeline::PipelineSet;
use crate::shader::ShaderSet;

/// Number of versions that are kept. Each holds pipelines, and after an edit of D also the light that was baked with it.
const MOST: usize = 12;

/// One version of the shaders.
pub(in crate::app) struct Version {
    /// Its generation.
    pub(in crate::app) number: u64,
    /// When it was first on screen.
    pub(in crate::app) since: DateTime<Local>,
    /// The reload that made it.
    pub(in crate::app) reload: ReloadEvent,
    /// Device time of its first frame, milliseconds.
    pub(in crate::app) device_ms: Option<f64>,
    /// Thumbnail of its last picture.
    pub(in crate::app) thumbnail: Option<egui::TextureHandle>,
    pub(super) set: Arc<PipelineSet>,
    /// Its last complete picture. `None` while it is the newest version, and after the model has changed.
    pub(super) picture: Option<LastComplete>,
    /// Whether a loop did not end in its picture.
    is_cut_short: bool,
    /// Whether the files have other texts: numbers are dragged, or it is an older version again. The next version takes its place.
    is_draft: bool,
    /// The older version that it is again.
    again: Option<u64>,
    /// Its texts compared with those of the version before.
    difference: OnceCell<Vec<Line>>,
}

impl Version {
    /// The names of the changed files without folders, "whole tree", or the version that it is again.
    pub(in crate::app) fn title(&self) -> String {
        if let Some(number) = self.again {
            return format!("version {number} again");
        }
        let names: Vec<&str> = self.reload.changed.iter().map(|path| path.rsplit('/').next().unwrap_or(path)).collect();
        if names.is_empty() { "whole tree".to_owned() } else { names.join(", ") }
    }
}

/// The newest versions, the oldest first.
#[derive(Default)]
pub(in crate::app) struct Versions {
    list: VecDeque<Version>,
}

impl Versions {
    /// All versions, the oldest first.
    pub(in crate::app) fn iter(&self) -> impl DoubleEndedIterator<Item = &Version> {
        self.list.iter()
    }

    pub(in crate::app) fn get(&self, number: u64) -> Option<&Version> {
        self.list.iter().find(|version| version.number == number)
    }

    fn get_mut(&mut self, number: u64) -> Option<&mut Version> {
        self.list.iter_mut().find(|version| version.number == number)
    }

    /// Adds the version that has just come on screen. Generations count from 1 again after another tree was opened or the worker has
    /// started again; the versions before are then dropped.
    pub(super) fn add(&mut self, set: &Arc<PipelineSet>, reload: ReloadEvent, is_draft: bool, again: Option<u64>) {
        if self.list.back().is_some_and(|last| last.number >= set.shaders.generation) {
            self.list.clear();
        }
        let ends_draft = self.list.back().is_some_and(|last| last.is_draft);
        if ends_draft {
            self.list.pop_back();
        }
        // Another watched expression is no version: the texts of the tree are the same.
        let may_be_same = ends_draft || reload.changed.is_empty();
        let is_same = |last: &&mut Version| may_be_same && last.set.shaders.texts == set.shaders.texts;
        if let Some(last) = self.list.back_mut().filter(is_same) {
            (last.number, last.picture, last.set) = (set.shaders.generation, None, set.clone());
            return;
        }
        let (number, since) = (set.shaders.generation, Local::now());
        let (device_ms, thumbnail, picture, is_cut_short) = (None, None, None, false);
        let difference = OnceCell::new();
        let set = set.clone();
        self.list.push_back(Version {
            number,
            since,
            reload,
            device_ms,
            thumbnail,
            set,
            picture,
            is_cut_short,
            is_draft,
            again,
            difference,
        });
        self.list.drain(..self.list.len().saturating_sub(MOST));
    }

    /// Keeps the last picture of a version that a newer one replaces.
    pub(super) fn retire(&mut self, picture: LastComplete) {
        let of = self.get_mut(picture.frame.state.shaders.generation).filter(|version| !version.is_cut_short);
        if let Some(version) = of {
            version.picture = Some(picture);
        }
    }

    /// Takes the set with the stages that were compiled later.
    pub(super) fn complete(&mut self, set: &Arc<PipelineSet>) {
        if let Some(version) = self.get_mut(set.shaders.generation) {
            version.set = set.clone();
        }
    }

    /// Takes the times of a version's first frame. Those of the first frame with another watched expression are not the version's.
    pub(super) fn time(&mut self, number: u64, first_frame_ms: f64, device_ms: Option<f64>) {
        if let Some(version) = self.get_mut(number).filter(|version| version.reload.first_frame_ms == 0.0) {
            (version.reload.first_frame_ms, version.device_ms) = (first_frame_ms, device_ms);
        }
    }

    /// Keeps the newest version although its numbers were dragged: they are in the files now.
    pub(super) fn keep_draft(&mut self) {
        if let Some(last) = self.list.back_mut() {
            last.is_draft = false;
        }
    }

    /// Takes the thumbnail of a version.
    pub(in crate::app) fn set_thumbnail(&mut self, number: u64, thumbnail: egui::TextureHandle) {
        if let Some(version) = self.get_mut(number) {
            version.thumbnail = Some(thumbnail);
        }
    }

    /// Marks a version in which a loop did not end. It is not shown again, since it would keep the device as long again.
    pub(in crate::app) fn cut_short(&mut self, number: u64) {
        if let Some(version) = self.get_mut(number) {
            (version.is_cut_short, version.picture) = (true, None);
        }
    }

    /// Marks a version as good again: a setting had made its loop endless.
    pub(in crate::app) fn loops_end(&mut self, number: u64) {
        if let Some(version) = self.get_mut(number) {
            version.is_cut_short = false;
        }
    }

    /// Whether a version is the one of these shaders: numbers may start again.
    pub(super) fn has(&self, set: &PipelineSet) -> bool {
        self.list.iter().any(|version| Arc::ptr_eq(&version.set.shaders, &set.shaders))
    }

    /// Versions that lack a thumbnail, the newest first.
    pub(super) fn without_thumbnail(&self) -> impl Iterator<Item = &Version> {
        self.list.iter().rev().filter(|version| version.thumbnail.is_none() && !version.is_cut_short)
    }

    /// Whether a version can be shown beside the version `newest`, which is on screen.
    pub(in crate::app) fn can_show(&self, version: &Version, newest: u64) -> bool {
        version.number < newest && !version.is_cut_short
    }

    /// The shaders before those of the version `newest`.
    pub(super) fn shaders_before(&self, newest: u64) -> Option<Arc<ShaderSet>> {
        self.list.iter().rev().find(|version| version.number < newest).map(|version| version.set.shaders.clone())
    }

    /// The pipelines of the version before `newest`.
    pub(super) fn set_before(&self, newest: u64) -> Option<&Arc<PipelineSet>> {
        self.list.iter().rev().find(|version| version.number < newest).map(|version| &version.set)
    }

    /// The newest version before `newest` that can be shown.
    pub(super) fn before(&self, newest: u64) -> Option<&Version> {
        self.list.iter().rev().find(|version| self.can_show(version, newest))
    }

    /// The version that a version was made from, and the lines in which their texts differ.
    pub(in crate::app) fn difference<'a>(&'a self, version: &'a Version) -> &'a [Line] {
        let before = self.list.iter().rev().find(|other| other.number < version.number);
        version.difference.get_or_init(|| {
            before.map(|before| difference(&before.set.shaders.texts, &version.set.shaders.texts)).unwrap_or_default()
        })
    }

    /// Releases the pictures, which hold the model and its light on the device.
    pub(super) fn drop_pictures(&mut self) {
        self.list.iter_mut().for_each(|version| version.picture = None);
    }

    /// Drops all versions but the newest, while memory is short.
    pub(super) fn drop_old(&mut self) {
        self.list.drain(..self.list.len().saturating_sub(1));
    }
}
