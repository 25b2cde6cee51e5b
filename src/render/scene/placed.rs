//! Where the draws of a scene are in one frame. The list of draws stays while the model moves; a pose adds the matrices, the
//! vertices that it has moved, the winding and the centers.

use std::sync::{Arc, Mutex, PoisonError};

use glam::{Mat3, Mat4, Vec3};

use super::deformables::Moved;
use super::{GpuDraw, GpuScene};
use crate::gpu::{Buffer, vk};
use crate::interface::{ATTRIBUTE_MOVED, Before, Draw};
use crate::scene::Model;

/// The part of a draw that depends on the pose.
pub(crate) struct Placement {
    pub(crate) push: Draw,
    pub(crate) front_face: vk::FrontFace,
    pub(crate) center_ws: Vec3,
}

/// A draw with its place in a frame.
#[derive(Clone, Copy)]
pub(crate) struct PlacedDraw<'a> {
    pub(crate) draw: &'a GpuDraw,
    pub(crate) placement: &'a Placement,
}

/// The model in a pose, and the vertices that the pose has moved if there are any.
#[derive(Clone)]
pub(crate) struct Posed {
    pub(crate) model: Arc<Model>,
    pub(crate) vertices: Option<Arc<Buffer>>,
}

/// A scene in the pose of a frame.
pub(crate) struct PlacedScene {
    pub(crate) scene: Arc<GpuScene>,
    posed: Posed,
    /// The pose of the frame before, and the places of the draws in it. `None` if nothing has moved.
    before: Option<(Posed, Arc<Buffer>)>,
    /// Of each entry of [`GpuScene::draws`].
    placements: Vec<Placement>,
    /// Indices of the draws, as they were sorted last: while the camera moves little, they are nearly sorted.
    order: Mutex<Vec<u32>>,
}

impl Posed {
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let vertices = [self, other].map(|posed| posed.vertices.as_ref().map(Arc::as_ptr));
        Arc::ptr_eq(&self.model, &other.model) && vertices[0] == vertices[1]
    }

    /// The object to world transform of a draw.
    fn world(&self, draw: &GpuDraw) -> Mat4 {
        self.model.instances.get(draw.instance).map_or(Mat4::IDENTITY, |instance| instance.world_from_object)
    }

    /// The moved vertices of a draw; `None` if it has none.
    fn moved(&self, scene: &GpuScene, draw: &GpuDraw) -> Option<Moved> {
        self.vertices.as_ref().and(scene.deformables.as_ref())?.of_instance(draw.instance, &self.model.pose)
    }

    fn place(&self, scene: &GpuScene, draw: &GpuDraw, address: Option<u64>) -> Before {
        let moved = address.zip(self.moved(scene, draw));
        Before {
            vertices: moved.map_or(draw.push.vertices, |(address, moved)| address + moved.offset),
            world_from_object: self.world(draw).to_cols_array_2d().map(|c| [c[0], c[1], c[2]]),
        }
    }

    fn address(&self) -> Option<u64> {
        self.vertices.as_ref().map(|vertices| vertices.address())
    }
}

impl PlacedScene {
    pub(crate) fn new(scene: &Arc<GpuScene>, posed: Posed) -> Self {
        let address = posed.address();
        let place = |draw: &GpuDraw| {
            let (Before { vertices, world_from_object }, world) =
                (posed.place(scene, draw, address), posed.world(draw));
            let linear = Mat3::from_mat4(world);
            let skin = posed.moved(scene, draw).and_then(|moved| moved.skin);
            let center = skin.map_or(draw.center, |skin| skin.transform_point3(draw.center));
            let normal_ws_from_object = normals_from(linear).to_cols_array_2d();
            Placement {
                push: Draw { vertices, world_from_object, normal_ws_from_object, ..draw.push },
                // A transform that mirrors flips the winding.
                front_face: match linear.determinant() < 0.0 {
                    true => vk::FrontFace::CLOCKWISE,
                    false => vk::FrontFace::COUNTER_CLOCKWISE,
                },
                center_ws: world.transform_point3(center),
            }
        };
        let placements: Vec<Placement> = scene.draws.iter().map(place).collect();
        let order = Mutex::new((0..placements.len() as u32).collect());
        Self { scene: scene.clone(), posed, before: None, placements, order }
    }

    /// The places of all draws in another pose. Empty if none of them has moved.
    pub(crate) fn places_in(&self, other: &Posed) -> Vec<Before> {
        let address = other.address();
        let places = self.scene.draws.iter().map(|draw| other.place(&self.scene, draw, address));
        let places: Vec<Before> = places.collect();
        let is_same = self.placements.iter().zip(&places).all(|(now, before)| !now.has_moved(before));
        if is_same { Vec::new() } else { places }
    }

    /// Lets the draws that have moved read the places in the frame before, which `buffer` holds.
    pub(crate) fn with_before(mut self, posed: &Posed, places: &[Before], buffer: &Arc<Buffer>) -> Self {
        let mut address = buffer.address();
        for (now, before) in self.placements.iter_mut().zip(places) {
            if now.has_moved(before) {
                now.push.attributes |= ATTRIBUTE_MOVED;
                now.push.before = address;
            }
            address += size_of::<Before>() as u64;
        }
        self.before = Some((posed.clone(), buffer.clone()));
        self
    }

    /// The pose and its vertices.
    pub(crate) fn posed(&self) -> &Posed {
        &self.posed
    }

    /// Whether a draw has moved since the frame before.
    pub(crate) fn has_moved(&self) -> bool {
        self.before.is_some()
    }

    /// The draws by the distance of their centers from a point; those at equal distances in the order of the scene.
    pub(crate) fn front_to_back(&self, eye: Vec3) -> Vec<PlacedDraw<'_>> {
        let distance = |placement: &Placement| placement.center_ws.distance_squared(eye);
        let distances: Vec<f32> = self.placements.iter().map(distance).collect();
        let mut order = self.order.lock().unwrap_or_else(PoisonError::into_inner);
        order.sort_by(|a, b| distances[*a as usize].total_cmp(&distances[*b as usize]).then(a.cmp(b)));
        let placed = |index: &u32| (&self.scene.draws[*index as usize], &self.placements[*index as usize]);
        order.iter().map(placed).map(|(draw, placement)| PlacedDraw { draw, placement }).collect()
    }

    pub(crate) fn draws(&self) -> impl Iterator<Item = PlacedDraw<'_>> {
        let draws = self.scene.draws.iter().zip(&self.placements);
        draws.map(|(draw, placement)| PlacedDraw { draw, placement })
    }
}

impl Placement {
    fn has_moved(&self, before: &Before) -> bool {
        (self.push.vertices, self.push.world_from_object) != (before.vertices, before.world_from_object)
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
