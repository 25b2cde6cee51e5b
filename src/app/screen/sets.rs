//! Sets of modes that are drawn beside the picture: for thumbnails and for the inspected pixel. Both wait until the picture rests, and
//! show what the picture shows.

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::app::engine::Engine;
use crate::app::frames::progress::awaits_edit;
use crate::app::state::State;
use crate::frame::{Clock, FrameInputs, FrameState, PipelineRequest, Revisions, Scene, TargetFormat};
use crate::gpu::GpuError;
use crate::render::{BoundFrame, GpuEnvironment};
use crate::settings::Settings;
use crate::shader::{Mode, ShaderSet};

/// How long nothing must change before thumbnails are drawn.
const REST: Duration = Duration::from_millis(150);
/// The same delay on a software device, where the first draw of a pipeline compiles it and holds up the frames behind it.
const REST_ON_CPU: Duration = Duration::from_millis(500);

/// Everything that the sets show. The mode in the settings makes no difference.
pub(super) struct Shown {
    settings: Arc<Settings>,
    /// Address of the shaders: generation numbers may restart at 1.
    shaders: usize,
    scene: Scene,
    revisions: Revisions,
    environment: usize,
    pub(super) target: TargetFormat,
    /// Whether single pixels are read: modes that show a color for each number give the number.
    pub(super) gives_numbers: bool,
    /// Pixels of a picture.
    pub(super) size: (u32, u32),
}

/// The sets whose pipelines are there, and the pipelines that are not.
pub(super) struct BoundSets<'a> {
    pub(super) ready: Vec<(Vec<&'a Mode>, BoundFrame)>,
    pub(super) missing: VecDeque<Arc<PipelineRequest>>,
    /// Whether the worker still has to be asked for some of the missing pipelines.
    pub(super) is_new: bool,
}

impl PartialEq for Shown {
    fn eq(&self, other: &Self) -> bool {
        let parts = |of: &Self| (of.shaders, of.revisions, of.environment, of.target, of.gives_numbers, of.size);
        parts(self) == parts(other)
            && (Arc::ptr_eq(&self.settings, &other.settings) || self.settings.is_of_other_mode(&other.settings))
            && self.scene == other.scene
    }
}

impl Shown {
    /// Binds the pipelines of each set. `asked` has the sets, by the slugs of their modes, whose pipelines the worker was asked for.
    ///
    /// # Errors
    /// Out of memory.
    pub(super) fn bind<'a>(
        &self,
        engine: &mut Engine,
        shaders: &Arc<ShaderSet>,
        sets: Vec<Vec<&'a Mode>>,
        asked: &mut HashSet<String>,
    ) -> Result<BoundSets<'a>, GpuError> {
        let inputs = FrameInputs {
            settings: &self.settings,
            shaders,
            scene: Some(&self.scene),
            revisions: self.revisions,
            clock: Clock::default(),
            size: self.size,
            target: self.target,
        };
        let mut bound = BoundSets { ready: Vec::new(), missing: VecDeque::new(), is_new: false };
        for set in sets {
            let frame_state = FrameState::of_modes(&inputs, &set);
            let frame_state = Arc::new(if self.gives_numbers { frame_state.with_numbers() } else { frame_state });
            match engine.resources.bind(&frame_state, false)?.0 {
                Some(frame) => bound.ready.push((set, frame)),
                None => {
                    let slugs = set.iter().map(|mode| mode.slug.as_str()).collect::<Vec<_>>().join(" ");
                    bound.is_new |= asked.insert(slugs);
                    bound.missing.push_back(frame_state.pipelines.clone());
                }
            }
        }
        Ok(bound)
    }
}

/// The time until the picture has been idle for long enough.
pub(super) fn time_to_rest(engine: &Engine, since: Option<Instant>) -> Option<Duration> {
    let rest = if engine.gpu_is_fast() { REST } else { REST_ON_CPU };
    since.and_then(|since| rest.checked_sub(since.elapsed())).filter(|left| !left.is_zero())
}

/// Returns the inputs of sets that are drawn with `size` pixels. `None` while the shaders or resources of the picture are incomplete.
pub(super) fn shown(state: &State, engine: &Engine, size: (u32, u32)) -> Option<(Arc<ShaderSet>, Shown)> {
    let frame_state = state.shown()?;
    let shaders = state.session.shaders.clone()?;
    let is_current = frame_state.shaders.generation == shaders.generation;
    if !is_current || !shaders.is_complete() || awaits_edit(state, engine) {
        return None;
    }
    let environment: *const GpuEnvironment = Arc::as_ptr(engine.resources.environment());
    let shown = Shown {
        settings: state.session.shared_settings(),
        shaders: Arc::as_ptr(&shaders) as usize,
        scene: state.session.scene()?,
        revisions: state.session.revisions,
        environment: environment as usize,
        target: target(engine, frame_state.pipelines.target),
        gives_numbers: false,
        size,
    };
    Some((shaders, shown))
}

/// A software device spends most of the time of multisampled thumbnails on small triangles. It draws twice the size instead, with one
/// sample per pixel, which egui halves.
fn target(engine: &Engine, picture: TargetFormat) -> TargetFormat {
    if engine.gpu_is_fast() { picture } else { TargetFormat { samples: 1, ..picture } }
}
