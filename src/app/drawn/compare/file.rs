//! A picture from a file, as a comparison shows it.

use std::path::PathBuf;
use std::sync::Arc;

use crate::comparison::{Picture, Still};

/// A picture from a file.
pub(in crate::app) struct PictureFile {
    pub(in crate::app) path: PathBuf,
    pub(in crate::app) picture: Arc<Picture>,
    /// The number of the request that has read it.
    pub(in crate::app) number: u64,
    /// The newest scaled picture, with the number of the request that made it.
    pub(in crate::app) still: Option<(u64, Arc<Still>)>,
    /// [`Self::number`] and the size for which `still` was made, or for which scaling failed.
    pub(in crate::app) scaled: Option<(u64, (u32, u32))>,
    /// The number of the scaling that is under way.
    pub(in crate::app) scaling: Option<u64>,
}

impl PictureFile {
    pub(in crate::app) fn new(number: u64, path: PathBuf, picture: Arc<Picture>) -> Self {
        Self { path, picture, number, still: None, scaled: None, scaling: None }
    }

    /// The file's name, and its size in pixels if it is scaled.
    pub(in crate::app) fn label(&self) -> String {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        match self.scaled_size() {
            Some((width, height)) => format!("{name}, scaled to {width} x {height}"),
            None => name.into_owned(),
        }
    }

    /// The size that the picture has on screen, if that is not its own.
    fn scaled_size(&self) -> Option<(u32, u32)> {
        let (_, still) = self.still.as_ref()?;
        let size = (still.covered.width, still.covered.height);
        (size != self.picture.size()).then_some(size)
    }

    /// How it is adapted for display, in sentences; empty if it is shown unchanged.
    pub(in crate::app) fn note(&self) -> String {
        let (width, height) = self.picture.size();
        let scaled = self.scaled_size().map(|(to_width, to_height)| {
            format!(
                "The file has {width} x {height} pixels, scaled to {to_width} x {to_height} in the middle of the picture. FLIP is \
                 measured where the scaled picture covers this one."
            )
        });
        let light = matches!(*self.picture, Picture::Raw(_))
            .then(|| "Shown with the exposure and tone map of the picture.".to_owned());
        scaled.into_iter().chain(light).collect::<Vec<_>>().join(" ")
    }
}
