//! The model of a view in the pose of each frame, and where it was in the frame before.
//!
//! `deform.comp` moves the vertices of instances with joints or morph targets when the pose changes. The moved vertices have two
//! buffers, since stages that tell how far the surface has moved read those of the frame before, too.

use std::sync::Arc;

use super::moved_vertices::MovedVertices;
use crate::gpu::{Buffer, DescriptorSet, Encoder, Gpu, GpuError, SetLayouts};
use crate::render::bound_frame::BoundFrame;
use crate::render::compute::write_addressed;
use crate::render::scene::{PlacedScene, Posed};
use crate::scene::Model;

/// Places the model of each frame. While nothing moves, the places of the last frame stay.
pub(super) struct Motion {
    gpu: Arc<Gpu>,
    moved: MovedVertices,
    /// For each frame slot, the places in the frame before.
    befores: Vec<Option<Arc<Buffer>>>,
    /// The model that was loaded, in the pose of the last frame.
    placed: Option<(Arc<Model>, Arc<PlacedScene>)>,
    /// Whether the next frame has no frame before it.
    begins: bool,
}

impl Motion {
    pub(super) fn new(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, slots: usize) -> Self {
        let moved = MovedVertices::new(gpu, layouts, slots);
        Self { gpu: gpu.clone(), moved, befores: vec![None; slots], placed: None, begins: true }
    }

    /// The model as [`Motion::place`] has placed it last.
    pub(super) fn placed(&self) -> Option<&Arc<PlacedScene>> {
        self.placed.as_ref().map(|(_, placed)| placed)
    }

    /// The model in the pose of the frame; `None` for a frame without a model. If the frame `follows` the last one, the draws know
    /// where they were. Records the dispatch that moves vertices, if the pose is new. SYNC: after the slot's fence.
    pub(super) fn place(
        &mut self,
        encoder: &mut Encoder,
        slot: usize,
        frame: &BoundFrame,
        frame_set: &Arc<DescriptorSet>,
        follows: bool,
    ) -> Result<Option<Arc<PlacedScene>>, GpuError> {
        let (Some(scene), Some(state)) = (&frame.scene, &frame.state.scene) else {
            self.placed = None;
            return Ok(None);
        };
        let follows = follows && !std::mem::take(&mut self.begins);
        let vertices = self.moved.of(encoder, slot, frame, frame_set)?;
        let posed = Posed { model: state.model().clone(), vertices };
        let last = self.placed.take().filter(|(loaded, _)| Arc::ptr_eq(loaded, state.loaded())).map(|(_, last)| last);
        let from =
            last.as_ref().map(|last| last.posed()).filter(|from| follows && !Arc::ptr_eq(&from.model, &posed.model));
        let is_same =
            |last: &PlacedScene| Arc::ptr_eq(&last.scene, scene) && last.posed().is_same(&posed) && !last.has_moved();
        let placed = match (&last, from) {
            (Some(last), None) if is_same(last) => last.clone(),
            (_, None) => Arc::new(PlacedScene::new(scene, posed).with_records()?),
            (_, Some(from)) => Arc::new(self.after(slot, PlacedScene::new(scene, posed), from)?.with_records()?),
        };
        self.placed = Some((state.loaded().clone(), placed.clone()));
        Ok(Some(placed))
    }

    /// Adds the places in the pose of the frame before.
    fn after(&mut self, slot: usize, placed: PlacedScene, from: &Posed) -> Result<PlacedScene, GpuError> {
        let places = placed.places_in(from);
        if places.is_empty() {
            return Ok(placed);
        }
        let bytes: &[u8] = bytemuck::cast_slice(&places);
        let buffer = write_addressed(&self.gpu, "places in the frame before", &mut self.befores[slot], bytes)?;
        Ok(placed.with_before(from, &places, &buffer))
    }

    /// Whether the last frame shows that the model has moved.
    pub(super) fn has_moved(&self) -> bool {
        self.placed().is_some_and(|placed| placed.has_moved())
    }

    /// Makes the next frame begin anew, without a frame before it. A model in the same pose stays, and with it what passes keep of it.
    pub(super) fn restart(&mut self) {
        self.begins = true;
    }

    /// Makes the next frame move all vertices again: the commands of a frame were not submitted.
    pub(super) fn forget(&mut self) {
        self.placed = None;
        self.moved.forget();
    }
}
