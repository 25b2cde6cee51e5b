//! The parts of a model that nodes hide (KHR_node_visibility).

use super::rig::Rig;

/// The parts of a model that are hidden: their node hides itself, or one above it does. Cameras never are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hidden {
    /// Of each entry of `Model::instances`; empty if none is hidden.
    instances: Vec<bool>,
    /// Of each entry of `Model::lights`; empty if none is hidden.
    lights: Vec<bool>,
}

impl Hidden {
    /// The parts that are hidden while these nodes of the rig hide themselves.
    pub fn new(rig: &Rig, mut nodes: Vec<bool>) -> Self {
        if !nodes.contains(&true) {
            return Self::default();
        }
        // Parents come first.
        for (at, node) in rig.nodes.iter().enumerate() {
            nodes[at] |= node.parent.is_some_and(|parent| nodes[parent]);
        }
        let some = |hidden: Vec<bool>| if hidden.contains(&true) { hidden } else { Vec::new() };
        Self {
            instances: some(rig.instances.iter().map(|placement| nodes[placement.node]).collect()),
            lights: some(rig.lights.iter().map(|(node, _)| nodes[*node]).collect()),
        }
    }

    /// Whether nothing is hidden.
    pub fn is_empty(&self) -> bool {
        self.instances.is_empty() && self.lights.is_empty()
    }

    /// Whether an entry of `Model::instances` is hidden.
    pub fn instance(&self, index: usize) -> bool {
        self.instances.get(index) == Some(&true)
    }

    /// Whether an entry of `Model::lights` is hidden.
    pub fn light(&self, index: usize) -> bool {
        self.lights.get(index) == Some(&true)
    }
}
