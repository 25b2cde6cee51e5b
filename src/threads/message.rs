//! Messages of the threads to the window, and how they get there.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::JoinHandle;

use crossbeam_channel::{Receiver, Sender};
use winit::event_loop::EventLoopProxy;

use super::results::{BakeMessage, Checked, Loaded, MeasuredCurves, SecondTreeMessage, Traced, WorkerMessage};
use crate::control::Asked;
use crate::file_kind::Listed;
use crate::frame::{MeasuredKey, TablesKey};
use crate::headless::{CheckedPicture, Prepared, StageCosts};
use crate::learn::Exercise;
use crate::message::{panic_text, warn};
use crate::picture::Look;
use crate::picture_difference::{Comparison, Picture, Still};
use crate::render::PathTracingKey;
use crate::render::tools::Tools;
use crate::scene::BuiltInPictures;
use crate::shader::not_finite::NotFinite;
use crate::shader::trace::{Neighborhood, Trace};
use crate::shader::{Diagnostic, ShaderSet, Source, TreePath};
use crate::statistics::Difference;
use crate::write_back::{NotWritten, TreeFile, Written};

/// The desktop shows no file dialog: no XDG portal answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoDialog;

/// Files of the tree that were written.
pub(crate) struct TextsWritten {
    /// The files.
    pub(crate) files: Vec<PathBuf>,
    /// The step of undo that they are; none if they are an undo themselves.
    pub(crate) step: Option<Written>,
    /// A message for the user.
    pub(crate) told: Option<String>,
}

/// Messages of the threads to the window.
pub(crate) enum Message {
    Worker(WorkerMessage),
    Loaded(Box<Loaded>),
    Bake(BakeMessage),
    /// The diagnostic of a loop that did not end, by the words that name it; `None` if it belongs to older shaders.
    EndlessLoop([u32; 2], Option<Box<Diagnostic>>),
    /// Watched files outside the shader tree have changed.
    FilesChanged(BTreeSet<PathBuf>),
    /// The difference of the two pictures that the window compares, or the reason why there is none.
    Compared(u64, Result<Box<Comparison>, String>),
    /// The picture of a file that the window compares with, or the reason why there is none, by the number of the request.
    PictureRead(u64, Result<Arc<Picture>, String>),
    /// The same picture, scaled to the window's frame.
    PictureFits(u64, Result<Arc<Still>, String>),
    /// A result of the thread of the second shader tree with this number.
    SecondTree(u64, SecondTreeMessage),
    /// The tree of the comparison with this number, or why there is none.
    SecondTreeFound(u64, Result<Source, String>),
    /// The texts of a version of the shaders have been written to its files, or the reason why not.
    VersionWritten(u64, Result<(String, Written), String>),
    /// The files of an exercise have been written, or the reason why not.
    FilesWritten(Result<(String, Written), String>),
    /// A summary of the edits that were written to the shader files with the files, or the reason why none were.
    Written(Result<(String, Written), String>),
    /// A text that was typed into a file of the tree, and the text that the file has now, or the reason why it was not written.
    TypedWritten(TreeFile, Arc<str>, Result<(String, Written), NotWritten>),
    /// Files of the tree have other texts, which a program has sent or an undo brings back, or the reason why not, by the number of the
    /// request.
    TextWritten(u64, Result<TextsWritten, String>),
    /// The curves of a pixel's material.
    Curves(Box<MeasuredCurves>),
    /// The first statement that computes NaN or infinity at the inspected pixel, for the request with this number.
    NotFinite(u64, Box<NotFinite>),
    /// The trace of a file at the pinned pixel, for the request with this number.
    Traced(u64, Box<Traced>),
    /// The same in an older version of the shaders; `None` if that cannot be traced.
    TracedBefore(u64, Option<Box<(Arc<ShaderSet>, Trace)>>),
    /// The values around the pinned pixel, or why there are none, for the request with this number.
    TracedAround(u64, Box<Result<Neighborhood, String>>),
    /// The stages for traces of a file were compiled, after a request of this number; how long it took, in milliseconds.
    TracePrepared(u64, Box<Result<Prepared, String>>, f64),
    /// A trace for another program, for the request with this number.
    GuestTraced(u64, Box<Traced>),
    /// The findings of the checks of the picture, for the request with this number.
    OperationsChecked(u64, Result<Arc<CheckedPicture>, String>),
    /// The costs of the functions of a stage, for the request with this number.
    FunctionsTimed(u64, Result<Arc<StageCosts>, String>),
    /// By how much an older version of the shaders is slower, for the request with this number.
    VersionTimed(u64, Result<Difference, String>),
    /// The text of a file of the tree as it was saved.
    SourceText(TreePath, Arc<str>),
    /// The settings of a look file, or the reason why it cannot be used.
    Look(Result<Box<Look>, String>),
    /// The pictures of the built-in models and environments.
    Pictures(Box<BuiltInPictures>),
    /// A message for the user.
    Say(String),
    /// The file dialog has closed: the chosen path, none if the user cancels it, or there is no dialog.
    Chosen(Result<Vec<PathBuf>, NoDialog>),
    /// A folder with the built-in shaders has been written, or a message.
    NewTree(Result<PathBuf, String>),
    /// The files of a folder, or why it cannot be read.
    Listed(PathBuf, Result<Vec<Listed>, String>),
    /// The tree of an exercise has been written to this folder, or a message.
    Prepared(Arc<Exercise>, Result<PathBuf, String>),
    /// The exercise whose tree is in this folder.
    Exercise(PathBuf, Option<Arc<Exercise>>),
    /// The goals of an exercise were measured.
    Checked(Checked),
    /// A command from outside.
    Asked(Box<Asked>),
    /// A request of a screen reader, or its arrival or end.
    Accessibility(egui_winit::accesskit_winit::Event),
    /// Pictures that are done, and of how many, of the capture with this number.
    Captures(u64, u64, u64),
    /// The capture with this number has ended.
    Captured(u64),
    /// The pipelines of outlines and pictures of textures, or why there are none.
    Tools(Result<Arc<Tools>, String>),
    /// A thread has panicked, with this message.
    Panicked(TaskKind, String),
}

