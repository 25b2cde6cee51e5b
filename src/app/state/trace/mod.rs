//! The traces of a file at the pinned pixel: the newest one, that of the version before, and which part of them the user has chosen.
//! Nothing is traced while the panel Source and the list of evaluations are out of sight.

pub(in crate::app) mod around;
pub(in crate::app) mod choice;
mod pixel_trace;
pub(in crate::app) mod preparation;
pub(in crate::app) mod rounds;
pub(in crate::app) mod rows;
#[cfg(test)]
pub(in crate::app) mod sample;
pub(in crate::app) mod saved;
pub(in crate::app) mod subject;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::picture_subject::PictureSubject;
use super::resting::Resting;
use crate::shader::trace::Trace;
use crate::shader::{ShaderSet, TreePath};
use crate::threads::TracedPlace;
use around::Around;
use choice::Choice;
pub(in crate::app) use pixel_trace::PixelTrace;
use preparation::Preparations;
use rows::{Row, Sources, rows};
use saved::{SavedText, WrittenText};
use subject::Subject;

/// How long a trace of a moving picture stands at least, and how many times as long as it took, before the next moment is traced.
const MOMENT: Duration = Duration::from_secs(1);
const TIMES: u32 = 4;

/// Frames within which the panel comes into sight after it was asked for.
const MOST_UNSEEN: u32 = 8;

/// How far the newest trace is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum Progress {
    /// The next frame decides whether there is something to trace.
    #[default]
    Unknown,
    /// The panel is out of sight.
    Unseen,
    /// The process before has lost the device, and no new text has been drawn since.
    AfterLoss,
    /// No pixel is pinned.
    NoPixel,
    /// The pinned pixel is outside of the picture, which has become smaller.
    Outside,
    /// The picture is not final.
    Waits,
    /// The thread has been asked, by the number of the request.
    UnderWay(u64),
    /// The trace is that of the picture.
    Done,
}

/// The traces.
#[derive(Default)]
pub(in crate::app) struct Traces {
    /// The stage that the user has chosen; `None` for the first that has the file, or that of the picture.
    pub(in crate::app) stage: Option<String>,
    /// The file that the user has chosen; `None` for that of the stage.
    pub(in crate::app) file: Option<TreePath>,
    pub(in crate::app) choice: Choice,
    /// The line, from 1, to bring into sight once its file is shown.
    pub(in crate::app) seeks: Option<(TreePath, u32)>,
    pub(in crate::app) progress: Progress,
    /// The shown file as it was saved, while it does not compile.
    pub(in crate::app) saved: SavedText,
    /// The text that was typed and written last.
    pub(in crate::app) written: Option<WrittenText>,
    /// The last request, and its number.
    asked: Option<Subject>,
    number: u64,
    /// Whether the result of that request is still to come.
    is_awaited: bool,
    /// The request to send once it has stayed the same for a while.
    resting: Resting<Subject>,
    /// Frames in which the panel was out of sight since a command asked for a trace.
    unseen: u32,
    /// When the newest trace came, and how long it took.
    pub(in crate::app) taken: Option<(Instant, Duration)>,
    /// The newest trace. It stays while a newer one is under way.
    newest: Option<Arc<PixelTrace>>,
    /// The trace of the version before, at the same pixel of the same picture.
    before: Option<Arc<PixelTrace>>,
    /// The generations of shaders with dragged numbers that are in no file. They are no version before another.
    pub(in crate::app) drafted: BTreeSet<u64>,
    /// Whether the thread has still to answer about the version before.
    awaits_before: bool,
    pub(in crate::app) around: Around,
    pub(in crate::app) preparations: Preparations,
}

impl Traces {
    /// The newest trace.
    pub(in crate::app) fn newest(&self) -> Option<&Arc<PixelTrace>> {
        self.newest.as_ref()
    }

    /// The trace of the version before.
    pub(in crate::app) fn before(&self) -> Option<&Arc<PixelTrace>> {
        self.before.as_ref()
    }

    /// The last request.
    pub(in crate::app) fn asked(&self) -> Option<&Subject> {
        self.asked.as_ref()
    }

    /// The file that the panel shows: the chosen one, or that of the stage.
    pub(in crate::app) fn file_shown(&self) -> Option<&TreePath> {
        self.file.as_ref().or(self.newest.as_ref().map(|newest| &newest.file))
    }

    /// Chooses fragment, call, round and time. The begin of another call comes into sight.
    pub(in crate::app) fn choose(&mut self, choice: Choice) {
        if choice.call != self.choice.call {
            self.seeks = choice.call.as_deref().and_then(|call| self.begin_of(call));
        }
        self.choice = choice;
    }

    /// The first line of a call in the traced file.
    fn begin_of(&self, call: &str) -> Option<(TreePath, u32)> {
        let newest = self.newest.as_ref()?;
        let lines = newest.trace.as_ref().ok()?.lines_where(self.fragment()?, |event| *event.calls == *call);
        let line = lines.iter().find(|line| line.file == newest.file.as_str())?.line;
        Some((newest.file.clone(), line))
    }

