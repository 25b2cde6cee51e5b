//! What a picture waits for.

use crate::render::Missing;

/// What the picture waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Waits {
    /// Pipelines. Until then, the last frame stays.
    Pipelines,
    /// The light of the environment or the BRDF tables. Until then, the picture has the previous light.
    Light,
}

impl Waits {
    /// What a state with these missing resources waits for.
    pub(in crate::app) fn of(missing: &Missing) -> Option<Self> {
        match missing {
            missing if missing.pipelines => Some(Self::Pipelines),
            missing if missing.tables.is_some() || missing.environment.is_some() => Some(Self::Light),
            _ => None,
        }
    }
}
