//! Where a model is while a clip plays, so that the camera stands still and lights keep their distance.

use std::sync::Arc;

use glam::{Mat4, Vec3};

use crate::scene::bounds::Bounds;

/// Bounds and hull points.
#[derive(Clone, Debug, Default)]
pub struct Extent {
    /// World bounds.
    pub bounds: Bounds,
    /// The outermost points, world space.
    pub outline: Arc<[Vec3]>,
}

impl Extent {
    /// The smallest extent that holds all of these.
    pub fn of_all(extents: &[&Self]) -> Self {
        if let [extent] = extents {
            return (*extent).clone();
        }
        let mut bounds = Bounds::default();
        for corner in
            extents.iter().filter(|extent| !extent.bounds.is_empty()).flat_map(|extent| extent.bounds.corners())
        {
            bounds.include(corner);
        }
        Self { bounds, outline: extents.iter().flat_map(|extent| extent.outline.iter().copied()).collect() }
    }

    /// The extent moved by a transform.
    #[must_use]
    pub fn placed(&self, transform: Mat4) -> Self {
        let mut bounds = Bounds::default();
        if !self.bounds.is_empty() {
            self.bounds.corners().iter().for_each(|corner| bounds.include(transform.transform_point3(*corner)));
        }
        Self { bounds, outline: self.outline.iter().map(|point| transform.transform_point3(*point)).collect() }
    }
}
