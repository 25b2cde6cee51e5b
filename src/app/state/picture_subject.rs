//! A picture that is drawn again on a thread: traced or checked.

use std::sync::Arc;

use crate::frame::{Clock, Revisions};
use crate::identity::Identity;
use crate::settings::Settings;
use crate::shader::ShaderSet;

/// Everything that a picture depends on. Equal ones look the same.
#[derive(Clone)]
pub(in crate::app) struct PictureSubject {
    pub(in crate::app) size: (u32, u32),
    pub(in crate::app) settings: Arc<Settings>,
    pub(in crate::app) shaders: Arc<ShaderSet>,
    pub(in crate::app) revisions: Revisions,
    pub(in crate::app) model: Identity,
    /// The light on the device.
    pub(in crate::app) light: Identity,
    /// The time of the picture.
    pub(in crate::app) clock: Clock,
}

impl PictureSubject {
    /// Whether the shaders of both have the same texts, so that they are one version.
    pub(in crate::app) fn has_same_texts(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shaders, &other.shaders) || self.shaders.texts == other.shaders.texts
    }

    /// Whether both are the same picture, drawn by any version of the shaders. A version has a light of its own.
    pub(in crate::app) fn is_same_but_version(&self, other: &Self) -> bool {
        let parts = |of: &Self| (of.size, of.model.clone(), of.clock.time_s.to_bits());
        parts(self) == parts(other) && self.settings == other.settings
    }
}

impl PartialEq for PictureSubject {
    fn eq(&self, other: &Self) -> bool {
        let light = |of: &Self| (of.light.clone(), of.revisions);
        let is_same_set = Arc::ptr_eq(&self.shaders, &other.shaders);
        is_same_set && light(self) == light(other) && self.is_same_but_version(other)
    }
}
