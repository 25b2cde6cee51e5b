//! Commands from outside that are not done yet, and what each waits for.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::captures::Job;
use crate::control::Reply;

/// Condition that a command waits for.
pub(in crate::app) enum Until {
    /// The final picture.
    Shown,
    /// The same; the answer tells the camera.
    Camera,
    /// The end of a reload, and then the final picture.
    Reloaded,
    /// The end of loading this model, and then the final picture.
    Model(PathBuf),
    /// A look file that is being read.
    Look,
    /// The other picture of a comparison, and a frame that shows both.
    Compared,
    /// The files of this version of the shaders.
    Written(u64),
    /// The shader files with these edits.
    EditsWritten(Value),
    /// The final picture; the answer tells the modes side by side.
    Grid,
    /// The final picture, to write it.
    Screen(Option<PathBuf>),
    /// The same for a picture of the window.
    Window(Option<PathBuf>),
    /// The same for what a thread draws.
    Picture(Job),
}

/// A picture of the screen that is asked for, and where it goes.
pub(in crate::app) struct Shot {
    pub(in crate::app) reply: Reply,
    pub(in crate::app) file: Option<PathBuf>,
}

/// The commands that are not done yet, in their order. Each is answered once.
#[derive(Default)]
pub(in crate::app) struct Waiting(Vec<(Reply, Until)>);

impl Waiting {
    pub(in crate::app) fn push(&mut self, reply: Reply, until: Until) {
        self.0.push((reply, until));
    }

    pub(in crate::app) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All of them; the caller pushes those again that still wait.
    pub(in crate::app) fn take(&mut self) -> Vec<(Reply, Until)> {
        std::mem::take(&mut self.0)
    }

    /// Whether a command waits for nothing but another frame. Messages wake the window for all others.
    pub(in crate::app) fn needs_frame(&self) -> bool {
        let waits_for_frame = |until: &Until| {
            matches!(until, Until::Shown | Until::Camera | Until::Grid | Until::Screen(_) | Until::Window(_))
        };
        self.0.iter().any(|(_, until)| waits_for_frame(until))
    }

    /// Answers the commands that wait for a picture which cannot come.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        let stays = |until: &Until| {
            matches!(
                until,
                Until::Look | Until::Model(_) | Until::Reloaded | Until::Written(_) | Until::EditsWritten(_)
            )
        };
        self.end(|until| !stays(until), message);
    }

    /// Answers those who wait for a model that cannot be loaded.
    pub(in crate::app) fn model_failed(&mut self, message: &str) {
        self.end(|until| matches!(until, Until::Model(_)), message);
    }

    /// Answers those who wait for a look file, or lets them wait for its model or its frame.
    pub(in crate::app) fn look_read(&mut self, result: Result<Option<PathBuf>, String>) {
        match result {
            Ok(model) => {
                for (_, until) in &mut self.0 {
                    if matches!(until, Until::Look) {
                        *until = model.clone().map_or(Until::Shown, Until::Model);
                    }
                }
            }
            Err(message) => self.end(|until| matches!(until, Until::Look), &message),
        }
    }

    /// Answers those who wait for a comparison that does not come.
    pub(in crate::app) fn comparison_failed(&mut self, message: &str) {
        self.end(|until| matches!(until, Until::Compared), message);
    }

    /// Answers those who wait for the files of a version. `error` is why they were not written.
    pub(in crate::app) fn answer_written(&mut self, number: u64, error: Option<&str>) {
        for (reply, until) in self.take() {
            match (until, error) {
                (Until::Written(of), Some(error)) if of == number => reply.error(error),
                (Until::Written(of), None) if of == number => reply.done(Value::Null),
                (until, _) => self.push(reply, until),
            }
        }
    }

    /// Answers those who wait for edits in the files.
    pub(in crate::app) fn answer_edits(&mut self, result: Result<(), &str>) {
        for (reply, until) in self.take() {
            match (until, result) {
                (Until::EditsWritten(edits), Ok(())) => reply.done(json!({ "edits": edits })),
                (Until::EditsWritten(_), Err(error)) => reply.error(error),
                (until, _) => self.push(reply, until),
            }
        }
    }

    /// Answers those who wait for a picture that is to be written.
    pub(in crate::app) fn cancel_captures(&mut self) {
        self.end(|until| matches!(until, Until::Picture(_) | Until::Screen(_) | Until::Window(_)), "canceled");
    }

    /// Answers all: the device is lost.
    pub(in crate::app) fn end_all(&mut self) {
        self.end(|_| true, "the graphics device was lost");
    }

    fn end(&mut self, is: impl Fn(&Until) -> bool, message: &str) {
        for (reply, until) in self.take() {
            if is(&until) { reply.error(message) } else { self.push(reply, until) }
        }
    }

    /// Removes the first picture of the screen, or of the window, that is asked for.
    pub(in crate::app) fn take_shot(&mut self, of_window: bool) -> Option<Shot> {
        let is = |(_, until): &(Reply, Until)| match until {
            Until::Screen(_) => !of_window,
            Until::Window(_) => of_window,
            _ => false,
        };
        match self.0.remove(self.0.iter().position(is)?) {
            (reply, Until::Screen(file) | Until::Window(file)) => Some(Shot { reply, file }),
            _ => None,
        }
    }
}
