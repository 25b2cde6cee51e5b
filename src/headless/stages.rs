//! Reports on the shader stages of the picture.

use std::collections::BTreeMap;

use super::{Headless, HeadlessError};
use crate::pipeline::StageReport;

impl Headless {
    /// All stages by path, with their statistics in the pipelines of the frame. None before the first good shaders.
    ///
    /// # Errors
    /// As [`Headless::frame_state`].
    pub fn stages(&self) -> Result<BTreeMap<String, StageReport>, HeadlessError> {
        let request = self.frame_state()?.pipelines.clone();
        Ok(self.resources.pipelines().map(|set| set.report(&request)).unwrap_or_default())
    }

    /// Queries the driver's statistics of the frame's pipelines, each of which is built once more. Returns how long that took, in
    /// milliseconds; 0 if the driver reports none.
    ///
    /// # Errors
    /// As [`Headless::frame_state`], and a driver that does not answer.
    pub fn ask_driver(&self) -> Result<f64, HeadlessError> {
        let request = self.frame_state()?.pipelines.clone();
        let Some(set) = self.resources.pipelines() else { return Ok(0.0) };
        let mut all = 0.0;
        while let Some(ms) = set.ask_driver(&request)? {
            all += ms;
        }
        Ok(all)
    }
}
