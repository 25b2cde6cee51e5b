//! A picture from a file, as a comparison shows it.

use std::path::PathBuf;

use crate::gpu::Rect;

/// A picture from a file.
pub(in crate::app) struct PictureFile {
    pub(in crate::app) path: PathBuf,
    /// The size of the file's picture, pixels.
    pub(in crate::app) size: (u32, u32),
    /// Whether it holds light, and not colors of a display.
    pub(in crate::app) is_light: bool,
    /// Where it lies in the view, and the size of the view; `None` until it is scaled.
    pub(in crate::app) placed: Option<(Rect, (u32, u32))>,
}

impl PictureFile {
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
        let (covered, _) = self.placed?;
        Some((covered.width, covered.height)).filter(|size| *size != self.size)
    }

    /// How it is adapted for display, in sentences; empty if it is shown unchanged.
    pub(in crate::app) fn note(&self) -> String {
        let (width, height) = self.size;
        let scaled = self.scaled_size().map(|(to_width, to_height)| {
            format!(
                "The file has {width} x {height} pixels, scaled to {to_width} x {to_height} in the middle of the picture. FLIP is \
                 measured where the scaled picture covers this one."
            )
        });
        let light = self.is_light.then(|| "Shown with the exposure and tone map of the picture.".to_owned());
        scaled.into_iter().chain(light).collect::<Vec<_>>().join(" ")
    }
}
