//! A model in its own pose, right after it was read.

use std::sync::Arc;

use crate::scene::model::Model;
use crate::scene::motion::{Extent, Hidden};
use crate::scene::outline::outline;

impl Model {
    /// The model in its own pose. Finds where it is then, and while each clip plays.
    #[must_use]
    pub fn settled(mut self) -> Self {
        let is_deformed =
            self.instances.iter().any(|instance| instance.first_joint.or(instance.first_weight).is_some());
        let rig = &self.motion.rig;
        let extent = if is_deformed || !Hidden::new(rig, rig.hidden_nodes()).is_empty() {
            Extent::at_rest(&self)
        } else {
            Extent { bounds: self.instance_bounds(), outline: outline(&self).into() }
        };
        let extents: Vec<Extent> = (0..self.motion.clips.len()).map(|clip| Extent::of_clip(&self, clip)).collect();
        let motion = Arc::make_mut(&mut self.motion);
        motion.clips.iter_mut().zip(extents).for_each(|(clip, extent)| clip.extent = extent);
        self.posed(&self.rest_pose().into(), &extent)
    }
}
