//! A picture of a model without a window, for commands that look into it.

use std::sync::Arc;

use specula::gpu::Gpu;
use specula::headless::{Headless, Sequence};
use specula::settings::Settings;

use super::{Common, Models, compiler};
use crate::commands::Failure;
use crate::commands::progress::Progress;

/// A device and what draws the picture of a command line with it.
pub struct Opened {
    /// The device.
    pub gpu: Arc<Gpu>,
    /// The picture.
    pub headless: Headless,
    /// Tells how far the command is, until it is dropped.
    pub progress: Progress,
}

impl Opened {
    /// Reads the model, with settings that fit it, and compiles all stages.
    ///
    /// # Errors
    /// A device, shaders, a model or settings that cannot be used.
    pub fn new(common: &Common, models: &Models, mut settings: Settings, sequence: Sequence) -> Result<Self, Failure> {
        let source = common.source()?;
        let gpu = common.gpu()?;
        let model = common.model(models.model.as_deref())?;
        common.fit(&model, &mut settings)?;
        let progress = Progress::new(!common.emits());
        progress.say("compiling the shaders");
        let (mut headless, _) = Headless::new(&gpu, &compiler()?, source, model, settings, common.size())?;
        headless.set_sequence(sequence);
        Ok(Self { gpu, headless, progress })
    }
}
