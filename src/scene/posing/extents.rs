//! Finds where a model is in its own pose and while its clips play.

use std::collections::HashSet;

use glam::Vec3;
use rayon::prelude::*;

use super::pose::SWITCHES;
use crate::scene::members::Places;
use crate::scene::model::{Bounds, Model, Primitive};
use crate::scene::motion::{Extent, Hidden, Playing, Pose, Target};
use crate::scene::outline::{MOST_INSTANCES, hull, used_vertices};

/// Moments of a clip that are looked at.
const MOST_MOMENTS: usize = 64;
/// Vertices that are deformed for all moments of all clips. Of larger models fewer moments are looked at, and then fewer vertices.
const MOST_VERTICES: usize = 1 << 22;
/// The same for a mix of clips, which is chosen while a window waits.
const MOST_VERTICES_AT_ONCE: usize = 1 << 19;
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
    /// The extent of a model in its own pose.
    pub fn at_rest(model: &Model) -> Self {
        let pose = model.rest_pose();
        let hidden = pose.hidden.clone();
        Self::during(model, &points(model, MOST_VERTICES), &[pose], &hidden)
    }

    /// The extent of a model while a clip plays.
    pub fn of_clip(model: &Model, clip: usize) -> Self {
        let most = MOST_VERTICES / model.motion.clips.len();
        let playing = [Playing { clip, weight: 1.0, time_s: 0.0 }];
        Self::while_playing(model, &playing, &[], &Places::default(), most)
    }

    /// The extent of a model, as it was loaded, while these clips play together, whatever their time is now, these weights are held, and the
    /// settings put it there.
    pub fn of_mix(model: &Model, playing: &[Playing], held: &[(usize, f32)], places: &Places) -> Self {
        Self::while_playing(model, playing, held, places, MOST_VERTICES_AT_ONCE)
    }

    /// About `most` vertices are deformed.
    fn while_playing(model: &Model, playing: &[Playing], held: &[(usize, f32)], places: &Places, most: usize) -> Self {
        let duration_s = |playing: &Playing| f64::from(model.motion.clips[playing.clip].duration_s);
        let longest_s = playing.iter().map(duration_s).fold(0.0, f64::max);
        let moments = (most / deformed_vertices(model).max(1)).clamp(LEAST_MOMENTS, MOST_MOMENTS);
        let moments = if longest_s > 0.0 { moments } else { 1 };
        let pose = |moment: usize| {
            let passed_s = longest_s * moment as f64 / (moments - 1).max(1) as f64;
            let at = |playing: &Playing| {
                let duration_s = duration_s(playing);
                let is_repeated = passed_s > duration_s && duration_s > 0.0;
                Playing { time_s: if is_repeated { passed_s.rem_euclid(duration_s) } else { passed_s }, ..*playing }
            };
            model.pose_with(&playing.iter().map(at).collect::<Vec<_>>(), held, places)
        };
        let poses: Vec<Pose> = (0..moments).into_par_iter().map(pose).collect();
        Self::during(model, &points(model, most / moments), &poses, &hidden_throughout(model, playing))
    }

    /// The extent in these poses of all but what is hidden; of all if everything is hidden.
    fn during(model: &Model, points: &[Points], poses: &[Pose], hidden: &Hidden) -> Self {
        let has_some = (0..model.instances.len()).any(|instance| !hidden.instance(instance));
        let hidden = if has_some { hidden } else { &Hidden::default() };
        let moment = |pose: &Pose| {
            let placed = placed(model, points, pose, hidden);
            let mut bounds = Bounds::default();
            placed.iter().for_each(|point| bounds.include(*point));
            Self { bounds, outline: hull(&placed).into() }
        };
        let moments: Vec<Self> = poses.par_iter().map(moment).collect();
        let all = Self::of_all(&moments.iter().collect::<Vec<_>>());
        Self { outline: hull(&all.outline).into(), ..all }
    }
}

/// The parts that are hidden during the whole of these clips. A node counts as shown also if it and a node above it are visible at different times only.
fn hidden_throughout(model: &Model, playing: &[Playing]) -> Hidden {
    let rig = &model.motion.rig;
    let mut nodes = rig.hidden_nodes();
    for Playing { clip, .. } in playing.iter().filter(|playing| playing.weight >= SWITCHES) {
        for channel in &model.motion.clips[*clip].channels {
            if let Target::Visible(at) = channel.target {
                nodes[at] = !channel.curve.is_ever_nonzero();
            }
        }
    }
    Hidden::new(rig, nodes)
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

/// World positions of the points of all instances in a pose, but those that are hidden.
fn placed(model: &Model, points: &[Points], pose: &Pose, hidden: &Hidden) -> Vec<Vec3> {
    let mut placed = Vec::new();
    for (index, (instance, world)) in model.instances.iter().zip(&pose.instances).enumerate() {
        if hidden.instance(index) {
            continue;
        }
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
