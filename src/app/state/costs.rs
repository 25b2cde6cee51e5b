//! Times that are measured while the picture rests: what functions of the shaders cost, and how much two versions of them differ.

use std::sync::Arc;
use std::time::Duration;

use serde_json::Value;

use super::picture_subject::PictureSubject;
use super::resting::Resting;
use crate::headless::{FunctionCost, StageCosts};
use crate::shader::{ShaderSet, TreePath};
use crate::statistics::Difference;

/// The functions that the user wants to be measured.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::app) struct WantedCosts {
    /// The stage; `None` for the one that draws the picture.
    pub(in crate::app) stage: Option<String>,
    /// The functions; empty for all.
    pub(in crate::app) functions: Vec<String>,
}

/// A question about a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) enum Question {
    /// The costs of functions.
    Functions(WantedCosts),
    /// How much slower the version with this number is than the newest.
    Version(u64),
}

/// A result, or the reason why there is none.
type Answer<T> = Result<T, String>;

/// The store.
#[derive(Default)]
pub(in crate::app) struct Costs {
    /// The questions of the user, and those that have not been answered.
    wanted: Option<WantedCosts>,
    /// The question that is being measured, and its number.
    asked: Option<(PictureSubject, Question, u64)>,
    resting: Resting<(PictureSubject, Question)>,
    functions: Option<(PictureSubject, Answer<Arc<StageCosts>>)>,
    /// Questions about functions so far.
    count: u64,
    /// The differences of versions from the newest one, by their numbers, of one picture.
    versions: Option<(PictureSubject, OfVersions)>,
}

/// Differences by the numbers of versions.
type OfVersions = Vec<(u64, Answer<Difference>)>;

impl Costs {
    /// Wants functions to be measured. Returns the number of the question.
    pub(in crate::app) fn want(&mut self, wanted: WantedCosts) -> u64 {
        (self.wanted, self.functions) = (Some(wanted), None);
        self.count += 1;
        self.count
    }

    /// Drops the costs of functions in another picture than this one.
    pub(in crate::app) fn keep(&mut self, picture: &PictureSubject) {
        self.functions.take_if(|(of, _)| of != picture);
    }

    /// The next question about a picture: the user's first, then that about a version, unless it has been answered.
    pub(in crate::app) fn question(&self, picture: &PictureSubject, version: Option<u64>) -> Option<Question> {
        let of_user = self.wanted.clone().map(Question::Functions);
        of_user.or_else(|| {
            let version = version?;
            let known = self.versions.as_ref().filter(|(of, _)| of == picture);
            let is_known = known.is_some_and(|(_, all)| all.iter().any(|(number, _)| *number == version));
            (!is_known).then_some(Question::Version(version))
        })
    }

    /// Whether this question is being measured.
    pub(in crate::app) fn is_asked(&self, picture: &PictureSubject, question: &Question) -> bool {
        self.asked.as_ref().is_some_and(|(of, asked, _)| of == picture && asked == question)
    }

    /// How long the picture must still stay as it is, of a total of `rest`.
    pub(in crate::app) fn rest_left(
        &mut self,
        picture: &PictureSubject,
        question: &Question,
        rest: Duration,
    ) -> Option<Duration> {
        self.resting.left(&(picture.clone(), question.clone()), rest)
    }

    /// Notes a request by its number.
    pub(in crate::app) fn ask(&mut self, picture: PictureSubject, question: Question, number: u64) {
        self.asked = Some((picture, question, number));
    }

    /// Notes that nothing is measured. Returns whether something was: it has to end.
    pub(in crate::app) fn stop(&mut self) -> bool {
        self.asked.take().is_some()
    }

    /// Ends the user's question, with the reason.
    pub(in crate::app) fn refuse(&mut self, picture: PictureSubject, reason: &str) {
        if self.wanted.take().is_some() {
            self.functions = Some((picture, Err(reason.to_owned())));
        }
    }

