//! Messages over the picture: the newest ones pass after a few seconds, failures stay until the user dismisses them. All are remembered.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use chrono::{DateTime, Local};

/// Duration of a transient message.
const NOTICE: Duration = Duration::from_secs(6);
/// Most transient messages that are shown at a time.
const SHOWN: usize = 3;
/// Most messages that are remembered.
const REMEMBERED: usize = 100;

/// A message that was shown.
pub(in crate::app) struct Notice {
    pub(in crate::app) text: String,
    pub(in crate::app) at: DateTime<Local>,
    since: Instant,
    /// Whether it stays in sight until it is dismissed.
    is_kept: bool,
}

/// Messages over the picture.
#[derive(Default)]
pub(in crate::app) struct Notices {
    /// All messages, the oldest first.
    past: VecDeque<Notice>,
    /// Sticky messages, shown until they are dismissed.
    kept: Vec<String>,
}

impl Notices {
    /// Shows a transient message.
    pub(in crate::app) fn say(&mut self, text: String) {
        self.remember(text, false);
    }

    /// Shows a sticky message, until the user dismisses it. Returns whether the message is new.
    pub(in crate::app) fn keep(&mut self, text: String) -> bool {
        let is_new = !self.kept.contains(&text);
        if is_new {
            self.kept.push(text.clone());
            self.remember(text, true);
        }
        is_new
    }

    /// Remembers a message. A repeated one moves to the end.
    fn remember(&mut self, text: String, is_kept: bool) {
        self.past.retain(|notice| notice.text != text);
        self.past.push_back(Notice { text, at: Local::now(), since: Instant::now(), is_kept });
        self.past.drain(..self.past.len().saturating_sub(REMEMBERED));
    }

    /// All messages so far, the newest first.
    pub(in crate::app) fn past(&self) -> impl ExactSizeIterator<Item = &Notice> {
        self.past.iter().rev()
    }

    /// The transient messages, the newest last, and the time that each has left. With `stays` only the newest, for ever.
    pub(in crate::app) fn passing(&self, stays: bool) -> Vec<(&str, Duration)> {
        let transient = self.past.iter().rev().filter(|notice| !notice.is_kept);
        if stays {
            return transient.take(1).map(|notice| (notice.text.as_str(), Duration::MAX)).collect();
        }
        let left = |notice: &Notice| NOTICE.saturating_sub(notice.since.elapsed());
        let shown = transient.map(|notice| (notice.text.as_str(), left(notice)));
        let mut shown: Vec<_> = shown.take(SHOWN).filter(|(_, left)| !left.is_zero()).collect();
        shown.reverse();
        shown
    }

    /// The messages that the user has not dismissed.
    pub(in crate::app) fn kept(&self) -> &[String] {
        &self.kept
    }

    /// Removes a sticky message whose reason is gone.
    pub(in crate::app) fn end(&mut self, text: &str) {
        self.kept.retain(|kept| kept != text);
    }

    /// Removes all sticky messages.
    pub(in crate::app) fn dismiss(&mut self) {
        self.kept.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_kept_once_until_it_is_dismissed() {
        let mut notices = Notices::default();
        assert!(notices.keep("no memory".into()) && notices.keep("no file".into()));
        assert!(!notices.keep("no memory".into()), "it is shown already");
        notices.end("no memory");
        assert_eq!(notices.kept(), ["no file"]);
        notices.dismiss();
        assert!(notices.kept().is_empty());
    }

    #[test]
    fn messages_stand_below_one_another_and_are_remembered() {
        let mut notices = Notices::default();
        assert_eq!(notices.passing(true), []);
        for text in ["first", "second", "third", "second", "fourth"] {
            notices.say(text.into());
        }
        assert!(notices.keep("no memory".into()));
        let texts: Vec<&str> = notices.passing(false).into_iter().map(|(text, _)| text).collect();
        assert_eq!(texts, ["third", "second", "fourth"]);
        assert!(notices.passing(false).iter().all(|(_, left)| *left <= NOTICE));
        assert_eq!(notices.passing(true), [("fourth", Duration::MAX)]);
        let past: Vec<&str> = notices.past().map(|notice| notice.text.as_str()).collect();
        assert_eq!(past, ["no memory", "fourth", "second", "third", "first"]);
    }
}
