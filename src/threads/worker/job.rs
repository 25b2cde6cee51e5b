//! The jobs of the worker.

use std::collections::{BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use crate::frame::{MaterialVariant, PipelineRequest, Scene, TargetFormat};
use crate::interface::{FEATURE_NORMAL_TEXTURE, FEATURE_PACKED_OCCLUSION};
use crate::pipeline::PipelineSet;
use crate::settings::Settings;
use crate::shader::{Change, ShaderSet, Source, TreePath};

/// The settings, scene and target of the window's current frame. A reload builds their pipelines.
#[derive(Clone)]
pub(crate) struct Snapshot {
    pub(crate) settings: Arc<Settings>,
    pub(crate) scene: Option<Scene>,
    pub(crate) target: TargetFormat,
    /// Suns of the environment: see `Revisions::suns_of`.
    pub(crate) suns: u32,
}

impl Snapshot {
    /// The pipelines that the frame needs from `shaders`.
    pub(in crate::threads) fn request(&self, shaders: &ShaderSet) -> PipelineRequest {
        let request = PipelineRequest::new(&self.settings, shaders, self.scene.as_ref(), self.target);
        let mut request = request.for_suns(self.suns);
        if self.scene.is_none() {
            // While the model loads, build the pipeline that most models need.
            let features = FEATURE_NORMAL_TEXTURE | FEATURE_PACKED_OCCLUSION;
            request.materials = BTreeSet::from([MaterialVariant { features, ..Default::default() }]);
        }
        request
    }
}

/// Changed files, and the times of the first event and of the settled set.
pub(super) struct Edit {
    pub(super) change: Change,
    pub(super) since: Instant,
    pub(super) settled: Instant,
}

impl Edit {
    pub(super) fn new(change: Change, since: Instant) -> Self {
        Self { change, since, settled: Instant::now() }
    }
}

pub(super) type Build = (Arc<PipelineSet>, Arc<PipelineRequest>);

pub(super) enum Job {
    Edit(Edit),
    /// Looks whether there is a tree at this path.
    FindTree(PathBuf),
    OpenTree(Source, usize),
    /// Reads the same tree from another source, which changes these files.
    Read(Source, BTreeSet<TreePath>),
    Build(Build),
    /// Builds pipelines of thumbnails when idle. Replaces an earlier job of this kind.
    Thumbnails(Arc<PipelineSet>, VecDeque<Arc<PipelineRequest>>),
    /// Builds pipelines of a preview when idle, before those of the inspector. Replaces an earlier job of this kind.
    Preview(Build),
    /// Builds pipelines of the inspector's modes when idle, before thumbnails. Replaces an earlier job of this kind.
    Inspected(Arc<PipelineSet>, VecDeque<Arc<PipelineRequest>>),
    /// Queries the driver's statistics of a frame's pipelines when idle. Replaces an earlier job of this kind.
    AskDriver(Build),
    /// The first frame of the last reload is on screen.
    Shown,
}

impl Job {
    /// Whether the job makes a running reload stale.
    pub(super) fn is_edit(&self) -> bool {
        matches!(self, Self::Edit(_) | Self::FindTree(_) | Self::OpenTree(..) | Self::Read(..))
    }
}
