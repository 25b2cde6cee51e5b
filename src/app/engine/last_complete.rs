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

/// Half floats with the samples of the settings, or 1 if the device does not support them. With `full`, floats as those of a picture that a
/// command renders: a session without a window writes its pictures to files.
pub(in crate::app) fn target(gpu: &Gpu, settings: &Settings, full: bool) -> TargetFormat {
    let single = if full { TargetFormat::full(1) } else { TargetFormat::half(1) };
    View::target_format(gpu, settings.view.msaa, full).unwrap_or(single)
}
