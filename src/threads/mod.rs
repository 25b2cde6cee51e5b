//! The background threads. Each sends its results to the window's thread, which alone changes what is on screen.
//! ARCHITECTURE.md shows which thread sends what.
//!
//! # Who does what
//!
//! - **The window's thread** handles input, runs egui, records and presents. It never compiles, and reads no file. It
//!   writes only the session's recovery record (a few kilobytes, in memory), the panel layout, and the list of recent
//!   files, when they change. It waits for the device only for a new swapchain, a new glyph, a screenshot, and the
//!   first frame after a reload, whose time it reports. The value under the mouse is copied within the frame and read
//!   once that frame has finished.
//! - **The worker** compiles and builds pipelines. It joins edits that wait and takes them first; of an edit, it first
//!   compiles what is on screen. Once the window has drawn that (`Shown`), it compiles the other stages of the edit
//!   (`Completed`). Then it carries out the newest build request, whatever became of the edits, and builds the debug
//!   modes before and after the one on screen. Work for idle times comes last: pipelines of the inspector, driver
//!   statistics (`AskDriver`), thumbnails. It takes one such pipeline at a time, so an edit waits for one at most.
//!   Pipelines of thumbnails are built on a thread beside the worker.
//! - **The loader** parses, decodes and uploads a model. It may touch the device only through a gate that closing
//!   shuts, so closing never waits for a file. The newest request wins: an older load stops before its next file or
//!   image.
//! - **The baker** bakes environments, one submission per pass, and the BRDF lookup tables, reads measured BRDFs, and
//!   builds what path tracing needs. A map that is still being decoded when a newer one is requested is left to a
//!   thread of its own (`cancel.rs`), and the newer one is decoded after it. The newest request wins.
//! - **The measurer** measures the BRDF of the inspected pixel's material, with one `BrdfMeter` for the newest shaders
//!   and one for the previous ones, which it compiles itself, on a pool of one thread.
//! - **The checker** measures the goals of an exercise with a `Headless` of its own, once an edit has settled. A file
//!   event ends it between two goals.
//! - **The finder** looks for the first statement that computes NaN at the pinned pixel, with a clone of `Resources`. A
//!   new frame or pixel ends its work before the next step.
//! - **The operation checker** draws the picture with stages that find assertions that fail, while it rests.
//! - **The timekeeper** draws the picture with and without each function of a stage, or in two versions of the shaders, in turn, while it
//!   rests. A change of the picture ends that before the next frame.
//! - **The tracer** compiles the stage of the pinned pixel with a log, builds its pipelines and draws the pixel, while the panel Source is
//!   open. It has a view of its own and keeps the pipelines for the next pixel. The newest request wins.
//! - **Captures** are drawn by one thread, one after the other, each with a clone of `Resources`. A second shader tree has a thread as long as it is
//!   compared with. Files to compare with are read and scaled by a thread each. Commands from outside have a thread for
//!   each input and each client. Two threads wait for other programs: the user's editor, whose failure they report, and
//!   the file dialog.
//! - **The writer** writes the texts that programs send to files of the shader tree, and takes them back.
//! - **The panel Scene** has a thread make the rows of a model with many nodes (`later.rs`), and says that they are coming until it asks and they are
//!   there.
//! - **Watchers** only send paths, under the names that they were given.
//!
//! All results are messages, which wake the window; so are the requests of screen readers, which AccessKit's thread
//! sends. A thread that panics sends a message too: the window reports it, keeps its picture and counts the thread's
//! work as failed. The worker then continues with a new reloader.

pub(crate) mod baker;
pub(crate) mod checker;
pub(crate) mod finder;
mod gate;
pub(crate) mod later;
pub(crate) mod loader;
pub(crate) mod measurer;
mod message;
mod newest;
pub(crate) mod operation_checker;
mod results;
pub(crate) mod second_tree;
pub(crate) mod timekeeper;
pub(crate) mod tracer;
pub(crate) mod worker;
pub(crate) mod writer;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};
use std::thread::JoinHandle;

use crossbeam_channel::{Sender, unbounded};
use image::{RgbaImage, imageops};

use crate::gpu::{Gpu, Rect, SetLayouts, fault};
use crate::picture_difference::{Comparison, Picture, Still};
use crate::render::Readback;
use crate::render::tools::Tools;
use crate::shader::{Batch, Change, Compiler, Diagnostic, Source, Watcher};
use baker::Baker;
use checker::Checker;
use finder::Finder;
use loader::Loader;
use measurer::Measurer;
use operation_checker::OperationChecker;
use timekeeper::Timekeeper;
use tracer::Tracer;
use worker::Worker;
use writer::Writer;

pub(crate) use message::{Message, MessageSender, NoDialog, TaskKind, TextsWritten};
pub(crate) use results::{
    BakeMessage, Checked, Loaded, MeasuredCurves, SecondTreeMessage, Traced, TracedPlace, WorkerMessage,
};

