//! Where the draws of a scene are in one frame. The list of draws stays while the model moves; a pose adds the matrices, the
//! winding and the centers.

use std::sync::Arc;

use glam::{Mat3, Mat4, Vec3};

use super::{GpuDraw, GpuScene};
use crate::gpu::vk;
use crate::interface::Draw;
use crate::scene::Pose;

/// The part of a draw that depends on the pose.
pub(crate) struct Placement {
    pub(crate) push: Draw,
    pub(crate) front_face: vk::FrontFace,
    pub(crate) center_ws: Vec3,
}

impl Placement {
    fn new(draw: &GpuDraw, pose: &Pose) -> Self {
        let world = pose.instances.get(draw.instance).copied().unwrap_or(Mat4::IDENTITY);
        let linear = Mat3::from_mat4(world);
        Self {
            push: Draw {
                world_from_object: world.to_cols_array_2d().map(|c| [c[0], c[1], c[2]]),
                normal_ws_from_object: normals_from(linear).to_cols_array_2d(),
                ..draw.push
            },
            front_face: front_face(linear.determinant()),
            center_ws: world.transform_point3(draw.center),
        }
    }
}

/// A transform that mirrors flips the winding.
fn front_face(determinant: f32) -> vk::FrontFace {
    if determinant < 0.0 { vk::FrontFace::CLOCKWISE } else { vk::FrontFace::COUNTER_CLOCKWISE }
}

/// A draw with its place in a frame.
#[derive(Clone, Copy)]
pub(crate) struct PlacedDraw<'a> {
    pub(crate) draw: &'a GpuDraw,
    pub(crate) placement: &'a Placement,
}

/// A scene in the pose of a frame.
pub(crate) struct PlacedScene {
    pub(crate) scene: Arc<GpuScene>,
    /// Of each entry of [`GpuScene::draws`].
    placements: Vec<Placement>,
}

impl PlacedScene {
    pub(crate) fn new(scene: &Arc<GpuScene>, pose: &Pose) -> Self {
        let placements = scene.draws.iter().map(|draw| Placement::new(draw, pose)).collect();
        Self { scene: scene.clone(), placements }
    }

    pub(crate) fn draws(&self) -> impl Iterator<Item = PlacedDraw<'_>> {
        let draws = self.scene.draws.iter().zip(&self.placements);
        draws.map(|(draw, placement)| PlacedDraw { draw, placement })
    }
}

/// Transforms normals as `linear` transforms positions. The result is not normalized.
///
/// The cofactor matrix is the inverse transpose times the determinant. Unlike the inverse, it also exists for a flattened
/// object. Only the sign of the determinant matters.
pub(crate) fn normals_from(linear: Mat3) -> Mat3 {
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}
