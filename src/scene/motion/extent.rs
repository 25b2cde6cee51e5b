//! Where a model is while a clip plays, so that the camera stands still and lights keep their distance.

use std::collections::HashSet;
use std::sync::Arc;

use glam::{Mat4, Vec3};
use rayon::prelude::*;

use super::pose::{Playing, Pose};
use crate::scene::model::{Bounds, Model, Primitive};
use crate::scene::outline::{MOST_INSTANCES, hull, used_vertices};

/// Bounds and hull points.
#[derive(Clone, Debug, Default)]
pub struct Extent {
    /// World bounds.
    pub bounds: Bounds,
    /// The outermost points, world space.
    pub outline: Arc<[Vec3]>,
}

/// Moments of a clip that are looked at.
const MOST_MOMENTS: usize = 64;
/// Vertices that are deformed for all moments of all clips. Of larger models fewer moments are looked at, and then fewer vertices.
const MOST_VERTICES: usize = 1 << 22;
/// The least number of moments.
const LEAST_MOMENTS: usize = 8;
/// Most coordinates, meters: beyond it is a mistake of the file.
const LARGEST: f32 = 1e15;

/// The points of a primitive that are followed: places that only move with their instance, or vertices that are deformed.
enum Points {
    Fixed(Vec<Vec3>),
    Deformed(Vec<u32>),
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

    /// The extent of a model in its own pose.
    pub fn at_rest(model: &Model) -> Self {
        Self::during(model, &points(model, MOST_VERTICES), &[model.rest_pose()])
    }

    /// The extent of a model while a clip plays.
    pub fn of_clip(model: &Model, clip: usize) -> Self {
        let duration_s = f64::from(model.motion.clips[clip].duration_s);
        let most = MOST_VERTICES / model.motion.clips.len();
        let moments = (most / deformed_vertices(model).max(1)).clamp(LEAST_MOMENTS, MOST_MOMENTS);
        let pose = |moment: usize| {
            let time_s = duration_s * moment as f64 / (moments - 1) as f64;
            model.pose_at(&[Playing { clip, weight: 1.0, time_s }], None)
        };
        let poses: Vec<Pose> = (0..moments).into_par_iter().map(pose).collect();
        Self::during(model, &points(model, most / moments), &poses)
    }

    fn during(model: &Model, points: &[Points], poses: &[Pose]) -> Self {
        let moment = |pose: &Pose| {
            let placed = placed(model, points, pose);
            let mut bounds = Bounds::default();
            placed.iter().for_each(|point| bounds.include(*point));
            Self { bounds, outline: hull(&placed).into() }
        };
        let moments: Vec<Self> = poses.par_iter().map(moment).collect();
        let all = Self::of_all(&moments.iter().collect::<Vec<_>>());
        Self { outline: hull(&all.outline).into(), ..all }
    }
}

/// Vertices of all instances that joints or morph targets move.
fn deformed_vertices(model: &Model) -> usize {
    let primitives = model.instances.iter().map(|instance| &model.primitives[instance.primitive]);
    primitives.filter(|primitive| primitive.deformation.is_some()).map(|primitive| primitive.vertices.len()).sum()
}

/// The points of each primitive. About `most` vertices of instances are deformed.
fn points(model: &Model, most: usize) -> Vec<Points> {
    let stride = deformed_vertices(model).div_ceil(most.max(1)).max(1);
    let is_large = model.instances.len() > MOST_INSTANCES;
    let used: HashSet<usize> = model.instances.iter().map(|instance| instance.primitive).collect();
    let of = |(index, primitive): (usize, &Primitive)| match &primitive.deformation {
        _ if !used.contains(&index) => Points::Fixed(Vec::new()),
        Some(_) => Points::Deformed(used_vertices(primitive).step_by(stride).collect()),
        None if is_large => Points::Fixed(primitive.bounds.corners().to_vec()),
        None => {
            let position = |index| Vec3::from(primitive.vertices[index as usize].position);
            Points::Fixed(hull(&used_vertices(primitive).map(position).collect::<Vec<_>>()))
        }
    };
    model.primitives.par_iter().enumerate().map(of).collect()
}

/// World positions of the points of all instances in a pose.
fn placed(model: &Model, points: &[Points], pose: &Pose) -> Vec<Vec3> {
    let mut placed = Vec::new();
    for (instance, world) in model.instances.iter().zip(&pose.instances) {
        let primitive = &model.primitives[instance.primitive];
        match (&points[instance.primitive], &primitive.deformation) {
            (Points::Deformed(indices), Some(deformation)) => {
                let (joints, weights) = pose.deformers(instance, deformation);
                placed.extend(indices.iter().map(|index| {
                    let index = *index as usize;
                    world.transform_point3(deformation.position(index, &primitive.vertices[index], joints, weights))
                }));
            }
            (Points::Fixed(points), _) => placed.extend(points.iter().map(|point| world.transform_point3(*point))),
            (Points::Deformed(_), None) => {}
        }
    }
    placed.retain(|point| point.abs().max_element() <= LARGEST);
    placed
}
