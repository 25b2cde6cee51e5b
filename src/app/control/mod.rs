//! Carries out commands from outside, and of the panel Capture. A command that changes the picture is answered when the picture is final
//! ([`Viewer::is_settled`]), one that writes a file when the file is written.

mod captures;
mod compare;
mod files;
mod numbers;
mod requests;

use std::path::PathBuf;

use serde_json::{Value, json};

use super::viewer::Viewer;
use crate::control::{Asked, Reply, Request};
use crate::shader::Diagnostic;
pub(super) use captures::{Captures, Job};
use requests::short;

/// Commands that are not done yet, and captures that are under way.
#[derive(Default)]
pub(super) struct Controlled {
    waiting: Vec<(Reply, Until)>,
    pub(super) captures: Captures,
}

/// Condition that a command waits for.
pub(super) enum Until {
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

/// Immediate outcome of a command.
pub(super) enum Next {
    Done(Value),
    Wait(Until),
}

/// A picture of the screen that is asked for, and where it goes.
pub(super) struct Shot {
    pub(super) reply: Reply,
    pub(super) file: Option<PathBuf>,
}

impl Viewer {
    /// Takes a command from outside.
    pub(super) fn on_asked(&mut self, asked: Asked) {
        self.carry_out(asked.request, asked.reply);
    }

    /// Carries out a command of the window itself, and shows its result as a message.
    pub(super) fn ask_self(&mut self, request: Request) {
        let sender = self.threads.sender();
        let reply = Reply::to_window(move |result| {
            let text = match result {
                Ok(result) => result["file"].as_str().map(|file| format!("wrote {file}")),
                Err(message) => Some(message),
            };
            text.into_iter().for_each(|text| sender.send(crate::threads::Message::Say(text)));
        });
        self.carry_out(request, reply);
    }

    fn carry_out(&mut self, request: Request, reply: Reply) {
        match self.request(request) {
            Ok(Next::Done(result)) => reply.done(result),
            Ok(Next::Wait(until)) => self.controlled.waiting.push((reply, until)),
            Err(message) => reply.error(message),
        }
        self.watch_files();
    }

    /// Answers the commands that the last frame has done.
    pub(super) fn answer(&mut self) {
        if self.controlled.waiting.is_empty() {
            return;
        }
        let settled = self.is_settled();
        for (reply, until) in std::mem::take(&mut self.controlled.waiting) {
            match until {
                Until::Shown if settled => reply.done(Value::Null),
                Until::Camera if settled => reply.done(self.camera_json()),
                Until::Grid if settled => reply.done(json!({ "modes": self.grid.modes() })),
                Until::Compared if settled && self.compare.is_drawn() => reply.done(self.compare_json()),
                Until::Picture(job) if settled => self.begin_capture(reply, job),
                Until::Reloaded if settled || (self.has_errors() && !self.threads.worker.is_compiling()) => {
                    self.reloaded(reply);
                }
                Until::Model(path) if !self.model.loading => match self.model.is_file(&path) {
                    true => self.controlled.waiting.push((reply, Until::Shown)),
                    false => reply.error(format!("{} was not loaded", path.display())),
                },
                Until::Shown
                | Until::Camera
                | Until::Grid
                | Until::Picture(_)
                | Until::Screen(_)
                | Until::Window(_)
                    if self.never_shows() =>
                {
                    self.without_picture(reply);
                }
                until => self.controlled.waiting.push((reply, until)),
            }
        }
    }

    /// Whether another frame must follow, because a command waits for nothing else. Messages wake the window for all others.
    pub(super) fn has_unanswered(&self) -> bool {
        let waits_for_frame = |until: &Until| {
            matches!(until, Until::Shown | Until::Camera | Until::Grid | Until::Screen(_) | Until::Window(_))
        };
        self.is_settled() && self.controlled.waiting.iter().any(|(_, until)| waits_for_frame(until))
    }

    /// Answers the commands that wait for a picture which cannot come.
    pub(super) fn fail_waiting(&mut self, message: &str) {
        for (reply, until) in std::mem::take(&mut self.controlled.waiting) {
            match until {
                Until::Look | Until::Model(_) | Until::Reloaded | Until::Written(_) | Until::EditsWritten(_) => {
                    self.controlled.waiting.push((reply, until))
                }
                _ => reply.error(message),
            }
        }
    }

    /// Answers those who wait for a model that cannot be loaded.
    pub(super) fn model_failed(&mut self, message: &str) {
        self.end_waiting(|until| matches!(until, Until::Model(_)), message);
    }

