//! Where the draws of a scene are in one frame. The list of draws stays while the model moves; a pose adds the matrices, the
//! vertices that it has moved, the winding and the bounds.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{Mat3, Mat4, Vec3};
use rayon::prelude::*;

use super::GpuScene;
use super::deformables::Deformables;
use super::draw_list::DrawLists;
use super::frustum::Spheres;
use super::gpu_draw::GpuDraw;
use crate::gpu::{Buffer, GpuError, vk};
use crate::interface::{ATTRIBUTE_MOVED, Before, Draw};
use crate::scene::Model;

/// Draws that one thread places at once.
const AT_ONCE: usize = 1024;

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
    /// Of each entry of [`GpuScene::draws`]: what its stages read.
    pushes: Vec<Draw>,
    /// Around each draw.
    spheres: Spheres,
    lists: Arc<DrawLists>,
    /// The content of `pushes`, if stages find their draw in a buffer.
    records: Option<Arc<Buffer>>,
    /// Indices of the draws, as they were sorted last: while the camera moves little, they are nearly sorted.
    order: Mutex<Vec<u32>>,
}

/// The part of a draw that depends on the pose.
struct Placement {
    push: Draw,
    is_mirrored: bool,
    center_ws: Vec3,
    radius: f32,
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

    /// The instances whose vertices the pose moves.
    fn deformables<'a>(&self, scene: &'a GpuScene) -> Option<&'a Deformables> {
        self.vertices.as_ref().and(scene.deformables.as_deref())
    }

    fn place(&self, scene: &GpuScene, draw: &GpuDraw, address: Option<u64>) -> Before {
        let moved = address.zip(self.deformables(scene).and_then(|all| all.offset(draw.instance)));
        Before {
            vertices: moved.map_or(draw.push.vertices, |(address, offset)| address + offset),
            world_from_object: self.world(draw).to_cols_array_2d().map(|c| [c[0], c[1], c[2]]),
        }
    }

    fn placement(&self, scene: &GpuScene, draw: &GpuDraw, address: Option<u64>) -> Placement {
        let (Before { vertices, world_from_object }, world) = (self.place(scene, draw, address), self.world(draw));
        let linear = Mat3::from_mat4(world);
        let moved = self.deformables(scene).and_then(|all| all.bounds(draw.instance, &self.model.pose));
        let (center, half_size) =
            moved.map_or((draw.center, draw.half_size), |bounds| (bounds.center(), bounds.max - bounds.center()));
        let normal_ws_from_object = normals_from(linear).to_cols_array_2d();
        Placement {
            push: Draw { vertices, world_from_object, normal_ws_from_object, ..draw.push },
            // A transform that mirrors flips the winding.
            is_mirrored: linear.determinant() < 0.0,
            center_ws: world.transform_point3(center),
            radius: (abs(linear) * half_size).length(),
        }
    }

    fn address(&self) -> Option<u64> {
        self.vertices.as_ref().map(|vertices| vertices.address())
    }
}

impl PlacedScene {
    pub(crate) fn new(scene: &Arc<GpuScene>, posed: Posed) -> Self {
        let address = posed.address();
        let draws = scene.draws.par_iter().with_min_len(AT_ONCE);
        let placements: Vec<Placement> = draws.map(|draw| posed.placement(scene, draw, address)).collect();
        let mut spheres = Spheres::with_capacity(placements.len());
        placements.iter().for_each(|placement| spheres.push(placement.center_ws, placement.radius));
        let hides = &posed.model.pose.hidden;
        let hidden = match hides.is_empty() {
            true => Vec::new(),
            false => scene.draws.iter().map(|draw| hides.instance(draw.instance)).collect(),
        };
        let lists = scene.lists(placements.iter().map(|placement| placement.is_mirrored).collect(), hidden);
        let pushes: Vec<Draw> = placements.into_iter().map(|placement| placement.push).collect();
        let order = Mutex::new((0..pushes.len() as u32).collect());
        Self { scene: scene.clone(), posed, before: None, pushes, spheres, lists, records: None, order }
    }

    /// The places of all draws in another pose. Empty if none of them has moved.
    pub(crate) fn places_in(&self, other: &Posed) -> Vec<Before> {
        let address = other.address();
        let draws = self.scene.draws.par_iter().with_min_len(AT_ONCE);
        let places: Vec<Before> = draws.map(|draw| other.place(&self.scene, draw, address)).collect();
        let is_same = self.pushes.iter().zip(&places).all(|(now, before)| !has_moved(now, before));
        if is_same { Vec::new() } else { places }
    }

    /// Lets the draws that have moved read the places in the frame before, which `buffer` holds.
    pub(crate) fn with_before(mut self, posed: &Posed, places: &[Before], buffer: &Arc<Buffer>) -> Self {
        let mut address = buffer.address();
        for (now, before) in self.pushes.iter_mut().zip(places) {
            if has_moved(now, before) {
                now.attributes |= ATTRIBUTE_MOVED;
                now.before = address;
            }
            address += size_of::<Before>() as u64;
        }
        self.before = Some((posed.clone(), buffer.clone()));
        self
    }

    /// The same with the draws in a buffer for the device, if its stages find them there.
    ///
    /// # Errors
    /// Out of memory.
    pub(crate) fn with_records(mut self) -> Result<Self, GpuError> {
        let content = bytemuck::cast_slice(&self.pushes);
        self.records = self.scene.buffers.as_ref().map(|buffers| buffers.filled(content)).transpose()?;
        Ok(self)
    }

    /// The pose and its vertices.
    pub(crate) fn posed(&self) -> &Posed {
        &self.posed
    }

    /// Whether a draw has moved since the frame before.
    pub(crate) fn has_moved(&self) -> bool {
        self.before.is_some()
    }

    /// The content of `draw` in the stages of a draw.
    pub(crate) fn push(&self, draw: u32) -> &Draw {
        &self.pushes[draw as usize]
    }

    /// The device address of what the stages of all draws read.
    pub(crate) fn records(&self) -> Option<u64> {
        self.records.as_ref().map(|records| records.address())
    }

    /// The winding of a draw's front faces.
    pub(crate) fn front_face(&self, draw: u32) -> vk::FrontFace {
        match self.lists.mirrored[draw as usize] {
            true => vk::FrontFace::CLOCKWISE,
            false => vk::FrontFace::COUNTER_CLOCKWISE,
        }
    }

    /// The draws in lists.
    pub(crate) fn lists(&self) -> &DrawLists {
        &self.lists
    }

    /// All draws that the pose does not hide, and what their stages read.
    pub(crate) fn draws(&self) -> impl Iterator<Item = (&GpuDraw, &Draw)> {
        let numbered = (0..).zip(self.scene.draws.iter().zip(&self.pushes));
        numbered.filter(|(number, _)| !self.lists.hides(*number)).map(|(_, draw)| draw)
    }

    pub(super) fn spheres(&self) -> &Spheres {
        &self.spheres
    }

    pub(super) fn order(&self) -> MutexGuard<'_, Vec<u32>> {
        self.order.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn has_moved(now: &Draw, before: &Before) -> bool {
    (now.vertices, now.world_from_object) != (before.vertices, before.world_from_object)
}

fn abs(linear: Mat3) -> Mat3 {
    Mat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs())
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
