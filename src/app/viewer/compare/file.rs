//! Compares with a picture from a file. It is read and scaled on threads, and follows the file.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{Compare, Opening, REPLACED, With};
use crate::app::viewer::Viewer;
use crate::comparison::{Picture, Still};
use crate::gpu::Rect;
use crate::threads::Message;

/// A picture from a file.
pub(super) struct PictureFile {
    path: PathBuf,
    picture: Arc<Picture>,
    /// The number of the request that has read it.
    number: u64,
    /// The newest scaled picture, with the number of the request that made it.
    still: Option<(u64, Arc<Still>)>,
    /// [`Self::number`] and the size that `still` was made of, or that a failed scaling asked for.
    scaled: Option<(u64, (u32, u32))>,
    /// The number of the scaling that is under way.
    scaling: Option<u64>,
}

impl PictureFile {
    fn new(number: u64, path: PathBuf, picture: Arc<Picture>) -> Self {
        Self { path, picture, number, still: None, scaled: None, scaling: None }
    }

    /// The file's name, and its size in pixels if it is scaled.
    pub(super) fn label(&self) -> String {
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

    /// How it is shown, in sentences; empty for one that is shown as it is.
    fn note(&self) -> String {
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

impl Compare {
    /// How a picture from a file is shown, if not as it is.
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

    /// Whether a file that is dropped on the window becomes the other picture: a PNG or JPEG while pictures are compared, and light
    /// while a picture from a file is. Otherwise such files are a look and an environment.
    pub(in crate::app) fn takes(&self, path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "png" | "jpg" | "jpeg" => self.is_on(),
            "hdr" | "exr" => self.file().is_some(),
            _ => false,
        }
    }

    /// The part of the picture that is measured, as fractions of its size.
    pub(super) fn measured_part(&self) -> egui::Rect {
        let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        let Some(With::File(PictureFile { still: Some((_, still)), .. })) = &self.with else { return whole };
        let (Rect { x, y, width, height }, size) = (still.covered, still.size());
        let at = |x: u32, y: u32| egui::pos2(x as f32 / size.0.max(1) as f32, y as f32 / size.1.max(1) as f32);
        egui::Rect::from_min_max(at(x, y), at(x + width, y + height))
    }
}

impl Viewer {
    /// Reads a picture on a thread, and then compares with it.
    pub(super) fn open_picture(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let number = self.compare.next_number();
        self.comparison_failed(REPLACED);
        self.compare.opening = Some(Opening::File(number, path.clone()));
        // Watch the file before reading it, so that no save is missed in between.
        self.watch_files();
        self.threads.wait(move || Some(Message::PictureRead(number, Picture::open(&path).map(Arc::new))));
    }

    /// Takes a picture that was read.
    pub(in crate::app::viewer) fn on_picture_read(&mut self, number: u64, read: Result<Arc<Picture>, String>) {
        let path = match &self.compare.opening {
            Some(Opening::File(opening, path)) if *opening == number => path.clone(),
            _ => return,
        };
        self.compare.opening = None;
        match (read, &mut self.compare.with) {
            (Ok(picture), Some(With::File(file))) if file.path == path => {
                // The old one stays on screen until this one is scaled.
                (file.picture, file.number) = (picture, number);
            }
            (Ok(picture), _) => self.compare.set(Some(With::File(PictureFile::new(number, path, picture)))),
            (Err(message), with) => {
                let stays = if with.is_some() { ". The comparison stays as it is" } else { "" };
                self.comparison_failed(&message);
                self.say(format!("{message}{stays}"));
            }
        }
        self.watch_files();
    }

    /// Reads the compared picture again if its file has changed.
    pub(in crate::app::viewer) fn on_picture_changed(&mut self, changed: &BTreeSet<PathBuf>) {
        let path = self.compare.files().find(|path| changed.contains(*path)).cloned();
        if let Some(path) = path {
            self.open_picture(&path);
        }
    }

    /// The compared picture at a size. `None` until it is scaled.
    pub(super) fn picture_that_fits(&mut self, size: (u32, u32)) -> Option<(u64, Arc<Still>)> {
        let Some(With::File(file)) = &mut self.compare.with else { return None };
        let wanted = (file.number, size);
        // One at a time, however fast the window changes its size.
        if file.scaled != Some(wanted) && file.scaling.is_none() {
            let picture = file.picture.clone();
            (file.scaled, file.scaling) = (Some(wanted), Some(file.number));
            self.threads.scale(file.number, picture, size);
        }
        file.still.clone().filter(|(_, still)| still.size() == size)
    }

    /// Takes a picture that was scaled.
    pub(in crate::app::viewer) fn on_picture_fits(&mut self, number: u64, still: Result<Arc<Still>, String>) {
        let next = self.compare.number + 1;
        let Some(With::File(file)) = &mut self.compare.with else { return };
        if file.scaling.take_if(|scaling| *scaling == number).is_none() {
            return;
        }
        match still {
            Ok(still) => {
                file.still = Some((next, still));
                self.compare.number = next;
            }
            Err(message) => {
                self.comparison_failed(&message);
                self.say(message);
            }
        }
    }
}
