//! Clips: animations of a file, and what they move.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::curve::Curve;
use super::extent::Extent;

/// An animation of the file.
#[derive(Clone, Debug, Default)]
pub struct Clip {
    /// Name, or empty.
    pub name: String,
    /// Its channels, each of which moves one target.
    pub channels: Vec<Channel>,
    /// Time of its last key, seconds.
    pub duration_s: f32,
    /// Where the model is while it plays.
    pub extent: Extent,
}

impl Clip {
    /// How many nodes it shows and hides.
    pub fn switched_nodes(&self) -> usize {
        let node = |channel: &Channel| match channel.target {
            Target::Visible(node) => Some(node),
            _ => None,
        };
        self.channels.iter().filter_map(node).collect::<BTreeSet<usize>>().len()
    }
}

/// A curve, and what follows it.
#[derive(Clone, Debug)]
pub struct Channel {
    /// The property that follows it.
    pub target: Target,
    /// Values over time, with as many numbers as the target takes.
    pub curve: Arc<Curve>,
}

/// The property that a channel moves. Nodes are indices into the nodes of the `Rig`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Translation of a node.
    Translation(usize),
    /// Rotation of a node.
    Rotation(usize),
    /// Scale of a node.
    Scale(usize),
    /// Whether a node is visible: another value than 0 shows it, as far as the nodes above it are visible.
    Visible(usize),
    /// Weights of morph targets: as many as the curve has, from this index into `Pose::weights` on.
    Weights(usize),
    /// Numbers of an entry of `Motion::values`, from the given one on.
    Values(usize, usize),
}
