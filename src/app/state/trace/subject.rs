//! The pixel, stage and frame of a trace.

use crate::app::state::picture_subject::PictureSubject;
use crate::shader::TreePath;

/// A pixel of a picture, and the file whose statements are traced. Equal ones give equal traces.
#[derive(Clone, PartialEq)]
pub(in crate::app) struct Subject {
    pub(in crate::app) picture: PictureSubject,
    /// Pixels from the upper left corner.
    pub(in crate::app) at: [u32; 2],
    /// `None`: the first that has the file, or that of the picture.
    pub(in crate::app) stage: Option<String>,
    /// `None`: that of the stage.
    pub(in crate::app) file: Option<TreePath>,
}

impl Subject {
    /// Whether both are of the same pixel of the same picture, drawn by any version of the shaders.
    pub(in crate::app) fn is_same_but_version(&self, other: &Self) -> bool {
        let place = |of: &Self| (of.at, of.stage.clone(), of.file.clone());
        place(self) == place(other) && self.picture.is_same_but_version(&other.picture)
    }
}
