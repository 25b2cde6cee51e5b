//! The last complete picture.

use std::sync::Arc;

use crate::app::state::picture::ShownPicture;
use crate::frame::{Scene, TargetFormat};
use crate::gpu::Gpu;
use crate::render::{BoundFrame, View};
use crate::settings::Settings;

/// The last good frame and its inputs. The window draws it until the next one is complete.
#[derive(Clone)]
pub(in crate::app) struct LastComplete {
    pub(in crate::app) settings: Arc<Settings>,
    pub(in crate::app) frame: BoundFrame,
}

impl LastComplete {
    /// A description of the frame without device objects, for the state.
    pub(in crate::app) fn description(&self) -> ShownPicture {
        ShownPicture {
            state: self.frame.state.clone(),
            settings: self.settings.clone(),
            is_animated: self.frame.is_animated(),
            rests: self.frame.rests(),
            reads_keys: self.frame.reads_keys(),
        }
    }

    /// The model in it.
    pub(in crate::app) fn scene(&self) -> Option<&Scene> {
        self.frame.state.scene.as_ref()
    }
}

/// Half floats with the samples of the settings, or 1 if the device does not support them.
pub(in crate::app) fn target(gpu: &Gpu, settings: &Settings) -> TargetFormat {
    View::target_format(gpu, settings.view.msaa, false).unwrap_or(TargetFormat::half(1))
}
