//! Commands that are not done yet, and when each is.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::captures::{Destination, Job};
use crate::control::{Key, Reply};

/// The answer to a command that another one has ended.
pub(in crate::app) const CANCELED: &str = "canceled";

/// Looks for a result in the state of the window.
type Find<S> = Box<dyn Fn(&S) -> Option<Result<Value, String>>>;

/// Work of a thread, which needs nothing of the window.
pub(in crate::app) struct Work {
    /// Whether it uses the device, so that the end of the window waits for it.
    pub(in crate::app) uses_device: bool,
    pub(in crate::app) run: Box<dyn FnOnce() -> Result<Value, String> + Send>,
}

/// When a command is done, and its result, which may depend on the state `S` of the window.
pub(in crate::app) enum Until<S> {
    Now(Value),
    /// With the final picture.
    Settled(fn(&S) -> Value),
    /// After the end of a reload, with the final picture.
    Reloaded,
    /// As [`Until::Reloaded`], once there is found to be a tree at this path.
    Tree(PathBuf),
    /// After the end of loading this model, with the final picture.
    Model(PathBuf),
    /// Once a look file has been read.
    Look,
    /// With the other picture of a comparison and a frame that shows both.
    Compared(fn(&S) -> Value),
    /// Once the files of this version of the shaders are written.
    VersionWritten(u64),
    /// Once the shader files have these edits.
    EditsWritten(Value),
    /// Once this file of the tree has the text that was sent, and its picture is final.
    TextWritten(u64),
    /// Once there is a result, or a reason why there is none.
    Found(Find<S>),
    /// Once a thread has done this.
    Work(Work),
    /// Once the final picture is written as it is on screen.
    Screen(Destination),
    /// Once the final picture is written as a command renders it, at this size and in this mode if they are given.
    Rendered(Destination, Option<(u32, u32)>, Option<String>),
    /// Once the window with its panels is written.
    Window(Option<PathBuf>),
    /// The same for a picture that a thread draws.
    Picture(Job),
    /// Once no thread draws a picture any more.
    CapturesEnded,
    /// Once the window has closed, with all threads that use the device.
    Closed,
}

impl<S> Until<S> {
    /// Done, without a result.
    pub(in crate::app) const DONE: Self = Self::Now(Value::Null);
    /// With the final picture, without a result.
    pub(in crate::app) const SHOWN: Self = Self::Settled(|_| Value::Null);

    pub(in crate::app) fn is_capture(&self) -> bool {
        matches!(self, Self::Screen(_) | Self::Rendered(..) | Self::Window(_) | Self::Picture(_))
    }
}

/// A picture of the screen that is asked for, and where it goes.
pub(in crate::app) struct Shot {
    pub(in crate::app) reply: Reply,
    pub(in crate::app) to: Destination,
    /// The size and the mode, if it is to be the picture that a command renders, even if that on screen is another one.
    pub(in crate::app) rendered: Option<SizeAndMode>,
}

/// The size and the mode of a picture, where a command names them.
type SizeAndMode = (Option<(u32, u32)>, Option<String>);

/// A picture of the window that is asked for, and where it goes.
pub(in crate::app) struct WindowShot {
    pub(in crate::app) reply: Reply,
    pub(in crate::app) file: Option<PathBuf>,
}

/// The commands that are not done yet, in their order. Each is answered once.
pub(in crate::app) struct Waiting<S> {
    list: Vec<(Reply, Until<S>)>,
    /// The capture of the window that the device is copying.
    copying: Option<WindowShot>,
}

impl<S> Default for Waiting<S> {
    fn default() -> Self {
        Self { list: Vec::new(), copying: None }
    }
}

impl<S> Waiting<S> {
    pub(in crate::app) fn push(&mut self, reply: Reply, until: Until<S>) {
        self.list.push((reply, until));
    }

    pub(in crate::app) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// All of them; the caller pushes those again that still wait.
    pub(in crate::app) fn take(&mut self) -> Vec<(Reply, Until<S>)> {
        std::mem::take(&mut self.list)
    }

    /// Whether a command waits for nothing but another frame. Messages wake the window for all others.
    pub(in crate::app) fn needs_frame(&self) -> bool {
        let needs_frame = |until: &Until<S>| {
            matches!(until, Until::Settled(_) | Until::Screen(_) | Until::Rendered(..) | Until::Window(_))
        };
        self.list.iter().any(|(_, until)| needs_frame(until))
    }

    /// Whether a command waits for the final picture.
    pub(in crate::app) fn needs_picture(&self) -> bool {
        let waits = |until: &Until<S>| {
            let waits_for_more =
                matches!(until, Until::Reloaded | Until::Compared(_) | Until::Picture(_) | Until::Found(_));
            let waits = matches!(until, Until::Settled(_) | Until::Screen(_) | Until::Rendered(..) | Until::Window(_));
            waits_for_more || waits
        };
        self.list.iter().any(|(_, until)| waits(until)) || self.copying.is_some()
    }

    /// Answers the commands for which `result` has a result.
    fn answer(&mut self, result: impl Fn(&Until<S>) -> Option<Result<Value, String>>) {
        for (reply, until) in self.take() {
            match result(&until) {
                Some(Ok(result)) => reply.done(result),
                Some(Err(message)) => reply.error(message),
                None => self.push(reply, until),
            }
        }
    }

    fn refuse(&mut self, is: impl Fn(&Until<S>) -> bool, message: &str) {
        self.answer(|until| is(until).then(|| Err(message.to_owned())));
    }

