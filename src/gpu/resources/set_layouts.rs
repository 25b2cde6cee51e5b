//! Creates the layouts with placeholders that are ready for use, which takes commands on the device.

use std::sync::Arc;

use super::blank::Blank;
use super::descriptor::SetLayouts;
use crate::gpu::{Gpu, GpuError, Use, one_shot};

impl SetLayouts {
    /// Creates the layouts of [`crate::interface::BINDINGS`].
    ///
    /// # Errors
    /// The device is out of memory.
    pub fn new(gpu: &Arc<Gpu>) -> Result<Arc<Self>, GpuError> {
        let blank = Blank::new(gpu)?;
        one_shot(gpu, |encoder| {
            encoder.clear_loops(&blank.loops);
            encoder.copies_done();
            for image in [&blank.image, &blank.array, &blank.cube] {
                encoder.transition(image, Use::Undefined, Use::Sampled);
            }
            Ok(())
        })?;
        Self::with_blank(gpu, blank)
    }
}
