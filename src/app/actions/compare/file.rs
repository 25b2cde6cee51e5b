//! Compares with a picture from a file. It is read and scaled on threads, and follows the file.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::switch::{REPLACED, compare};
use crate::app::actions::watch::watch_files;
use crate::app::engine::Engine;
use crate::app::engine::compared::{Compared, ScaledPicture};
use crate::app::state::State;
use crate::app::state::compare::file::PictureFile;
use crate::app::state::compare::{Opening, With};
use crate::picture_difference::{Picture, Still};
use crate::threads::Message;

/// Reads a picture on a thread, and then compares with it.
pub(in crate::app) fn open_picture(state: &mut State, engine: &mut Engine, path: &Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let number = state.compare.next_number();
    state.waiting.comparison_failed(REPLACED);
    (state.compare.opening, engine.opening_tree) = (Some(Opening::File(number, path.clone())), None);
    // Watch the file before reading it, so that no save is missed in between.
    watch_files(state, engine);
    engine.threads.wait(move || Some(Message::PictureRead(number, Picture::open(&path).map(Arc::new))));
}

/// Accepts a picture that was read.
pub(in crate::app) fn on_picture_read(
    state: &mut State,
    engine: &mut Engine,
    number: u64,
    read: Result<Arc<Picture>, String>,
) {
    let path = match &state.compare.opening {
        Some(Opening::File(opening, path)) if *opening == number => path.clone(),
        _ => return,
    };
    state.compare.opening = None;
    match (read, &mut state.compare.with, &mut engine.compared) {
        (Ok(picture), Some(With::File(file)), Compared::File(scaled)) if file.path == path => {
            // The previous one stays on screen until this one is scaled.
            (file.size, file.is_light) = of(&picture);
            (scaled.picture, scaled.number) = (picture, number);
        }
        (Ok(picture), ..) => {
            let (size, is_light) = of(&picture);
            let file = PictureFile { path, size, is_light, placed: None };
            let scaled = ScaledPicture { picture, number, still: None, scaled: None, scaling: None };
            compare(state, engine, Some((With::File(file), Compared::File(scaled))));
        }
        (Err(message), with, _) => {
            let stays = if with.is_some() { ". The comparison stays as it is" } else { "" };
            state.waiting.comparison_failed(&message);
            state.say(format!("{message}{stays}"));
        }
    }
    watch_files(state, engine);
}

/// The size of a picture, and whether it is light.
fn of(picture: &Picture) -> ((u32, u32), bool) {
    (picture.size(), matches!(picture, Picture::Raw(_)))
}

/// Reads the compared picture again if its file has changed.
pub(in crate::app) fn on_picture_changed(state: &mut State, engine: &mut Engine, changed: &BTreeSet<PathBuf>) {
    let path = state.compare.files().find(|path| changed.contains(*path)).cloned();
    if let Some(path) = path {
        open_picture(state, engine, &path);
    }
}

/// Accepts a picture that was scaled.
pub(in crate::app) fn on_picture_fits(
    state: &mut State,
    engine: &mut Engine,
    number: u64,
    still: Result<Arc<Still>, String>,
) {
    let (Some(With::File(file)), Compared::File(scaled)) = (&mut state.compare.with, &mut engine.compared) else {
        return;
    };
    if scaled.scaling.take_if(|scaling| *scaling == number).is_none() {
        return;
    }
    match still {
        Ok(still) => {
            file.placed = Some((still.covered, still.size()));
            scaled.still = Some((state.compare.next_number(), still));
        }
        Err(message) => {
            state.waiting.comparison_failed(&message);
            state.say(message);
        }
    }
}