/// One of two pictures that are compared.
pub(crate) enum Side {
    /// A copy from the device.
    Drawn(Readback),
    /// The colors of a file.
    Stored(Arc<RgbaImage>),
}

impl Side {
    /// All pixels. SYNC: after the fence of the copy's submission.
    fn pixels(self) -> Option<Arc<RgbaImage>> {
        match self {
            Self::Drawn(readback) => {
                let (width, height, rgba8) = readback.finish_display();
                RgbaImage::from_raw(width, height, rgba8).map(Arc::new)
            }
            Self::Stored(image) => Some(image),
        }
    }
}

/// A capture that waits to be drawn.
struct Capture {
    number: u64,
    draw: Box<dyn FnOnce(&MessageSender) + Send>,
}

/// All threads. Dropping this ends the threads that use the device and waits for them, but not for a model that is still being
/// parsed.
pub(crate) struct Threads {
    // The watcher sends to the worker, so it is dropped first.
    tree_watcher: Option<Watcher>,
    file_watcher: Option<Watcher>,
    watched: Vec<PathBuf>,
    pub(crate) worker: Worker,
    pub(crate) loader: Loader,
    pub(crate) baker: Baker,
    pub(crate) checker: Checker,
    pub(crate) measurer: Measurer,
    pub(crate) finder: Finder,
    pub(crate) operation_checker: OperationChecker,
    pub(crate) timekeeper: Timekeeper,
    pub(crate) tracer: Tracer,
    /// Traces for other programs.
    pub(crate) guest_tracer: Tracer,
    pub(crate) writer: Writer,
    gpu: Arc<Gpu>,
    /// Threads that hold device objects: they look for the line of a loop, make the pipelines of tools, scale or compare pictures, or
    /// compile a second shader tree.
    device_threads: Vec<JoinHandle<()>>,
    /// The queue and the thread of captures, which starts with the first.
    capturer: Option<(Sender<Capture>, Option<JoinHandle<()>>)>,
    /// Cancels each capture that has not ended.
    captures: Vec<Weak<AtomicBool>>,
    sender: MessageSender,
}

impl Threads {
    /// The threads beside the worker. `file_watcher` watches the files of the model that is being read.
    pub(crate) fn start(
        device: (&Arc<Gpu>, &Arc<SetLayouts>),
        compiler: &Arc<Compiler>,
        worker: Worker,
        file_watcher: Option<Watcher>,
        sender: &MessageSender,
    ) -> Self {
        Self {
            tree_watcher: None,
            file_watcher,
            watched: Vec::new(),
            worker,
            loader: Loader::new(device, sender),
            baker: Baker::new(device.0, sender),
            checker: Checker::new(device.0, compiler, sender),
            measurer: Measurer::new(device.0, sender),
            finder: Finder::new(device.0, sender),
            operation_checker: OperationChecker::new(device.0, sender),
            timekeeper: Timekeeper::new(device.0, sender),
            tracer: Tracer::new(device.0, sender, TaskKind::PixelTracer, Message::Traced),
            guest_tracer: Tracer::new(device.0, sender, TaskKind::GuestTracer, Message::GuestTraced),
            writer: Writer::new(sender),
            gpu: device.0.clone(),
            device_threads: Vec::new(),
            capturer: None,
            captures: Vec::new(),
            sender: sender.clone(),
        }
    }

    /// Compares a part of two pictures, whose copies have finished, on a thread of its own. The result carries this number.
    pub(crate) fn compare(&mut self, number: u64, pictures: [Side; 2], part: Rect) {
        self.use_device(TaskKind::External, move |sender| {
            let of = |side: Side| {
                let whole = side.pixels()?;
                Some(imageops::crop_imm(&*whole, part.x, part.y, part.width, part.height).to_image())
            };
            let [a, b] = pictures.map(|side| of(side).map(Picture::Display));
            let compared = a.zip(b).ok_or_else(|| "a picture was not read whole".to_owned());
            let compared = compared.and_then(|(a, b)| Comparison::new(&a, &b));
            sender.send(Message::Compared(number, compared.map(Box::new)));
        });
    }

    /// Scales the picture of a file to the size of the window's frame, and uploads it. The result carries this number.
    pub(crate) fn scale(&mut self, number: u64, picture: Arc<Picture>, size: (u32, u32)) {
        let gpu = self.gpu.clone();
        self.use_device(TaskKind::ImageScaling(number), move |sender| {
            let still = Still::new(&gpu, &picture, size).map(Arc::new).map_err(|error| error.to_string());
            sender.send(Message::PictureFits(number, still));
        });
    }