    /// Answers the commands that wait for a picture which cannot come.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        let waits_for_more = |until: &Until<S>| {
            matches!(
                until,
                Until::Look
                    | Until::Model(_)
                    | Until::Reloaded
                    | Until::Tree(_)
                    | Until::VersionWritten(_)
                    | Until::EditsWritten(_)
                    | Until::TextWritten(_)
                    | Until::CapturesEnded
                    | Until::Closed
            )
        };
        self.refuse(|until| !waits_for_more(until), message);
    }

    /// Answers those who wait for a tree that is none, or lets them wait for its picture.
    pub(in crate::app) fn tree_found(&mut self, path: &Path, result: Result<(), &str>) {
        let is_it = |until: &Until<S>| matches!(until, Until::Tree(of) if of == path);
        match result {
            Ok(()) => {
                self.list.iter_mut().filter(|(_, until)| is_it(until)).for_each(|(_, until)| *until = Until::Reloaded);
            }
            Err(message) => self.refuse(is_it, message),
        }
    }

    /// Answers those who wait for a model that cannot be loaded.
    pub(in crate::app) fn model_failed(&mut self, message: &str) {
        self.refuse(|until| matches!(until, Until::Model(_)), message);
    }

    /// Answers those who wait for a look file, or lets them wait for its model or its frame.
    pub(in crate::app) fn look_read(&mut self, result: Result<Option<PathBuf>, String>) {
        let is_look = |until: &Until<S>| matches!(until, Until::Look);
        match result {
            Ok(model) => {
                for (_, until) in self.list.iter_mut().filter(|(_, until)| is_look(until)) {
                    *until = model.clone().map_or(Until::SHOWN, Until::Model);
                }
            }
            Err(message) => self.refuse(is_look, &message),
        }
    }

    /// Answers those who wait for a comparison that does not come.
    pub(in crate::app) fn comparison_failed(&mut self, message: &str) {
        self.refuse(|until| matches!(until, Until::Compared(_)), message);
    }

    /// Answers those who wait for the files of a version. `error` is why they were not written.
    pub(in crate::app) fn answer_written(&mut self, number: u64, error: Option<&str>) {
        let result = error.map_or(Ok(Value::Null), |error| Err(error.to_owned()));
        self.answer(|until| matches!(until, Until::VersionWritten(of) if *of == number).then(|| result.clone()));
    }

    /// Answers those who wait for edits in the files.
    pub(in crate::app) fn answer_edits(&mut self, result: Result<(), &str>) {
        self.answer(|until| match until {
            Until::EditsWritten(edits) => Some(result.map(|()| json!({ "edits": edits })).map_err(str::to_owned)),
            _ => None,
        });
    }

    /// Answers the one who waits for the text of a file, or lets it wait for its picture.
    pub(in crate::app) fn text_written(&mut self, number: u64, result: Result<(), &str>) {
        let is_it = |until: &Until<S>| matches!(until, Until::TextWritten(of) if *of == number);
        match result {
            Ok(()) => {
                self.list.iter_mut().filter(|(_, until)| is_it(until)).for_each(|(_, until)| *until = Until::Reloaded);
            }
            Err(message) => self.refuse(is_it, message),
        }
    }

    /// Answers those who wait for a picture that is to be written.
    pub(in crate::app) fn cancel_captures(&mut self) {
        self.refuse(Until::is_capture, CANCELED);
    }

    /// Answers the command with this identifier that it is canceled. Returns whether it waits.
    pub(in crate::app) fn cancel_of(&mut self, key: &Key) -> bool {
        let found = self.list.iter().position(|(reply, _)| reply.key() == *key);
        found.map(|index| self.list.remove(index).0.error(CANCELED)).is_some()
    }

    /// Answers those who wait for the end of the window.
    pub(in crate::app) fn closed(&mut self) {
        self.answer(|until| matches!(until, Until::Closed).then_some(Ok(Value::Null)));
    }

    /// Answers all: the device is lost.
    pub(in crate::app) fn end_all(&mut self) {
        self.list.extend(self.copying.take().map(|WindowShot { reply, file }| (reply, Until::Window(file))));
        self.refuse(|_| true, "the graphics device was lost");
    }

    /// Removes the first picture of the screen that is asked for.
    pub(in crate::app) fn take_shot(&mut self) -> Option<Shot> {
        match self.take_first(|until| matches!(until, Until::Screen(_) | Until::Rendered(..)))? {
            (reply, Until::Screen(to)) => Some(Shot { reply, to, rendered: None }),
            (reply, Until::Rendered(to, size, mode)) => Some(Shot { reply, to, rendered: Some((size, mode)) }),
            _ => None,
        }
    }

    /// Whether a picture of the window is asked for.
    pub(in crate::app) fn wants_window(&self) -> bool {
        self.list.iter().any(|(_, until)| matches!(until, Until::Window(_)))
    }

    /// The device copies the window for the first picture of it that is asked for, or `error` tells why it cannot.
    pub(in crate::app) fn window_copied(&mut self, error: Option<String>) {
        let Some((reply, Until::Window(file))) = self.take_first(|until| matches!(until, Until::Window(_))) else {
            return;
        };
        match error {
            Some(error) => reply.error(error),
            None => self.copying = Some(WindowShot { reply, file }),
        }
    }

    /// The picture of the window whose copy is done.
    pub(in crate::app) fn take_copied(&mut self) -> Option<WindowShot> {
        self.copying.take()
    }

    fn take_first(&mut self, is: impl Fn(&Until<S>) -> bool) -> Option<(Reply, Until<S>)> {
        let first = self.list.iter().position(|(_, until)| is(until))?;
        Some(self.list.remove(first))
    }
}