    /// Takes what functions cost, if the request is the newest. Returns whether it is.
    pub(in crate::app) fn take_functions(&mut self, number: u64, result: Answer<Arc<StageCosts>>) -> bool {
        let Some((picture, Question::Functions(_), _)) = self.asked.take_if(|(_, _, of)| *of == number) else {
            return false;
        };
        (self.wanted, self.functions) = (None, Some((picture, result)));
        true
    }

    /// Takes the difference of a version. Returns its number, if the request is the newest.
    pub(in crate::app) fn take_version(&mut self, number: u64, result: Answer<Difference>) -> Option<u64> {
        let (picture, question, _) = self.asked.take_if(|(_, _, of)| *of == number)?;
        let Question::Version(version) = question else { return None };
        match &mut self.versions {
            Some((of, all)) if *of == picture => all.push((version, result)),
            other => *other = Some((picture, vec![(version, result)])),
        }
        Some(version)
    }

    /// Records that the thread has failed: the same question would fail again.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        match self.asked.as_ref().map(|(_, question, number)| (question.clone(), *number)) {
            Some((Question::Functions(_), number)) => _ = self.take_functions(number, Err(message.to_owned())),
            Some((Question::Version(_), number)) => _ = self.take_version(number, Err(message.to_owned())),
            None => {}
        }
    }

    /// The costs of functions that begin at a line of a file, if they are those of the shaders on screen.
    pub(in crate::app) fn of_line(
        &self,
        shaders: &Arc<ShaderSet>,
        path: &TreePath,
        line: u32,
    ) -> Option<&FunctionCost> {
        let (picture, Ok(costs)) = self.functions.as_ref()? else { return None };
        // Numbers of generations begin anew with another tree.
        let is_same = Arc::ptr_eq(&picture.shaders, shaders);
        let here = |cost: &&FunctionCost| cost.function.line == line && *cost.function.file == *path.as_str();
        costs.functions.iter().find(here).filter(|_| is_same)
    }

    /// The time of a frame in which costs were measured, milliseconds.
    pub(in crate::app) fn frame_ms(&self) -> Option<f64> {
        self.functions.as_ref().and_then(|(_, costs)| costs.as_ref().ok()).map(|costs| costs.frame_ms)
    }

    /// By how much a version differs from the newest one, in the picture of these shaders.
    pub(in crate::app) fn of_version(&self, shaders: &Arc<ShaderSet>, version: u64) -> Option<&Difference> {
        let (_, all) = self.versions.as_ref().filter(|(picture, _)| Arc::ptr_eq(&picture.shaders, shaders))?;
        all.iter().find(|(number, _)| *number == version)?.1.as_ref().ok()
    }

    /// The answer to the question with this number, for a command that waits for the costs of functions.
    pub(in crate::app) fn answer(&self, number: u64) -> Option<Answer<Value>> {
        if number != self.count {
            return Some(Err("a newer question about costs has taken the place of this one".to_owned()));
        }
        let (_, costs) = self.functions.as_ref()?;
        Some(costs.as_ref().map(|costs| costs.json()).map_err(Clone::clone))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::trace::sample::subject;
    use crate::statistics::Verdict;

    #[test]
    fn a_difference_is_of_one_set_of_shaders() {
        // Another tree has a generation of the same number.
        let [tree, other] = [(); 2].map(|()| Arc::new(ShaderSet { generation: 2, ..ShaderSet::default() }));
        let picture = subject(&tree).picture;
        let difference = Difference {
            base_ms: 1.0,
            change_ms: 0.5,
            margin_ms: 0.1,
            confidence: 0.99,
            pairs: 8,
            verdict: Verdict::Slower,
        };
        let mut costs = Costs::default();
        costs.ask(picture, Question::Version(1), 7);
        assert_eq!(costs.take_version(7, Ok(difference)), Some(1));
        assert_eq!(costs.of_version(&tree, 1), Some(&difference));
        assert_eq!((costs.of_version(&other, 1), costs.of_version(&tree, 2)), (None, None));
    }
}
