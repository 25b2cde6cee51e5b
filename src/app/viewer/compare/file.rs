//! Compares with a picture from a file. It is read and scaled on threads, and follows the file.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::REPLACED;
use crate::app::drawn::compare::file::PictureFile;
use crate::app::drawn::compare::{Opening, With};
use crate::app::viewer::Viewer;
use crate::comparison::{Picture, Still};
use crate::threads::Message;

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

    /// Accepts a picture that was read.
    pub(in crate::app::viewer) fn on_picture_read(&mut self, number: u64, read: Result<Arc<Picture>, String>) {
        let path = match &self.compare.opening {
            Some(Opening::File(opening, path)) if *opening == number => path.clone(),
            _ => return,
        };
        self.compare.opening = None;
        match (read, &mut self.compare.with) {
            (Ok(picture), Some(With::File(file))) if file.path == path => {
                // The previous one stays on screen until this one is scaled.
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

    /// Accepts a picture that was scaled.
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
