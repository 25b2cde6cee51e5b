//! Traces that other programs ask for, such as an editor that shows values beside its lines, and what they are told of the pinned pixel.

use std::collections::{BTreeMap, VecDeque};

use serde_json::Value;

use super::picture_subject::PictureSubject;
use super::resting::Resting;
use crate::shader::TreePath;

/// Results that are kept for clients that may have gone.
const MOST_RESULTS: usize = 64;

/// A trace that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Guest {
    /// Pixels from the upper left corner.
    pub(in crate::app) at: [u32; 2],
    pub(in crate::app) file: TreePath,
    /// `None`: the first that has the file.
    pub(in crate::app) stage: Option<String>,
}

/// The picture, and the pixel that is pinned in it.
pub(in crate::app) type Pinned = (PictureSubject, Option<[u32; 2]>);

/// A question that the thread works on.
struct UnderWay {
    request: u64,
    number: u64,
    guest: Guest,
    /// The mode that is traced.
    mode: String,
}

/// The questions of other programs.
#[derive(Default)]
pub(in crate::app) struct Guests {
    next: u64,
    waiting: VecDeque<(u64, Guest)>,
    /// The question that the thread works on, by its own number.
    under_way: Option<UnderWay>,
    results: BTreeMap<u64, Result<Value, String>>,
    /// The picture and the pixel that other programs were told of last.
    told: Option<Pinned>,
    resting: Resting<Pinned>,
}

impl Guests {
    /// Takes a question. Returns its number.
    pub(in crate::app) fn ask(&mut self, guest: Guest) -> u64 {
        self.next += 1;
        self.waiting.push_back((self.next, guest));
        self.next
    }

    /// The next question, if the thread is free.
    pub(in crate::app) fn next(&self) -> Option<&Guest> {
        self.waiting.front().filter(|_| self.under_way.is_none()).map(|(_, guest)| guest)
    }

    /// Whether nobody waits for a trace.
    pub(in crate::app) fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.under_way.is_none()
    }

    /// Notes that the thread works on the next question, by the number of its request.
    pub(in crate::app) fn begin(&mut self, request: u64, mode: String) {
        self.under_way = self.waiting.pop_front().map(|(number, guest)| UnderWay { request, number, guest, mode });
    }

    /// Takes a result of the thread. Returns whether it is the one that is awaited.
    pub(in crate::app) fn take(
        &mut self,
        request: u64,
        result: impl FnOnce(&Guest, &str) -> Result<Value, String>,
    ) -> bool {
        let Some(done) = self.under_way.take_if(|of| of.request == request) else { return false };
        self.results.insert(done.number, result(&done.guest, &done.mode));
        self.forget_old();
        true
    }

    /// Answers all questions by the reason why they cannot be.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        let under_way = self.under_way.take().map(|of| of.number);
        let waiting = self.waiting.drain(..).map(|(number, _)| number);
        self.results.extend(under_way.into_iter().chain(waiting).map(|number| (number, Err(message.to_owned()))));
        self.forget_old();
    }

    fn forget_old(&mut self) {
        while self.results.len() > MOST_RESULTS {
            self.results.pop_first();
        }
    }

    /// The result of a question, once there is one.
    pub(in crate::app) fn answer(&self, number: u64) -> Option<Result<Value, String>> {
        self.results.get(&number).cloned()
    }

    /// Whether others were told something else than this.
    pub(in crate::app) fn is_news(&self, now: &Pinned) -> bool {
        self.told.as_ref() != Some(now)
    }

    /// How long a picture must still stay as it is before others are told of it.
    pub(in crate::app) fn rest_left(&mut self, now: &Pinned, rest: std::time::Duration) -> Option<std::time::Duration> {
        self.resting.left(now, rest)
    }

    /// Notes that others were told.
    pub(in crate::app) fn tell(&mut self, now: Pinned) {
        self.told = Some(now);
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn each_question_gets_its_answer() {
        let mut guests = Guests::default();
        let guest = |file: &str| Guest { at: [1, 2], file: file.into(), stage: None };
        let [first, second] = ["a.glsl", "b.glsl"].map(|file| guests.ask(guest(file)));
        assert_eq!(guests.next(), Some(&guest("a.glsl")));
        guests.begin(7, String::new());
        assert_eq!((guests.next(), guests.answer(first)), (None, None), "one at a time");
        assert!(!guests.take(6, |_, _| Ok(json!(0))));
        assert!(guests.take(7, |guest, _| Ok(json!(guest.file.as_str()))));
        assert_eq!((guests.answer(first), guests.answer(second)), (Some(Ok(json!("a.glsl"))), None));
        assert_eq!(guests.next(), Some(&guest("b.glsl")));
        guests.begin(8, String::new());
        guests.fail("no");
        assert_eq!(guests.answer(second), Some(Err("no".to_owned())));
        for number in 0..100 {
            guests.ask(guest("c.glsl"));
            guests.begin(100 + number, String::new());
            guests.take(100 + number, |_, _| Ok(Value::Null));
        }
        assert_eq!((guests.answer(first), guests.results.len()), (None, MOST_RESULTS));
    }
}
