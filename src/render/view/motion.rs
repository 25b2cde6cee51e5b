//! The model of a view in the pose of each frame.

use std::sync::Arc;

use crate::render::bound_frame::BoundFrame;
use crate::render::scene::PlacedScene;
use crate::scene::Pose;

/// Places the model of each frame. While nothing moves, the places of the last frame stay.
#[derive(Default)]
pub(super) struct Motion {
    placed: Option<(Arc<Pose>, Arc<PlacedScene>)>,
}

impl Motion {
    /// The model as [`Motion::place`] has placed it last.
    pub(super) fn placed(&self) -> Option<&PlacedScene> {
        self.placed.as_ref().map(|(_, placed)| &**placed)
    }

    /// The model in the pose of the frame; `None` for a frame without a model.
    pub(super) fn place(&mut self, frame: &BoundFrame) -> Option<Arc<PlacedScene>> {
        let (scene, pose) = (frame.scene.as_ref()?, frame.state.scene.as_ref()?.pose());
        let is_same = |of: &Arc<Pose>, placed: &PlacedScene| Arc::ptr_eq(of, pose) && Arc::ptr_eq(&placed.scene, scene);
        match &self.placed {
            Some((of, placed)) if is_same(of, placed) => Some(placed.clone()),
            _ => {
                let placed = Arc::new(PlacedScene::new(scene, pose));
                self.placed = Some((pose.clone(), placed.clone()));
                Some(placed)
            }
        }
    }
}
