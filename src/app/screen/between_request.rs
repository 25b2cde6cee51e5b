//! The request to draw between frames, extracted from the state as plain values, and its results.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;
use std::time::Duration;

use super::pointed::Pointed;
use super::sets::RestingPicture;
use crate::frame::{FrameState, PipelineRequest};
use crate::render::{BoundFrame, Capture, Texel};
use crate::shader::{Mode, PixelValue};

/// The request to draw between two frames.
pub(in crate::app) struct BetweenRequest<'a> {
    /// The picture that the thumbnails and values show; `None` while it is incomplete, or nobody sees them.
    pub(in crate::app) picture: Option<&'a RestingPicture>,
    /// The modes of the newest shaders.
    pub(in crate::app) modes: &'a [Mode],
    /// The modes whose thumbnails are in sight, by their slugs.
    pub(in crate::app) thumbnails: &'a BTreeSet<String>,
    /// Width and height of a thumbnail, points.
    pub(in crate::app) thumbnail_size: [f32; 2],
    pub(in crate::app) pixels_per_point: f32,
    /// The inspector, while it is in sight.
    pub(in crate::app) inspector: Option<InspectorRequest>,
    /// The pixel under the mouse, if its exact value can be read.
    pub(in crate::app) pointed: Option<Pointed>,
    /// A version that lacks its thumbnail, and its picture.
    pub(in crate::app) version: Option<(u64, BoundFrame)>,
}

/// The pixel that the inspector shows.
pub(in crate::app) struct InspectorRequest {
    pub(in crate::app) pin: Option<[u32; 2]>,
    /// The pixel under the mouse, and the size of the picture.
    pub(in crate::app) mouse: Option<(u32, u32)>,
    pub(in crate::app) size: (u32, u32),
    /// Whether it shows the pixel under the mouse while none is pinned.
    pub(in crate::app) follows: bool,
    /// The number of the picture whose values it shows.
    pub(in crate::app) reading: Option<u64>,
}

/// The result of drawing between frames.
#[derive(Default)]
pub(in crate::app) struct Drawn {
    /// The time until there is more to draw.
    pub(in crate::app) wait: Option<Duration>,
    /// The pipelines that are missing, in the order of the requests.
    pub(in crate::app) builds: Vec<Build>,
    /// How many thumbnails were drawn since they were last up to date, once they are.
    pub(in crate::app) thumbnails: usize,
    pub(in crate::app) inspected: Option<Inspected>,
}

/// Pipelines for the worker.
pub(in crate::app) enum Build {
    Thumbnails(VecDeque<Arc<PipelineRequest>>),
    Inspected(VecDeque<Arc<PipelineRequest>>),
}

/// How far the values of the inspected pixel are.
pub(in crate::app) enum Inspected {
    /// Those of a picture with this number are being read: the pixel, and what the picture shows.
    Begun(u64, [u32; 2], Arc<FrameState>),
    /// All of this picture were read.
    All(u64),
}

/// Results of the last submission.
#[derive(Default)]
pub(in crate::app) struct Collected {
    /// Whether there was a submission.
    pub(in crate::app) is_new: bool,
    /// Whether a loop in it did not end.
    pub(super) is_endless: bool,
    /// A version, and its thumbnail.
    pub(in crate::app) version: Option<(u64, Capture)>,
    /// The number of a picture, and the texels at its inspected pixel.
    pub(in crate::app) texels: Option<(u64, Vec<Texel>)>,
    /// Numbers of pictures, and values of modes there.
    pub(in crate::app) values: Vec<(u64, Vec<(String, PixelValue)>)>,
}