    /// Runs `work`, which uses the device or holds objects of it, on a thread of its own. Closing waits for it.
    pub(crate) fn use_device(&mut self, task: TaskKind, work: impl FnOnce(&MessageSender) + Send + 'static) {
        self.device_threads.retain(|thread| !thread.is_finished());
        self.device_threads.extend(self.sender.spawn(task, work));
    }

    /// Sends the diagnostic that `find` returns, which compiles a stage, for a loop that did not end.
    pub(crate) fn explain(&mut self, words: [u32; 2], find: impl FnOnce() -> Option<Diagnostic> + Send + 'static) {
        self.use_device(TaskKind::LoopDiagnosis(words), move |sender| {
            sender.send(Message::EndlessLoop(words, find().map(Box::new)));
        });
    }

    /// Draws the capture with this number on the thread of captures, after earlier ones. Closing cancels it and waits for it.
    pub(crate) fn capture(
        &mut self,
        number: u64,
        canceled: &Arc<AtomicBool>,
        draw: impl FnOnce(&MessageSender) + Send + 'static,
    ) {
        self.captures.retain(|capture| capture.strong_count() > 0);
        self.captures.push(Arc::downgrade(canceled));
        let (queue, _) = self.capturer.get_or_insert_with(|| {
            let (queue, captures) = unbounded::<Capture>();
            let draw_all = move |sender: &MessageSender| {
                captures.iter().for_each(|capture| sender.guarded(TaskKind::Capture(capture.number), capture.draw));
            };
            (queue, self.sender.spawn(TaskKind::Capture(number), draw_all))
        });
        if queue.send(Capture { number, draw: Box::new(draw) }).is_err() {
            // The thread did not start, which the window has been told. The next capture tries again.
            self.capturer = None;
        }
    }

    /// The sender of messages to the window, for work that answers later.
    pub(crate) fn sender(&self) -> MessageSender {
        self.sender.clone()
    }

    /// Sends the pipelines that `make` returns.
    pub(crate) fn make_tools(&mut self, make: impl FnOnce() -> Result<Arc<Tools>, String> + Send + 'static) {
        self.use_device(TaskKind::ToolPipelines, |sender| sender.send(Message::Tools(make())));
    }

    /// Runs `work`, which waits and uses no device, on a thread of its own, and sends its message. The thread may outlive the
    /// window.
    pub(crate) fn wait(&self, work: impl FnOnce() -> Option<Message> + Send + 'static) {
        self.sender.spawn(TaskKind::External, |sender| work().into_iter().for_each(|message| sender.send(message)));
    }

    /// Watches a shader tree instead of the previous one. Changes go to the worker.
    pub(crate) fn watch_tree(&mut self, source: &Source) -> Result<(), String> {
        self.tree_watcher = None;
        if source.location().is_none() {
            return Ok(());
        }
        let (changes, tree) = (self.worker.changes(), source.clone());
        // An edit cancels the measurement of the previous one.
        let supersede = self.checker.superseding();
        let on_batch = move |batch: Batch| {
            supersede();
            let paths = batch.paths.iter().flat_map(|path| tree.changed(path)).collect();
            changes(Change::Paths(paths), batch.first_event);
        };
        self.tree_watcher =
            Some(Watcher::new(source.root(), &source.files(), on_batch).map_err(|error| error.to_string())?);
        Ok(())
    }

    /// Watches the current files of the tree, after a change.
    pub(crate) fn follow_tree(&self, source: &Source) {
        if let Some(watcher) = self.tree_watcher.as_ref().filter(|_| source.root().is_none()) {
            watcher.set_files(&source.files());
        }
    }

    /// Watches these files instead of the previous ones.
    pub(crate) fn watch_files(&mut self, files: Vec<PathBuf>) -> Result<(), String> {
        if files == self.watched {
            return Ok(());
        }
        match &self.file_watcher {
            Some(watcher) => watcher.set_files(&files),
            None => self.file_watcher = watch_files(&files, &self.sender)?,
        }
        self.watched = files;
        Ok(())
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        self.captures.iter().filter_map(Weak::upgrade).for_each(|canceled| canceled.store(true, Ordering::Relaxed));
        // Without its queue, the thread ends after the last capture.
        let capturer = self.capturer.take().and_then(|(_, thread)| thread);
        for thread in self.device_threads.drain(..).chain(capturer) {
            let _ = thread.join();
        }
        fault::delay("closing-delay-ms");
    }
}

/// Watches files, if there are any.
pub(crate) fn watch_files(files: &[PathBuf], sender: &MessageSender) -> Result<Option<Watcher>, String> {
    if files.is_empty() {
        return Ok(None);
    }
    let sender = sender.clone();
    let on_batch = move |batch: Batch| sender.send(Message::FilesChanged(batch.paths));
    Watcher::new(None, files, on_batch).map(Some).map_err(|error| error.to_string())
}
