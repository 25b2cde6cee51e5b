//! The instances of a model whose vertices joints or morph targets move. Each has moved vertices of its own.

use std::sync::Arc;

use glam::Mat4;
use rayon::prelude::*;

use super::upload::{Deformers, Range};
use crate::gpu::Buffer;
use crate::interface::{Deformation, Displacement, Influence, Vertex};
use crate::scene::{Bounds, Instance, Model, Pose, Primitive, Reach};

/// Most vertices of a primitive that can move: 65,535 workgroups of 64, which every device can start.
const MOST_VERTICES: usize = 65_535 * 64;

/// The instances of a model whose vertices move.
pub(crate) struct Deformables {
    /// Vertices, influences and displacements, to which the records point.
    _kept: [Arc<Buffer>; 3],
    /// In the order of the instances.
    parts: Vec<Part>,
    /// Moved vertices of all instances.
    vertices: u64,
}

/// An instance whose vertices move.
struct Part {
    /// Index into `Model::instances`.
    instance: usize,
    /// The part that does not depend on the pose.
    record: Deformation,
    /// The number of its first moved vertex.
    first_vertex: u64,
    /// Its joints in `Pose::joints`.
    joints: std::ops::Range<usize>,
    /// Its weights in `Pose::weights`.
    weights: std::ops::Range<usize>,
    reach: Arc<Reach>,
}

impl Deformables {
    /// `None` if no vertices move.
    pub(super) fn new(model: &Model, ranges: &[Range], vertices: &Arc<Buffer>, from: Deformers) -> Option<Arc<Self>> {
        let Deformers { influences, displacements } = from;
        let (mut at_influence, mut at_displacement) = (influences.address(), displacements.address());
        let mut records = Vec::new();
        for (primitive, range) in model.primitives.iter().zip(ranges) {
            let (count, deformation) = (primitive.vertices.len(), primitive.deformation.as_deref());
            if deformation.is_some() && count > MOST_VERTICES {
                tracing::warn!("a primitive of {count} vertices does not move: at most {MOST_VERTICES} can");
            }
            let per_vertex = deformation.map_or(0, |deformation| deformation.influences_per_vertex);
            let targets = deformation.map_or(0, |deformation| deformation.targets.len());
            let of = |_| Deformation {
                vertices: vertices.address() + range.first_vertex * size_of::<Vertex>() as u64,
                influences: at_influence,
                displacements: at_displacement,
                vertex_count: count as u32,
                influences_per_vertex: per_vertex as u32,
                target_count: targets as u32,
                attributes: primitive.attributes,
                ..Deformation::default()
            };
            records.push(deformation.filter(|_| count <= MOST_VERTICES).map(|from| (of(from), primitive)));
            at_influence += (per_vertex * count * size_of::<Influence>()) as u64;
            at_displacement += (targets * count * size_of::<Displacement>()) as u64;
        }
        let reach = |(_, primitive): &(Deformation, &Primitive)| {
            let deformation = primitive.deformation.as_deref()?;
            Some(Arc::new(Reach::new(&primitive.vertices, deformation)))
        };
        let reaches: Vec<Option<Arc<Reach>>> = records.par_iter().map(|moved| reach(moved.as_ref()?)).collect();
        let (mut parts, mut first_vertex) = (Vec::new(), 0);
        for (index, instance) in model.instances.iter().enumerate() {
            let (Some((record, _)), Some(reach)) = (records[instance.primitive], &reaches[instance.primitive]) else {
                continue;
            };
            if let Some(part) = Part::new(model, (index, instance), (record, reach), first_vertex) {
                first_vertex += u64::from(part.record.vertex_count);
                parts.push(part);
            }
        }
        let kept = [vertices.clone(), influences, displacements];
        (!parts.is_empty()).then(|| Arc::new(Self { _kept: kept, parts, vertices: first_vertex }))
    }

    /// Bytes of the moved vertices.
    pub(crate) fn bytes(&self) -> u64 {
        self.vertices * size_of::<Vertex>() as u64
    }

    /// Number of instances, and vertices of the largest.
    pub(crate) fn size(&self) -> (u32, u32) {
        let most = self.parts.iter().map(|part| part.record.vertex_count).max();
        (self.parts.len() as u32, most.unwrap_or_default())
    }

    /// Whether the pose has all joints and weights.
    pub(crate) fn fits(&self, pose: &Pose) -> bool {
        let fits = |part: &Part| part.joints.end <= pose.joints.len() && part.weights.end <= pose.weights.len();
        self.parts.iter().all(fits)
    }

    /// The content of `BINDING_DEFORMATIONS`, given the addresses of the moved vertices, of the joints and of the weights.
    pub(crate) fn records(&self, [moved, joints, weights]: [u64; 3]) -> Vec<Deformation> {
        let record = |part: &Part| Deformation {
            moved: moved + part.offset(),
            joints: joints + (part.joints.start * size_of::<Mat4>()) as u64,
            weights: weights + (part.weights.start * size_of::<f32>()) as u64,
            ..part.record
        };
        self.parts.iter().map(record).collect()
    }

    /// The place of the first vertex of an instance among the moved ones, bytes; `None` if its vertices do not move.
    pub(crate) fn offset(&self, instance: usize) -> Option<u64> {
        self.of_instance(instance).map(Part::offset)
    }

    /// Bounds of the moved vertices of an instance in a pose that [`Deformables::fits`]; `None` if its vertices do not move.
    pub(crate) fn bounds(&self, instance: usize, pose: &Pose) -> Option<Bounds> {
        let part = self.of_instance(instance)?;
        Some(part.reach.bounds(&pose.joints[part.joints.clone()], &pose.weights[part.weights.clone()]))
    }

    fn of_instance(&self, instance: usize) -> Option<&Part> {
        self.parts.binary_search_by_key(&instance, |part| part.instance).ok().map(|part| &self.parts[part])
    }
}

impl Part {
    /// `None` if neither joints nor weights belong to the instance.
    fn new(
        model: &Model,
        (index, instance): (usize, &Instance),
        (record, reach): (Deformation, &Arc<Reach>),
        first_vertex: u64,
    ) -> Option<Self> {
        let deformation = model.primitives[instance.primitive].deformation.as_deref()?;
        let first_joint = instance.first_joint.filter(|_| record.influences_per_vertex > 0);
        let first_weight = instance.first_weight.filter(|_| record.target_count > 0);
        let of_skin = if first_joint.is_some() { &*deformation.influences } else { &[] };
        let joints = of_skin.iter().map(|influence| influence.joint as usize + 1).max().unwrap_or_default();
        let weights = if first_weight.is_some() { record.target_count } else { 0 };
        let influences_per_vertex = if joints > 0 { record.influences_per_vertex } else { 0 };
        let from = |first: Option<u32>| first.unwrap_or_default() as usize;
        (joints > 0 || weights > 0).then(|| Self {
            instance: index,
            record: Deformation { influences_per_vertex, target_count: weights, ..record },
            first_vertex,
            joints: from(first_joint)..from(first_joint) + joints,
            weights: from(first_weight)..from(first_weight) + weights as usize,
            reach: reach.clone(),
        })
    }

    fn offset(&self) -> u64 {
        self.first_vertex * size_of::<Vertex>() as u64
    }
}
