//! The reasons for which a picture is not complete yet.

use crate::render::Missing;

/// A reason for which the picture is not complete yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Waits {
    /// Pipelines. Until then, the last frame stays.
    Pipelines,
    /// The light of the environment or the BRDF tables. Until then, the picture has the previous light.
    Light {
        /// Whether the shaders have changed, and not the environment.
        of_edit: bool,
    },
}

impl Waits {
    /// The reason of a state that lacks these resources.
    pub(in crate::app) fn of(missing: &Missing, of_edit: bool) -> Option<Self> {
        match missing {
            missing if missing.pipelines => Some(Self::Pipelines),
            missing if missing.tables.is_some() || missing.environment.is_some() => Some(Self::Light { of_edit }),
            _ => None,
        }
    }
}