impl From<egui_winit::accesskit_winit::Event> for Message {
    fn from(event: egui_winit::accesskit_winit::Event) -> Self {
        Self::Accessibility(event)
    }
}

/// The work of a thread, with its number or key.
#[derive(Clone)]
pub(crate) enum TaskKind {
    Worker,
    Loader(u64),
    Baker(u64),
    Tables(Arc<TablesKey>),
    PathTracing(PathTracingKey),
    MeasuredBrdf(MeasuredKey),
    LoopDiagnosis([u32; 2]),
    Checker,
    /// Measures the BRDF.
    Measurer,
    /// Looks for the statement that makes NaN.
    Finder,
    /// Traces the statements of a pixel.
    PixelTracer,
    /// The same for other programs.
    GuestTracer,
    /// Checks assertions and operations of the picture.
    OperationChecker,
    /// Measures times of the picture.
    Timekeeper,
    Capture(u64),
    /// Compiles and bakes for the second shader tree with this number.
    SecondTree(u64),
    /// Scales the picture of a file.
    ImageScaling(u64),
    /// Makes the pipelines of outlines and pictures of textures.
    ToolPipelines,
    /// Writes texts to files of the shader tree.
    Writer,
    /// Waits for what is outside of Specula, or compares pictures.
    External,
}

impl TaskKind {
    /// The name of the thread, for people.
    pub(crate) fn thread(&self) -> &'static str {
        match self {
            Self::Worker => "worker",
            Self::Loader(_) => "loader",
            Self::Baker(_) | Self::Tables(_) => "baker",
            Self::PathTracing(_) => "tracer",
            Self::MeasuredBrdf(_) => "reader",
            Self::LoopDiagnosis(_) => "explainer",
            Self::Checker => "checking",
            Self::Measurer => "measuring",
            Self::Finder => "finding",
            Self::PixelTracer => "pixel tracer",
            Self::GuestTracer => "guest tracer",
            Self::OperationChecker => "operation checker",
            Self::Timekeeper => "timekeeper",
            Self::Capture(_) => "capturing",
            Self::SecondTree(_) => "second tree",
            Self::ImageScaling(_) => "scaling",
            Self::ToolPipelines => "toolmaker",
            Self::Writer => "writing",
            Self::External => "waiting",
        }
    }
}

/// Sends messages to the window, or to the loop of a session without one, and wakes it. After its end, messages are dropped.
#[derive(Clone)]
pub(crate) enum MessageSender {
    Window(EventLoopProxy<Message>),
    Loop(Sender<Message>),
}

impl MessageSender {
    pub(crate) fn send(&self, message: Message) {
        // Fails only after the end.
        match self {
            Self::Window(proxy) => drop(proxy.send_event(message)),
            Self::Loop(sender) => drop(sender.send(message)),
        }
    }

    /// Sends the commands from outside, on a thread that lasts as long as the process.
    pub(crate) fn pass_on(&self, asked: Receiver<Asked>) {
        let sender = self.clone();
        let work = move || asked.iter().for_each(|asked| sender.send(Message::Asked(Box::new(asked))));
        if let Err(error) = std::thread::Builder::new().name("specula-asked".to_owned()).spawn(work) {
            warn(format_args!("no command from outside is carried out: {error}"));
        }
    }

    /// Runs `body` on a new thread. If it panics, or the system has no more threads, the window receives a message.
    pub(super) fn spawn(&self, task: TaskKind, body: impl FnOnce(&Self) + Send + 'static) -> Option<JoinHandle<()>> {
        let (sender, its_task) = (self.clone(), task.clone());
        let thread = std::thread::Builder::new().spawn(move || sender.guarded(its_task, body));
        thread.map_err(|error| self.send(Message::Panicked(task, error.to_string()))).ok()
    }

    /// Runs `body`. If it panics, the window receives a message.
    pub(super) fn guarded(&self, task: TaskKind, body: impl FnOnce(&Self)) {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| body(self))) {
            self.send(Message::Panicked(task, panic_text(&*panic).to_owned()));
        }
    }
}
