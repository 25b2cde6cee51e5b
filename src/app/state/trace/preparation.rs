//! Compiles all that traces of the shown file need before a pixel is clicked, while the panel Source is in sight and the thread is free.

use std::sync::Arc;
use std::time::Duration;

use crate::app::state::resting::Resting;
use crate::frame::PipelineRequest;
use crate::shader::TreePath;

/// The stage and the file of the traces, and the pipelines of the picture. Equal ones need the same modules.
#[derive(Clone, PartialEq)]
pub(in crate::app) struct Preparation {
    pub(in crate::app) generation: u64,
    pub(in crate::app) pipelines: Arc<PipelineRequest>,
    /// `None`: the first that has the file, or that of the picture.
    pub(in crate::app) stage: Option<String>,
    /// `None`: that of the stage.
    pub(in crate::app) file: Option<TreePath>,
}

/// The last preparation.
#[derive(Default)]
pub(in crate::app) struct Preparations {
    /// It, and the number of its request.
    asked: Option<(Preparation, u64)>,
    is_done: bool,
    resting: Resting<Preparation>,
}

impl Preparations {
    /// How long `next` must still stay as it is, of a total of `rest`, before it is asked for; `None` if it is under way or done.
    pub(in crate::app) fn left(&mut self, next: &Preparation, rest: Duration) -> Option<Duration> {
        let is_asked = self.asked.as_ref().is_some_and(|(asked, _)| asked == next);
        (!is_asked).then(|| self.resting.left(next, rest).unwrap_or_default())
    }

    /// Notes that the thread was asked, by the number of the request.
    pub(in crate::app) fn ask(&mut self, next: Preparation, number: u64) {
        (self.asked, self.is_done) = (Some((next, number)), false);
    }

    /// Whether the last preparation has ended.
    pub(in crate::app) fn is_done(&self) -> bool {
        self.asked.is_some() && self.is_done
    }

    /// Takes the end of a request, also one that failed. Returns the preparation, if it is the newest.
    pub(in crate::app) fn take(&mut self, number: u64) -> Option<&Preparation> {
        let (asked, _) = self.asked.as_ref().filter(|(_, asked)| *asked == number)?;
        self.is_done = true;
        Some(asked)
    }

    /// Notes that the thread got another request. What is not done then is asked for once more.
    pub(in crate::app) fn interrupt(&mut self) {
        self.asked.take_if(|_| !self.is_done);
    }

    /// Forgets what is prepared: the thread has released it.
    pub(in crate::app) fn forget(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::TargetFormat;
    use crate::settings::Settings;
    use crate::shader::ShaderSet;

    #[test]
    fn a_preparation_is_asked_for_once_unless_another_request_interrupts_it() {
        let request = PipelineRequest::new(&Settings::default(), &ShaderSet::default(), None, TargetFormat::full(1));
        let of = |generation| Preparation { generation, pipelines: Arc::new(request.clone()), stage: None, file: None };
        let (rest, mut all) = (Duration::from_secs(60), Preparations::default());
        assert!(all.left(&of(1), rest).is_some_and(|left| !left.is_zero()), "it may change while something is dragged");
        assert_eq!(all.left(&of(1), Duration::ZERO), Some(Duration::ZERO));
        all.ask(of(1), 7);
        assert_eq!(all.left(&of(1), Duration::ZERO), None);
        all.interrupt();
        assert!(all.take(7).is_none(), "it was interrupted");
        assert!(all.left(&of(1), Duration::ZERO).is_some());
        all.ask(of(1), 8);
        assert!(all.take(7).is_none() && all.take(8) == Some(&of(1)));
        all.interrupt();
        assert_eq!(all.left(&of(1), Duration::ZERO), None, "it is done");
        assert!(all.left(&of(2), Duration::ZERO).is_some(), "a save");
        all.forget();
        assert!(all.left(&of(1), Duration::ZERO).is_some());
    }
}
