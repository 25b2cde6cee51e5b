//! Makes frames and starts work. Holds the device, its resources, the threads and the compiler. It knows neither the screen nor panels, and
//! nothing of what the user has chosen.

pub(super) mod capture_view;
pub(super) mod compared;
pub(super) mod generations;
pub(super) mod last_complete;
mod tools;

use std::path::Path;
use std::sync::Arc;

use crate::gpu::Gpu;
use crate::learn::exercise_of;
use crate::picture_difference::Still;
use crate::recovery::Recorder;
use crate::render::Resources;
use crate::render::tools::Tools;
use crate::shader::{Compiler, Source};
use crate::threads::{Message, Threads};
use capture_view::CaptureView;
use compared::{Compared, TreePicture};
use generations::Generations;
use last_complete::LastComplete;
pub(super) use tools::ToolsState;

/// Objects of the device, and the threads. The first fields are dropped first.
pub(super) struct Engine {
    pub(super) tools: ToolsState,
    pub(super) gpu: Arc<Gpu>,
    pub(super) resources: Resources,
    /// Resources for the other picture of a comparison. Before the threads: dropping it ends the thread of a second shader tree, for which
    /// they wait.
    pub(super) compared: Compared,
    /// The second tree that is being compiled for a comparison.
    pub(super) opening_tree: Option<Box<TreePicture>>,
    /// Dropping the threads waits for those that use the device.
    pub(super) threads: Threads,
    pub(super) recorder: Recorder,
    /// The last complete frame, which is drawn until the next one is complete.
    pub(super) shown: Option<LastComplete>,
    /// The pipelines and last pictures of the versions.
    pub(super) generations: Generations,
    pub(super) compiler: Arc<Compiler>,
    pub(super) capture_view: CaptureView,
}

impl Engine {
    /// Whether the device is faster than the display, so that vertical sync saves work.
    pub(in crate::app) fn gpu_is_fast(&self) -> bool {
        self.gpu.info().kind != "cpu"
    }

    /// Scales the compared picture to a size, on a thread. Returns the picture once that is done.
    pub(in crate::app) fn picture_that_fits(&mut self, size: (u32, u32)) -> Option<(u64, Arc<Still>)> {
        let Compared::File(file) = &mut self.compared else { return None };
        let wanted = (file.number, size);
        // One at a time, however fast the window changes its size.
        if file.scaled != Some(wanted) && file.scaling.is_none() {
            let picture = file.picture.clone();
            (file.scaled, file.scaling) = (Some(wanted), Some(file.number));
            self.threads.scale(file.number, picture, size);
        }
        file.still.clone().filter(|(_, still)| still.size() == size)
    }

    /// Releases the picture of the second tree, which holds the model on the device.
    pub(in crate::app) fn forget_second_picture(&mut self) {
        if let Compared::Tree(tree) = &mut self.compared {
            (tree.like, tree.asked) = (None, None);
        }
    }

    /// The pipelines. The first call starts building them on a thread; until then there are none.
    pub(in crate::app) fn tools(&mut self) -> Option<Arc<Tools>> {
        if !std::mem::replace(&mut self.tools.is_asked, true) {
            let (gpu, layouts, compiler) = (self.gpu.clone(), self.resources.layouts().clone(), self.compiler.clone());
            self.threads.make_tools(move || Tools::new(&gpu, &layouts, &compiler));
        }
        self.tools.made.clone()
    }

    /// Looks for the exercise of a tree on disk, on a thread of its own.
    pub(in crate::app) fn find_exercise(&self, source: &Source) {
        if let Some(folder) = source.root().map(Path::to_owned) {
            self.threads.wait(move || {
                let exercise = exercise_of(&folder);
                Some(Message::Exercise(folder, exercise))
            });
        }
    }
}
