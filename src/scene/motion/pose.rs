//! Where everything of a model is at one moment.

use std::sync::Arc;

use glam::{DMat4, DVec3, Mat4};

use super::clip::{Channel, Clip, Target};
use super::deformation::Deformation;
use super::extent::Extent;
use super::property::{Values, move_camera, move_light};
use super::rig::{Rig, Skin};
use super::transform::{Transform, slerp};
use crate::scene::model::{Camera, Instance, Light, Model};

/// How a model can move. The default cannot.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The animations of the file, in its order.
    pub clips: Vec<Clip>,
    /// The hierarchy that they move. Without clips and skins it is empty.
    pub rig: Rig,
    /// The properties of materials, lights and cameras that clips move, as they are in the file.
    pub values: Vec<Values>,
    /// Names of the morph targets of each entry of `Pose::weights`; empty for one without a name.
    pub target_names: Vec<String>,
}

/// A clip that plays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playing {
    /// Index into `Motion::clips`.
    pub clip: usize,
    /// How far it replaces the pose without it, 0..1.
    pub weight: f32,
    /// Time in the clip, seconds.
    pub time_s: f64,
}

/// Where the parts of a model are at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Object to world of each entry of `Model::instances`. For an instance with joints the identity, since these bring its vertices to the
    /// world themselves; or a mirror if they mirror, which `joints` then undo, so that the winding follows from it as for all others.
    pub instances: Vec<Mat4>,
    /// World from the object space of the mesh, for each joint of each skin, one skin after the other: the joint's world transform
    /// times its inverse bind matrix. `Instance::first_joint` points here.
    pub joints: Vec<Mat4>,
    /// Weights of the morph targets of each node with such a mesh, one node after the other. `Instance::first_weight` points here.
    pub weights: Vec<f32>,
    /// `Model::lights`.
    pub lights: Vec<Light>,
    /// `Model::cameras`.
    pub cameras: Vec<Camera>,
    /// `Motion::values`, as they are at the moment.
    pub values: Vec<Values>,
}

impl Pose {
    /// Whether both have the same materials.
    pub fn has_same_materials(&self, other: &Self) -> bool {
        fn of_materials(pose: &Pose) -> impl Iterator<Item = &Values> {
            pose.values.iter().filter(|values| values.property.material().is_some())
        }
        of_materials(self).eq(of_materials(other))
    }

    /// The joints and the weights of an instance. Both are empty for one that keeps its shape.
    pub fn deformers(&self, instance: &Instance, deformation: &Deformation) -> (&[Mat4], &[f32]) {
        let weights = instance.first_weight.and_then(|first| self.weights.get(first as usize..)).unwrap_or_default();
        let joints = instance.first_joint.and_then(|first| self.joints.get(first as usize..)).unwrap_or_default();
        (joints, &weights[..deformation.targets.len().min(weights.len())])
    }
}

/// The nodes at one moment.
struct Nodes {
    /// World from node, for each node of the rig.
    world: Vec<DMat4>,
    /// Whether it is not where it is in the file's own pose.
    is_moved: Vec<bool>,
}

impl Nodes {
    fn new(rig: &Rig, moved: &[Option<Transform>]) -> Self {
        let mut nodes =
            Self { world: Vec::with_capacity(rig.nodes.len()), is_moved: Vec::with_capacity(rig.nodes.len()) };
        for (node, moved) in rig.nodes.iter().zip(moved) {
            let is_moved = moved.is_some() || node.parent.is_some_and(|parent| nodes.is_moved[parent]);
            let world_from_parent = || node.parent.map_or(DMat4::IDENTITY, |parent| nodes.world[parent]);
            let parent_from_node = || moved.map_or(node.parent_from_node, |moved| moved.matrix());
            let world = if is_moved { world_from_parent() * parent_from_node() } else { node.world_from_node };
            // Large numbers of a clip may overflow.
            nodes.world.push(if world.as_mat4().is_finite() { world } else { node.world_from_node });
            nodes.is_moved.push(is_moved);
        }
        nodes
    }

    /// The mirror and the joints of a skin: see [`Pose`].
    fn skin(&self, skin: &Skin, world_from_file: DMat4) -> (Mat4, Vec<Mat4>) {
        let joints =
            || skin.joints.iter().map(|(node, joint_from_mesh)| world_from_file * self.world[*node] * *joint_from_mesh);
        let mirrored = joints().filter(|joint| joint.determinant() < 0.0).count();
        let is_mirrored = 2 * mirrored > skin.joints.len();
        let mirror = if is_mirrored { DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) } else { DMat4::IDENTITY };
        let finite = |joint: DMat4| Some((mirror * joint).as_mat4()).filter(|joint| joint.is_finite());
        (mirror.as_mat4(), joints().map(|joint| finite(joint).unwrap_or_default()).collect())
    }
}

impl Model {
    /// The pose of the file, without animations.
    pub fn rest_pose(&self) -> Pose {
        self.pose_at(&[], None)
    }

