//! Sets of modes that are drawn beside the picture: for thumbnails and for the inspected pixel. Both wait until the picture rests, and
//! show what the picture shows.

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::frame::{Clock, FrameInputs, FrameState, PipelineRequest, Revisions, Scene, TargetFormat};
use crate::gpu::GpuError;
use crate::identity::Identity;
use crate::render::{BoundFrame, Resources};
use crate::settings::Settings;
use crate::shader::{Mode, ShaderSet};

/// How long nothing must change before thumbnails are drawn.
const REST: Duration = Duration::from_millis(150);
/// The same delay on a software device, where the first draw of a pipeline compiles it and holds up the frames behind it.
const REST_ON_CPU: Duration = Duration::from_millis(500);

/// The picture that sets show in other modes: complete, and no edit is under way.
#[derive(Clone)]
pub(in crate::app) struct RestingPicture {
    pub(in crate::app) settings: Arc<Settings>,
    pub(in crate::app) shaders: Arc<ShaderSet>,
    pub(in crate::app) scene: Scene,
    /// Whether an animation of the model plays.
    pub(in crate::app) plays: bool,
    pub(in crate::app) revisions: Revisions,
    /// The environment on the device.
    pub(in crate::app) environment: Identity,
    pub(in crate::app) target: TargetFormat,
    /// `FEATURE_*` bits of the scene, which decide about the modes that have data.
    pub(in crate::app) features: Option<u32>,
}

impl RestingPicture {
    /// The modes that have data.
    pub(super) fn modes(&self) -> impl Iterator<Item = &Mode> {
        self.shaders.modes.iter().filter(|mode| mode.has_data(self.features))
    }

    /// Inputs of sets of `size` pixels.
    pub(super) fn at_size(&self, size: (u32, u32)) -> Shown {
        Shown { picture: self.clone(), gives_numbers: false, size }
    }

    /// Inputs of single pixels, in 32 bits and with numbers.
    pub(super) fn of_pixels(&self, size: (u32, u32)) -> Shown {
        let picture = Self { target: TargetFormat::full(1), ..self.clone() };
        Shown { picture, gives_numbers: true, size }
    }
}

/// Everything that the sets show. The mode in the settings makes no difference.
pub(super) struct Shown {
    picture: RestingPicture,
    /// Whether single pixels are read: modes that show a color for each number give the number.
    gives_numbers: bool,
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
        let parts = |of: &Self| {
            let RestingPicture { shaders, revisions, environment, target, .. } = &of.picture;
            (Arc::as_ptr(shaders), *revisions, environment.clone(), *target, of.gives_numbers, of.size)
        };
        let (a, b) = (&self.picture, &other.picture);
        // Pictures of a model that moves show a moment of it. Pixels are those of a moment.
        let is_same_scene = match a.plays && b.plays && !self.gives_numbers {
            true => a.scene.has_same_draws(&b.scene),
            false => a.scene == b.scene,
        };
        parts(self) == parts(other)
            && (Arc::ptr_eq(&a.settings, &b.settings) || a.settings.is_of_other_mode(&b.settings))
            && is_same_scene
    }
}

impl Shown {
    /// Binds the pipelines of each set. `asked` has the sets, by the slugs of their modes, whose pipelines the worker was asked for.
    ///
    /// # Errors
    /// Out of memory.
    pub(super) fn bind<'a>(
        &self,
        resources: &mut Resources,
        sets: Vec<Vec<&'a Mode>>,
        asked: &mut HashSet<String>,
    ) -> Result<BoundSets<'a>, GpuError> {
        let RestingPicture { settings, shaders, scene, revisions, target, .. } = &self.picture;
        let inputs = FrameInputs {
            settings,
            shaders,
            scene: Some(scene),
            revisions: *revisions,
            clock: Clock::default(),
            size: self.size,
            target: *target,
        };
        let mut bound = BoundSets { ready: Vec::new(), missing: VecDeque::new(), is_new: false };
        for set in sets {
            let frame_state = FrameState::of_modes(&inputs, &set);
            let frame_state = Arc::new(if self.gives_numbers { frame_state.with_numbers() } else { frame_state });
            match resources.bind(&frame_state, false)?.0 {
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
pub(super) fn time_to_rest(gpu_is_fast: bool, since: Option<Instant>) -> Option<Duration> {
    let rest = if gpu_is_fast { REST } else { REST_ON_CPU };
    since.and_then(|since| rest.checked_sub(since.elapsed())).filter(|left| !left.is_zero())
}
