//! The values of the shown file around the pinned pixel. They are traced once the mouse rests on a value, and serve all values of that trace.

use std::sync::{Arc, Weak};

use super::pixel_trace::PixelTrace;
use crate::shader::trace::Neighborhood;

/// The values around the pixel of the newest trace.
#[derive(Default)]
pub(in crate::app) struct Around {
    /// The trace that was newest when they were asked for, and the number of the request.
    asked: Option<(Weak<PixelTrace>, u64)>,
    found: Option<Result<Neighborhood, String>>,
}

impl Around {
    /// Whether those of a trace have not been asked for.
    pub(in crate::app) fn lacks(&self, trace: &Arc<PixelTrace>) -> bool {
        !self.asked.as_ref().is_some_and(|(of, _)| std::ptr::eq(of.as_ptr(), Arc::as_ptr(trace)))
    }

    /// Notes that those of a trace were asked for, by the number of the request.
    pub(in crate::app) fn ask(&mut self, trace: &Arc<PixelTrace>, number: u64) {
        (self.asked, self.found) = (Some((Arc::downgrade(trace), number)), None);
    }

    /// Forgets the request, because the mouse has left the value. Returns whether it was under way.
    pub(in crate::app) fn leave(&mut self) -> bool {
        let is_under_way = self.asked.is_some() && self.found.is_none();
        self.asked.take_if(|_| is_under_way);
        is_under_way
    }

    /// Takes the result of a request, if it is the newest.
    pub(in crate::app) fn take(&mut self, number: u64, found: Result<Neighborhood, String>) {
        if self.asked.as_ref().is_some_and(|(_, asked)| *asked == number) {
            self.found = Some(found);
        }
    }

    /// Records that the thread has failed.
    pub(in crate::app) fn fail(&mut self, message: &str) {
        if self.asked.is_some() && self.found.is_none() {
            self.found = Some(Err(message.to_owned()));
        }
    }

    /// Those of a trace, or why there are none; `None` until they are known.
    pub(in crate::app) fn of(&self, trace: &Arc<PixelTrace>) -> Option<&Result<Neighborhood, String>> {
        self.found.as_ref().filter(|_| !self.lacks(trace))
    }
}