    /// Whether a trace of a moving picture may be replaced by one of the picture now.
    pub(in crate::app) fn is_old(&self) -> bool {
        let is_old = |(at, took): (Instant, Duration)| at.elapsed() > MOMENT.max(took * TIMES);
        !self.is_awaited && self.taken.is_some_and(is_old)
    }

    /// Forgets what was chosen in another tree.
    pub(in crate::app) fn leave_tree(&mut self) {
        (self.stage, self.file, self.choice, self.seeks) = (None, None, Choice::default(), None);
        self.saved.forget();
    }

    /// Notes that a trace of `subject` was asked for, by the number of the request.
    /// `with_before`: that of the version before follows.
    pub(in crate::app) fn ask(&mut self, subject: Subject, number: u64, with_before: bool) {
        (self.asked, self.number, self.is_awaited) = (Some(subject), number, true);
        self.awaits_before = with_before;
        self.preparations.interrupt();
        self.around.leave();
        self.progress = Progress::UnderWay(number);
    }

    /// Records that the thread has failed. The same trace would fail again, so it is not asked for again.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        self.take(self.number, Default::default(), Err(message.to_owned()));
        self.around.fail(message);
        self.awaits_before = false;
    }

    /// How long `subject` must still stay as it is, of a total of `rest`, before it is asked for: settings may be dragged. A click, a save and
    /// another file are traced at once.
    pub(in crate::app) fn rest_left(&mut self, subject: &Subject, rest: Duration) -> Option<Duration> {
        self.asked.as_ref().filter(|asked| asked.picture.settings != subject.picture.settings)?;
        self.resting.left(subject, rest)
    }

    /// Notes that a command waits for the trace of the picture.
    pub(in crate::app) fn expect(&mut self) {
        (self.progress, self.unseen) = (Progress::Unknown, 0);
    }

    /// Notes that the picture is still that of the last request.
    pub(in crate::app) fn resume(&mut self) {
        let is_taken = |asked: &Subject| self.newest.as_ref().is_some_and(|newest| newest.of == *asked);
        let is_done = self.asked.as_ref().is_some_and(is_taken);
        self.progress = if is_done { Progress::Done } else { Progress::UnderWay(self.number) };
    }

    /// Notes that the panel was out of sight in a frame.
    pub(in crate::app) fn unseen(&mut self) {
        (self.asked, self.progress) = (None, Progress::Unseen);
        (self.is_awaited, self.awaits_before) = (false, false);
        self.preparations.forget();
        self.unseen = self.unseen.saturating_add(1);
    }

    /// The result for a command that waits for the trace of the picture, once there is one.
    pub(in crate::app) fn answer(&self) -> Option<Result<Value, String>> {
        match self.progress {
            // Without the version before, nothing would have changed.
            Progress::Done => (!self.awaits_before).then(|| self.json()),
            Progress::NoPixel => Some(Err("no pixel is pinned; name one with `at`".to_owned())),
            Progress::Outside => Some(Err("the pinned pixel is outside of the picture".to_owned())),
            Progress::AfterLoss => {
                Some(Err("after a lost device, nothing is traced until an edit has been drawn".to_owned()))
            }
            // It opens within a few frames.
            Progress::Unseen if self.unseen > MOST_UNSEEN => {
                Some(Err("the panel Source is not in sight, so nothing is traced".to_owned()))
            }
            Progress::Unseen | Progress::Unknown | Progress::Waits | Progress::UnderWay(_) => None,
        }
    }

    /// Whether a trace of the version before is missing for `subject`: the last trace is of another picture.
    pub(in crate::app) fn lacks_before(&self, subject: &Subject) -> bool {
        let is_known = |known: &Option<Arc<PixelTrace>>| {
            known.as_ref().is_some_and(|known| known.of.is_same_but_version(subject) && known.trace.is_ok())
        };
        let is_other = |known: &Option<Arc<PixelTrace>>| {
            is_known(known) && known.as_ref().is_some_and(|known| !known.of.picture.has_same_texts(&subject.picture))
        };
        !is_other(&self.newest) && !is_other(&self.before)
    }

    /// Takes the result of a request, if it is the newest. Returns whether it is. It may come while the picture is not final any more: then
    /// [`Self::resume`] or the next request says whether it is that of the picture.
    pub(in crate::app) fn take(
        &mut self,
        number: u64,
        TracedPlace { stage, stages, files, file }: TracedPlace,
        trace: Result<Trace, String>,
    ) -> bool {
        let is_newest = self.number == number && self.is_awaited;
        let Some(of) = self.asked.clone().filter(|_| is_newest) else {
            return false;
        };
        self.is_awaited = false;
        // The version before is traced where this one is.
        self.awaits_before &= trace.is_ok();
        if self.progress == Progress::UnderWay(number) {
            self.progress = Progress::Done;
        }
        // Without a stage, there is no file of it.
        let last = || self.newest.as_ref().map(|last| last.file.clone());
        let named = (!file.is_empty()).then(|| TreePath::from(file.as_str()));
        let file = named.or_else(|| of.file.clone()).or_else(last).unwrap_or_else(|| TreePath::from(""));
        let newest = PixelTrace { of, stage, stages, files, file, trace };
        let fits = |old: &Arc<PixelTrace>| {
            old.trace.is_ok()
                && old.of.is_same_but_version(&newest.of)
                && old.file == newest.file
                && (newest.stage.is_empty() || old.stage == newest.stage)
                && !old.of.picture.has_same_texts(&newest.of.picture)
        };
        let is_draft = |of: &Arc<PixelTrace>| self.drafted.contains(&of.of.picture.shaders.generation);
        let last = self.newest.take().filter(|last| fits(last) && !is_draft(last));
        self.before = last.or(self.before.take().filter(fits));
        self.newest = Some(Arc::new(newest));
        true
    }

    /// Takes the trace of the version before for the newest request, unless there is one.
    pub(in crate::app) fn take_before(&mut self, number: u64, before: Option<(Arc<ShaderSet>, Trace)>) {
        let is_taken = self.number == number && self.asked.is_some() && !self.is_awaited;
        self.awaits_before &= !is_taken;
        let Some((shaders, trace)) = before else { return };
        let is_missing = is_taken && self.before.is_none();
        let Some(newest) = self.newest.as_ref().filter(|_| is_missing) else { return };
        let PixelTrace { of, stage, stages, files, file, .. } = &**newest;
        let of = Subject { picture: PictureSubject { shaders, ..of.picture.clone() }, ..of.clone() };
        let (stage, stages, files, file) = (stage.clone(), stages.clone(), files.clone(), file.clone());
        self.before = Some(Arc::new(PixelTrace { of, stage, stages, files, file, trace: Ok(trace) }));
    }

    /// The newest trace, if the values around its pixel are missing and the thread is free.
    pub(in crate::app) fn lacks_around(&self) -> Option<Arc<PixelTrace>> {
        let newest = self.newest.as_ref().filter(|newest| newest.trace.is_ok() && self.around.lacks(newest))?;
        (self.progress == Progress::Done && !self.awaits_before).then(|| newest.clone())
    }

    /// Notes that the mouse is on no value. Returns whether the thread works on the values around one.
    pub(in crate::app) fn leave_around(&mut self) -> bool {
        self.around.leave() && !self.is_awaited && !self.awaits_before
    }

    /// Whether the thread works on a trace of this panel.
    pub(in crate::app) fn is_under_way(&self) -> bool {
        let awaits_around = |newest: &Arc<PixelTrace>| !self.around.lacks(newest) && self.around.of(newest).is_none();
        self.is_awaited || self.awaits_before || self.newest.as_ref().is_some_and(awaits_around)
    }

    /// The fragment whose statements are shown.
    pub(in crate::app) fn fragment(&self) -> Option<usize> {
        self.newest.as_ref()?.trace.as_ref().ok().and_then(|trace| self.choice.fragment_of(trace))
    }

    /// The rows of a text of a file. Without a pinned pixel, they have no values.
    pub(in crate::app) fn rows(&self, file: &TreePath, text: &str) -> Vec<Row> {
        let has_pixel = self.progress != Progress::NoPixel;
        let of_file = |of: &Option<Arc<PixelTrace>>| of.clone().filter(|of| has_pixel && of.file == *file);
        let (now, before) = (of_file(&self.newest), of_file(&self.before));
        let now = now.as_ref().and_then(|now| now.side());
        let before = before.as_ref().and_then(|before| before.side());
        rows(&Sources { text, now, before }, &self.choice)
    }

    /// The newest trace in the form of `specula trace --json`, with the values that the last edit has changed.
    pub(in crate::app) fn json(&self) -> Result<Value, String> {
        let newest = self.newest.as_ref().ok_or("no pixel has been traced")?;
        let trace = newest.trace.as_ref().map_err(Clone::clone)?;
        let none = "every fragment is discarded at this pixel; choose one with `fragment`";
        let fragment = self.choice.fragment_of(trace).ok_or(none)?;
        let mut json = trace.json(fragment);
        (json["pixel"], json["mode"]) = (json!(newest.of.at), json!(newest.of.picture.settings.mode));
        (json["file"], json["files"]) = (json!(newest.file.as_str()), json!(newest.files));
        json["stages"] = json!(newest.stages);
        json["calls"] = json!(choice::calls(trace, fragment));
        json["changed"] = self.rows(&newest.file, &newest.text()).iter().flat_map(Row::changes_json).collect();
        Ok(json)
    }
}

#[cfg(test)]
mod tests;