    /// The pose of this model, which is as it was loaded, while clips play. Of two clips that move the same, the later one replaces the
    /// earlier one by its weight. `place`: where the settings put the model.
    pub fn pose_at(&self, playing: &[Playing], place: Option<Mat4>) -> Pose {
        let rig = &self.motion.rig;
        let mut moved = Moved {
            nodes: vec![None; rig.nodes.len()],
            weights: self.pose.weights.clone(),
            values: self.motion.values.clone(),
        };
        for Playing { clip, weight, time_s } in playing {
            let channels = self.motion.clips.get(*clip).into_iter().flat_map(|clip| &clip.channels);
            channels.for_each(|channel| moved.apply(channel, f64::from(*weight), *time_s, rig));
        }
        let Moved { nodes, weights, values } = moved;
        let nodes = Nodes::new(rig, &nodes);
        let transform = place.unwrap_or(Mat4::IDENTITY);
        let world_from_file = transform.as_dmat4() * DMat4::from_translation(-rig.shift);
        let (mut mirrors, mut joints) = (Vec::with_capacity(rig.skins.len()), Vec::new());
        for skin in &rig.skins {
            let (mirror, of_skin) = nodes.skin(skin, world_from_file);
            mirrors.push(mirror);
            joints.extend(of_skin);
        }
        let is_moved = |(node, _): &(usize, usize)| nodes.is_moved.get(*node) == Some(&true);
        let world = |node: usize| world_from_file * nodes.world[node];
        let instance = |(index, instance): (usize, &Instance)| {
            let placement = rig.instances.get(index);
            if let Some(skin) = placement.and_then(|placement| placement.skin) {
                return mirrors[skin];
            }
            let rest = place.map_or(instance.world_from_object, |place| place * instance.world_from_object);
            let Some(placement) = placement.filter(|placement| nodes.is_moved[placement.node]) else { return rest };
            let local = placement.node_from_object.as_deref().copied().unwrap_or(DMat4::IDENTITY);
            let world = (world(placement.node) * local).as_mat4();
            if world.is_finite() { world } else { rest }
        };
        let light = |(index, light): (usize, &Light)| {
            let mut light = light.clone();
            move_light(&mut light, index, &values);
            match (rig.lights.get(index).filter(|of| is_moved(of)), place) {
                (Some((node, _)), _) => light.at(&world(*node)),
                (None, Some(place)) => light.placed(place),
                (None, None) => light,
            }
        };
        let camera = |(index, camera): (usize, &Camera)| {
            let mut camera = camera.clone();
            move_camera(&mut camera, index, &values);
            match (rig.cameras.get(index).filter(|of| is_moved(of)), place) {
                (Some((node, _)), _) => camera.at(&world(*node)).scaled(transform),
                (None, Some(place)) => camera.placed(place),
                (None, None) => camera,
            }
        };
        Pose {
            instances: self.instances.iter().enumerate().map(instance).collect(),
            joints,
            weights,
            lights: self.lights.iter().enumerate().map(light).collect(),
            cameras: self.cameras.iter().enumerate().map(camera).collect(),
            values,
        }
    }

    /// This model, as it was loaded, in a pose. It shares all that does not move. Bounds and outline hold for the whole of the clips
    /// that play, so that the camera that frames it stands still.
    #[must_use]
    pub fn posed(&self, pose: &Arc<Pose>, extent: &Extent) -> Self {
        let mut model = self.clone();
        for (instance, world) in model.instances.iter_mut().zip(&pose.instances) {
            instance.world_from_object = *world;
        }
        (model.lights, model.cameras) = (pose.lights.clone(), pose.cameras.clone());
        (model.bounds, model.outline) = (extent.bounds, extent.outline.clone());
        model.pose = pose.clone();
        model
    }

    /// This model, as it was loaded, while clips play.
    #[must_use]
    pub fn at(&self, playing: &[Playing], place: Option<Mat4>) -> Self {
        self.posed(&self.pose_at(playing, place).into(), &self.extent(playing, place))
    }

    /// Where this model, as it was loaded, is while these clips play.
    pub fn extent(&self, playing: &[Playing], place: Option<Mat4>) -> Extent {
        let rest = Extent { bounds: self.bounds, outline: self.outline.clone() };
        let clips = || playing.iter().filter_map(|playing| self.motion.clips.get(playing.clip));
        // A clip of less weight leaves the model nearer to its own pose.
        let is_partial = playing.iter().any(|playing| playing.weight < 1.0);
        let mut extents: Vec<&Extent> = clips().map(|clip| &clip.extent).filter(|e| !e.bounds.is_empty()).collect();
        if extents.is_empty() || is_partial {
            extents.push(&rest);
        }
        let extent = Extent::of_all(&extents);
        place.map_or(extent.clone(), |place| extent.placed(place))
    }
}

/// What clips have moved so far.
struct Moved {
    /// The transforms of the nodes of the rig that are not as they are in the file.
    nodes: Vec<Option<Transform>>,
    weights: Vec<f32>,
    values: Vec<Values>,
}

impl Moved {
    /// Moves what a channel moves.
    fn apply(&mut self, Channel { target, curve }: &Channel, weight: f64, time_s: f64, rig: &Rig) {
        let vector = || <[f64; 3]>::try_from(curve.numbers(time_s)).ok().map(DVec3::from);
        let nodes = &mut self.nodes;
        let mut node = |node: usize, change: &dyn Fn(&mut Transform)| {
            change(nodes[node].get_or_insert(rig.nodes[node].rest));
        };
        match *target {
            Target::Translation(at) => {
                let Some(to) = vector() else { return };
                node(at, &|transform| transform.translation = transform.translation.lerp(to, weight));
            }
            Target::Scale(at) => {
                let Some(to) = vector() else { return };
                node(at, &|transform| transform.scale = transform.scale.lerp(to, weight));
            }
            Target::Rotation(at) => {
                let Some(to) = curve.rotation(time_s) else { return };
                let mix = |from| if weight == 1.0 { to } else { slerp(from, to, weight) };
                node(at, &|transform| transform.rotation = mix(transform.rotation));
            }
            Target::Weights(first) => {
                for (number, to) in self.weights[first..].iter_mut().zip(curve.numbers(time_s)) {
                    *number += ((to - f64::from(*number)) * weight) as f32;
                }
            }
            Target::Values(index, first) => self.values[index].mix(first, &curve.numbers(time_s), weight),
        }
    }
}
