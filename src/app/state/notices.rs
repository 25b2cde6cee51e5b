//! Messages over the picture: the newest one passes after a few seconds, failures stay until the user dismisses them.

use std::time::{Duration, Instant};

/// Duration of a transient message.
const NOTICE: Duration = Duration::from_secs(6);

/// Messages over the picture.
#[derive(Default)]
pub(in crate::app) struct Notices {
    /// The transient message and the time it appeared.
    passing: Option<(String, Instant)>,
    /// Sticky messages, shown until they are dismissed.
    kept: Vec<String>,
}

impl Notices {
    /// Shows a transient message.
    pub(in crate::app) fn say(&mut self, text: String) {
        self.passing = Some((text, Instant::now()));
    }

    /// Shows a sticky message, until the user dismisses it. Returns whether the message is new.
    pub(in crate::app) fn keep(&mut self, text: String) -> bool {
        let is_new = !self.kept.contains(&text);
        if is_new {
            self.kept.push(text);
        }
        is_new
    }

    /// The transient message and the time that it has left, which is infinite if `stays`.
    pub(in crate::app) fn passing(&self, stays: bool) -> Option<(&str, Duration)> {
        let (text, since) = self.passing.as_ref()?;
        let left = if stays { Duration::MAX } else { NOTICE.saturating_sub(since.elapsed()) };
        (!left.is_zero()).then_some((text, left))
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
    fn the_newest_message_takes_the_place_of_the_one_before() {
        let mut notices = Notices::default();
        assert_eq!(notices.passing(true), None);
        notices.say("first".into());
        notices.say("second".into());
        assert_eq!(notices.passing(true), Some(("second", Duration::MAX)));
        assert!(notices.passing(false).is_some_and(|(text, left)| text == "second" && left <= NOTICE));
    }
}
