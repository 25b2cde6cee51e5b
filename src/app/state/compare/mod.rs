//! The picture that the user compares with: that of an older version of the shaders, one that was kept, that of a second shader tree, or
//! a picture from a file. The engine has what draws it, see `crate::app::engine::compared`.

pub(in crate::app) mod file;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::RgbImage;

use super::picture::ShownPicture;
use crate::gpu::Rect;
use file::PictureFile;

/// The other picture, and how much of it is shown.
pub(in crate::app) struct Compare {
    pub(in crate::app) with: Option<With>,
    /// The file or tree that is being read or compiled. It replaces `with` once it is ready; after a failure, `with` stays.
    pub(in crate::app) opening: Option<Opening>,
    /// The number of the last request to read, scale or compile.
    pub(in crate::app) number: u64,
    /// Whether the other picture was part of the last frame.
    pub(in crate::app) is_drawn: bool,
    /// Where the border between both pictures is: the part of the width that shows the other one, 0..1.
    pub(in crate::app) wipe: f32,
    /// Whether only the other one is shown (Space).
    pub(in crate::app) is_held: bool,
    /// The number of the measurement that is under way.
    pub(in crate::app) measuring: Option<u64>,
    /// The difference of both.
    pub(in crate::app) difference: Option<Difference>,
    /// Whether the difference map covers the picture.
    pub(in crate::app) shows_map: bool,
}

/// How much both pictures differ.
pub(in crate::app) struct Difference {
    /// Mean FLIP (Andersson et al. 2020), 0..1.
    pub(in crate::app) flip: f64,
    /// Largest difference of a channel of the display, 0..1.
    pub(in crate::app) largest: f64,
    /// FLIP of each pixel in magma colors.
    pub(in crate::app) map: Arc<RgbImage>,
    /// The part of the picture that was measured, as fractions of its size: its upper left and its lower right corner.
    pub(in crate::app) part: [[f32; 2]; 2],
}

/// The other picture.
pub(in crate::app) enum With {
    /// A version of the shaders, by its number.
    Version(u64),
    /// A picture with all its settings, and the number of its version.
    Kept(Box<ShownPicture>, u64),
    /// A picture from a file.
    File(PictureFile),
    /// The picture of another shader tree.
    Tree(Tree),
}

/// Another shader tree.
pub(in crate::app) struct Tree {
    /// Number of the request.
    pub(in crate::app) number: u64,
    pub(in crate::app) name: String,
    /// Whether its files have errors.
    pub(in crate::app) has_errors: bool,
}

impl Tree {
    pub(in crate::app) fn label(&self) -> String {
        match self.has_errors {
            true => format!("{}, before its last edit, which does not compile", self.name),
            false => self.name.clone(),
        }
    }
}

/// The other side of the comparison while it is being opened.
pub(in crate::app) enum Opening {
    /// A file that is being read, and the number of the request.
    File(u64, PathBuf),
    /// A tree that is being compiled.
    Tree(Tree),
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            with: None,
            opening: None,
            number: 0,
            is_drawn: false,
            wipe: 0.5,
            is_held: false,
            measuring: None,
            difference: None,
            shows_map: false,
        }
    }
}

impl Compare {
    /// Whether both pictures are on screen with a border between them.
    pub(in crate::app) fn is_on(&self) -> bool {
        self.with.is_some()
    }

    /// The version that is compared with.
    pub(in crate::app) fn version(&self) -> Option<u64> {
        match self.with {
            Some(With::Version(number)) => Some(number),
            _ => None,
        }
    }

    /// Whether a picture or tree for the comparison is being read or compiled.
    pub(in crate::app) fn is_opening(&self) -> bool {
        self.opening.is_some()
    }

    /// Whether both pictures were part of the last frame.
    pub(in crate::app) fn is_drawn(&self) -> bool {
        self.is_drawn && self.is_on() && !self.is_opening()
    }

    /// Compares with something else.
    pub(in crate::app) fn set(&mut self, with: Option<With>) {
        (self.difference, self.measuring, self.shows_map) = (None, None, false);
        (self.with, self.is_drawn) = (with, false);
    }

    /// Ends the comparison, but not the numbers of its requests, whose answers may still come.
    pub(in crate::app) fn end(&mut self) {
        *self = Self { number: self.number, ..Self::default() };
    }

    /// A number for the next request.
    pub(in crate::app) fn next_number(&mut self) -> u64 {
        self.number += 1;
        self.number
    }

    /// How a picture from a file is adapted for display, if at all.
    pub(in crate::app) fn note(&self) -> Option<String> {
        match &self.with {
            Some(With::File(file)) => Some(file.note()).filter(|note| !note.is_empty()),
            _ => None,
        }
    }

    /// The file that is compared with, or that is being read for it.
    pub(in crate::app) fn files(&self) -> impl Iterator<Item = &PathBuf> + Clone {
        let opening = match &self.opening {
            Some(Opening::File(_, path)) => Some(path),
            _ => None,
        };
        opening.into_iter().chain(self.file())
    }

    /// The file that is compared with.
    pub(in crate::app) fn file(&self) -> Option<&PathBuf> {
        match &self.with {
            Some(With::File(file)) => Some(&file.path),
            _ => None,
        }
    }

    /// Whether a file that is dropped on the window becomes the other picture: a PNG or JPEG while pictures are compared, and
    /// light while a picture from a file is. Otherwise such files are a look and an environment.
    pub(in crate::app) fn takes(&self, path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "png" | "jpg" | "jpeg" => self.is_on(),
            "hdr" | "exr" => self.file().is_some(),
            _ => false,
        }
    }

    /// The part of the picture that is measured, as fractions of its size.
    pub(in crate::app) fn measured_part(&self) -> [[f32; 2]; 2] {
        let Some(With::File(PictureFile { placed: Some((covered, size)), .. })) = &self.with else {
            return [[0.0; 2], [1.0; 2]];
        };
        let Rect { x, y, width, height } = *covered;
        let at = |x: u32, y: u32| [x as f32 / size.0.max(1) as f32, y as f32 / size.1.max(1) as f32];
        [at(x, y), at(x + width, y + height)]
    }

    /// The name of the second tree.
    pub(in crate::app) fn tree_name(&self) -> Option<&str> {
        match &self.with {
            Some(With::Tree(tree)) => Some(&tree.name),
            _ => None,
        }
    }
}