    /// Answers those who wait for a look file, or lets them wait for its model or its frame.
    pub(super) fn look_read(&mut self, result: Result<Option<PathBuf>, String>) {
        match result {
            Ok(model) => {
                for (_, until) in &mut self.controlled.waiting {
                    if matches!(until, Until::Look) {
                        *until = model.clone().map_or(Until::Shown, Until::Model);
                    }
                }
            }
            Err(message) => self.end_waiting(|until| matches!(until, Until::Look), &message),
        }
    }

    /// Answers those who wait for a comparison that does not come.
    pub(super) fn comparison_failed(&mut self, message: &str) {
        self.end_waiting(|until| matches!(until, Until::Compared), message);
    }

    /// Answers those who wait for the files of a version. `error` is why they were not written.
    pub(super) fn answer_written(&mut self, number: u64, error: Option<&str>) {
        for (reply, until) in std::mem::take(&mut self.controlled.waiting) {
            match (until, error) {
                (Until::Written(of), Some(error)) if of == number => reply.error(error),
                (Until::Written(of), None) if of == number => reply.done(Value::Null),
                (until, _) => self.controlled.waiting.push((reply, until)),
            }
        }
    }

    /// Answers those who wait for edits in the files.
    pub(super) fn answer_edits(&mut self, result: Result<(), &str>) {
        for (reply, until) in std::mem::take(&mut self.controlled.waiting) {
            match (until, result) {
                (Until::EditsWritten(edits), Ok(())) => reply.done(json!({ "edits": edits })),
                (Until::EditsWritten(_), Err(error)) => reply.error(error),
                (until, _) => self.controlled.waiting.push((reply, until)),
            }
        }
    }

    /// Cancels everything that takes long.
    pub(super) fn cancel_captures(&mut self) {
        self.end_waiting(|until| matches!(until, Until::Picture(_) | Until::Screen(_) | Until::Window(_)), "canceled");
        self.controlled.captures.cancel();
    }

    /// Answers all commands that wait: the device is lost.
    pub(in crate::app) fn end_all_waiting(&mut self) {
        self.end_waiting(|_| true, "the graphics device was lost");
    }

    fn end_waiting(&mut self, is: impl Fn(&Until) -> bool, message: &str) {
        for (reply, until) in std::mem::take(&mut self.controlled.waiting) {
            if is(&until) { reply.error(message) } else { self.controlled.waiting.push((reply, until)) }
        }
    }

    /// The pictures of the screen that can be taken now: its frame is final.
    pub(super) fn take_shots(&mut self) -> Vec<Shot> {
        let is_wanted = |until: &Until| matches!(until, Until::Screen(_));
        std::iter::from_fn(|| self.take_shot(is_wanted)).collect()
    }

    /// The picture of the window that can be taken now.
    pub(super) fn take_window_shot(&mut self) -> Option<Shot> {
        self.take_shot(|until| matches!(until, Until::Window(_)))
    }

    fn take_shot(&mut self, is: impl Fn(&Until) -> bool) -> Option<Shot> {
        let waiting = &mut self.controlled.waiting;
        let at = waiting.iter().position(|(_, until)| is(until))?;
        if !self.is_settled() {
            return None;
        }
        match self.controlled.waiting.remove(at) {
            (reply, Until::Screen(file) | Until::Window(file)) => Some(Shot { reply, file }),
            _ => None,
        }
    }

    /// Whether there are no shaders, and an edit is needed before there are.
    fn never_shows(&self) -> bool {
        self.session.shaders.is_none() && !self.threads.worker.is_compiling() && self.has_errors()
    }

    /// Answers a reload.
    fn reloaded(&self, reply: Reply) {
        if self.has_errors() {
            return self.without_picture(reply);
        }
        reply.done(json!({ "generation": self.shown_generation() }));
    }

    /// Answers with the errors of the shaders.
    fn without_picture(&self, reply: Reply) {
        let errors: Vec<&Diagnostic> = self.errors().collect();
        let message = errors.first().map_or_else(|| "there is no picture".to_owned(), |first| first.one_line());
        reply.error_with(message, json!({ "diagnostics": errors }));
    }

    /// The camera of the picture.
    fn camera_json(&self) -> Value {
        self.shown().map_or(Value::Null, |state| {
            let camera = &state.camera;
            let (eye, target) = (short(camera.eye.to_array()), short(camera.target.to_array()));
            json!({ "eye": eye, "target": target, "fovy": short(camera.fovy_rad.to_degrees()) })
        })
    }
}
