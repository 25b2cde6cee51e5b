//! Checks the picture of a command.

use std::sync::Arc;

use super::picture_checker::{CheckRequest, CheckedPicture, PictureChecker};
use super::pixel_tracer::TraceTools;
use super::{Headless, HeadlessError};
use crate::shader::ShaderSet;

impl Headless {
    /// Draws the frames of the sequence with stages that check their assertions, and, with `undefined`, their operations.
    ///
    /// # Errors
    /// As [`Headless::render`]; a stage cannot be checked.
    pub fn check_operations(&mut self, undefined: bool) -> Result<CheckedPicture, HeadlessError> {
        self.finish_or_fail()?;
        self.provide()?;
        let changed = || HeadlessError::Settings("the shaders have changed".to_owned());
        let set = self.resources.pipelines().cloned().ok_or_else(changed)?;
        let target = self.frame_state()?.pipelines.target;
        let shaders = self.shaders();
        let mut checker = PictureChecker::new(&self.gpu, &self.layouts)?;
        let (session, sequence, size) = (&self.session, self.sequence, self.size);
        let state =
            |shaders: &Arc<ShaderSet>, index| session.frame_state_of(shaders, sequence.clock(index), size, target);
        let request = CheckRequest { state: &state, frames: sequence.frames, shaders: &shaders, set: &set, undefined };
        let mut tools = TraceTools::new(&mut self.resources, &self.reloader);
        let picture = checker.check(&request, &mut tools)?;
        self.tell_endless_loop(picture.endless_loop)?;
        Ok(picture)
    }
}
