//! The pipelines of outlines and pictures of textures: made on a thread when they are first needed.

use std::sync::Arc;

use super::Viewer;
use crate::render::tools::Tools;

impl Viewer {
    /// The pipelines. The first call starts building them on a thread; until then there are none.
    pub(in crate::app) fn tools(&mut self) -> Option<Arc<Tools>> {
        if !std::mem::replace(&mut self.tools.is_asked, true) {
            let (gpu, layouts, compiler) = (self.gpu.clone(), self.resources.layouts().clone(), self.compiler.clone());
            self.threads.make_tools(move || Tools::new(&gpu, &layouts, &compiler));
        }
        self.tools.made.clone()
    }

    /// Accepts the pipelines, or reports why there are none.
    pub(super) fn on_tools(&mut self, tools: Result<Arc<Tools>, String>) {
        match tools {
            Ok(tools) => self.tools.made = Some(tools),
            Err(message) => self.say(format!("Selections have no outline, and textures cannot be shown: {message}")),
        }
    }
}
