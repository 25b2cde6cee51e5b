//! The pipelines of the versions of the shaders, and the pictures that they had last.
//!
//! When shaders of a new generation come on screen, the window keeps the previous ones as a version: their
//! `PipelineSet` and the last frame that they rendered. A version can be rendered again with the current settings:
//! `Resources::bind_older` binds the settings to the version's own pipelines, which the worker builds if they are
//! missing, and to the light of the version's last frame, because light baked by newer shaders would not be the
//! version's. Where that light does not fit (another environment was chosen since), the last frame itself is shown. A
//! version in which a loop did not end is not rendered again. When memory runs out, versions are dropped first.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::last_complete::LastComplete;
use crate::app::state::shaders::versions::Versions;
use crate::pipeline::PipelineSet;

/// The pipelines of a version, and its last picture.
struct Generation {
    set: Arc<PipelineSet>,
    /// Its last good frame. `None` while it is the newest version, and after the model has changed.
    picture: Option<LastComplete>,
}

/// The pipelines and the last pictures, by the generations of the versions.
#[derive(Default)]
pub(in crate::app) struct Generations(BTreeMap<u64, Generation>);

impl Generations {
    /// The pipelines of a version.
    pub(in crate::app) fn set(&self, generation: u64) -> Option<&Arc<PipelineSet>> {
        self.0.get(&generation).map(|generation| &generation.set)
    }

    /// The last picture of a version.
    pub(in crate::app) fn picture(&self, generation: u64) -> Option<&LastComplete> {
        self.0.get(&generation)?.picture.as_ref()
    }

    /// Takes the pipelines of the newest version, and drops those of versions that are no longer kept.
    pub(in crate::app) fn add(&mut self, set: &Arc<PipelineSet>, versions: &Versions) {
        self.0.insert(set.shaders.generation, Generation { set: set.clone(), picture: None });
        self.keep(versions);
    }

    /// Accepts the set with the stages that were compiled later.
    pub(in crate::app) fn complete(&mut self, set: &Arc<PipelineSet>) {
        if let Some(generation) = self.0.get_mut(&set.shaders.generation) {
            generation.set = set.clone();
        }
    }

    /// Keeps the last frame of a version that a newer one replaces, and of its pipelines those of that frame.
    pub(in crate::app) fn retire(&mut self, picture: LastComplete) {
        if let Some(generation) = self.0.get_mut(&picture.frame.state.shaders.generation) {
            generation.set.keep(&picture.frame.state.pipelines);
            generation.picture = Some(picture);
        }
    }

    /// Releases the picture of a version.
    pub(in crate::app) fn drop_picture(&mut self, number: u64) {
        if let Some(generation) = self.0.get_mut(&number) {
            generation.picture = None;
        }
    }

    /// Releases the frames, which hold the model and its light on the device.
    pub(in crate::app) fn drop_pictures(&mut self) {
        self.0.values_mut().for_each(|generation| generation.picture = None);
    }

    /// Drops what belongs to versions that are no longer kept.
    pub(in crate::app) fn keep(&mut self, versions: &Versions) {
        self.0.retain(|generation, _| versions.keeps(*generation));
    }
}
