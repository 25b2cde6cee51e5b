//! Findings of the checks of the picture: assertions that fail, values that are printed, operations whose result is open.

use std::sync::Arc;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::picture_subject::PictureSubject;
use super::resting::Resting;
use crate::headless::CheckedPicture;
use crate::shader::checks::Broken;
use crate::shader::compile::asserts::has_calls;
use crate::shader::{Diagnostic, ShaderSet};

/// How long the checks of a moment of a moving picture stand at least, before the next moment is checked, and how many times as long as
/// they took.
const MOMENT: Duration = Duration::from_secs(2);
const TIMES: u32 = 4;

/// How far the newest check is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::app) enum CheckProgress {
    /// The next frame decides whether there is something to check.
    #[default]
    Unknown,
    /// The setting is off, or the shaders have nothing to check.
    Nothing,
    /// The picture is not final.
    Waits,
    /// The thread works.
    UnderWay,
    /// The result is that of the picture.
    Done,
}

/// The checks of the picture.
#[derive(Default)]
pub(in crate::app) struct Checks {
    pub(in crate::app) progress: CheckProgress,
    /// The last request, when it was made, and its number.
    asked: Option<(PictureSubject, Instant)>,
    number: u64,
    /// When the newest result came, and how long it took.
    taken: Option<(Instant, Duration)>,
    resting: Resting<PictureSubject>,
    /// The newest result, and what it is of.
    result: Option<(PictureSubject, Result<Arc<CheckedPicture>, String>)>,
    diagnostics: Vec<Diagnostic>,
    /// Whether shaders assert or print something.
    asserting: Option<(Arc<ShaderSet>, bool)>,
    /// Whether the first pixel that fails is to be pinned, once the checks are those of the picture: a panel that opens makes it smaller.
    pub(in crate::app) seeks: bool,
    /// Whether the window shows what does not hold any more.
    pub(in crate::app) redraws: bool,
}

impl Checks {
    /// The last request.
    pub(in crate::app) fn asked(&self) -> Option<&PictureSubject> {
        self.asked.as_ref().map(|(asked, _)| asked)
    }

    /// The last request, while a moving picture need not be checked again: it is under way, or new.
    pub(in crate::app) fn moment(&self) -> Option<&PictureSubject> {
        let is_new = |(at, took): (Instant, Duration)| at.elapsed() < MOMENT.max(took * TIMES);
        self.asked().filter(|_| !self.is_taken() || self.taken.is_some_and(is_new))
    }

    fn is_taken(&self) -> bool {
        let of = self.result.as_ref().map(|(of, _)| of);
        self.asked().is_some_and(|asked| of == Some(asked))
    }

    /// Notes that checks of `subject` were asked for, by the number of the request.
    pub(in crate::app) fn ask(&mut self, subject: PictureSubject, number: u64) {
        (self.asked, self.number) = (Some((subject, Instant::now())), number);
        self.set(CheckProgress::UnderWay);
    }

    /// Notes how far the checks are. Marks of another picture go.
    pub(in crate::app) fn set(&mut self, progress: CheckProgress) {
        let had_marks = self.of_picture().is_some_and(|picture| !picture.marks.is_empty());
        self.redraws |= had_marks && progress != CheckProgress::Done;
        self.progress = progress;
    }

    /// Notes that the picture is still that of the last request.
    pub(in crate::app) fn resume(&mut self) {
        self.set(if self.is_taken() { CheckProgress::Done } else { CheckProgress::UnderWay });
    }

    /// Forgets all: nothing is checked.
    pub(in crate::app) fn forget(&mut self) {
        let redraws = self.redraws || !self.diagnostics.is_empty();
        let asserting = self.asserting.take();
        *self = Self { progress: CheckProgress::Nothing, asserting, redraws, ..Self::default() };
    }

    /// Whether shaders assert or print something.
    pub(in crate::app) fn has_asserts(&mut self, shaders: &Arc<ShaderSet>) -> bool {
        if let Some((_, answer)) = self.asserting.as_ref().filter(|(of, _)| Arc::ptr_eq(of, shaders)) {
            return *answer;
        }
        let answer = shaders.texts.values().any(|text| has_calls(text));
        self.asserting = Some((shaders.clone(), answer));
        answer
    }

    /// Notes that a command waits for the checks of the picture.
    pub(in crate::app) fn expect(&mut self) {
        self.progress = CheckProgress::Unknown;
    }

    /// How long a subject with other settings than the last must still stay as it is: settings may be dragged.
    pub(in crate::app) fn rest_left(&mut self, subject: &PictureSubject, rest: Duration) -> Option<Duration> {
        self.asked().filter(|asked| asked.settings != subject.settings)?;
        self.resting.left(subject, rest)
    }

    /// Takes the result of a request, if it is the newest. Returns whether it is.
    pub(in crate::app) fn take(&mut self, number: u64, result: Result<Arc<CheckedPicture>, String>) -> bool {
        let Some(of) = self.asked().filter(|_| self.number == number).cloned() else { return false };
        let took = self.asked.as_ref().map_or(Duration::ZERO, |(_, since)| since.elapsed());
        self.taken = Some((Instant::now(), took));
        // It may come while the picture is not final any more.
        if self.progress == CheckProgress::UnderWay {
            self.progress = CheckProgress::Done;
        }
        // A tree may have functions of its own with these names.
        if result.as_ref().is_ok_and(|picture| picture.checks == 0 && picture.baked.is_empty()) {
            self.asserting = Some((of.shaders.clone(), false));
        }
        let picture = result.as_ref().ok();
        let found = picture.into_iter().flat_map(|picture| &picture.broken).map(|(_, diagnostic)| diagnostic);
        let baked = picture.into_iter().flat_map(|picture| &picture.baked);
        self.diagnostics = found.chain(baked).cloned().collect();
        self.result = Some((of, result));
        true
    }

    /// Records that the thread has failed. The same checks would fail again, so they are not asked for again.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        self.take(self.number, Err(message.to_owned()));
    }

    /// The findings of the newest checks, as errors and warnings.
    pub(in crate::app) fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The newest result, even if the picture has changed since.
    pub(in crate::app) fn newest(&self) -> Option<&Result<Arc<CheckedPicture>, String>> {
        self.result.as_ref().map(|(_, result)| result)
    }

    /// The result, if it is that of the picture.
    pub(in crate::app) fn of_picture(&self) -> Option<&Arc<CheckedPicture>> {
        self.newest().filter(|_| self.progress == CheckProgress::Done)?.as_ref().ok()
    }

    /// The first pixel of the picture that fails, and its failure.
    pub(in crate::app) fn first_mark(&self) -> Option<([u32; 2], &Broken)> {
        let picture = self.of_picture()?;
        let (place, mark) = picture.marks.iter().enumerate().find(|(_, mark)| **mark > 0)?;
        let (place, width) = (u32::try_from(place).ok()?, picture.size.0.max(1));
        let (broken, _) = picture.broken.get(usize::from(*mark) - 1)?;
        Some(([place % width, place / width], broken))
    }

    /// The result for a command that waits for the checks of the picture, once there is one.
    pub(in crate::app) fn answer(&self) -> Option<Result<Value, String>> {
        match (self.progress, self.newest()) {
            (CheckProgress::Nothing, _) => Some(Ok(Value::Array(Vec::new()))),
            (CheckProgress::Done, Some(Ok(picture))) => Some(Ok(picture.json())),
            (CheckProgress::Done, Some(Err(message))) => Some(Err(message.clone())),
            _ => None,
        }
    }
}
