//! The view of the last capture of a session without a window, which writes many pictures of one size.

use std::sync::{Arc, Mutex, PoisonError};

use crate::headless::OffscreenView;

/// A view that waits for the next capture, if it is kept at all.
#[derive(Clone, Default)]
pub(in crate::app) struct CaptureView(Option<Arc<Mutex<Option<OffscreenView>>>>);

impl CaptureView {
    /// Keeps the view of each capture.
    pub(in crate::app) fn kept() -> Self {
        Self(Some(Arc::default()))
    }

    /// The view of the last capture, with its targets.
    pub(in crate::app) fn take(&self) -> Option<OffscreenView> {
        self.0.as_ref()?.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Keeps a view for the next capture. A window needs the memory for itself.
    pub(in crate::app) fn keep(&self, view: OffscreenView) {
        if let Some(kept) = &self.0 {
            *kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(view);
        }
    }
}
