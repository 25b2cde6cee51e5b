//! Computes poses, and brings models into them.

use std::sync::Arc;

use glam::{DMat4, DVec3, Mat4};

use super::values::{move_camera, move_light};
use crate::scene::members::Places;
use crate::scene::model::{Camera, Instance, Light, Model};
use crate::scene::motion::{Channel, Extent, Hidden, Playing, Pose, Rig, Skin, Target, Transform, Values, slerp};

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
        self.pose_at(&[], &Places::default())
    }

    /// The pose of this model, which is as it was loaded, while clips play. Of two clips that move the same, the later one replaces the
    /// earlier one by its weight. `places`: where the settings put the model.
    pub fn pose_at(&self, playing: &[Playing], places: &Places) -> Pose {
        self.pose_with(playing, &[], places)
    }

    /// The same with weights of morph targets that replace those of file and clips ([`Model::held_weights`]).
    pub fn pose_with(&self, playing: &[Playing], held: &[(usize, f32)], places: &Places) -> Pose {
        let (rig, place) = (&self.motion.rig, places.whole);
        let mut moved = Moved {
            nodes: vec![None; rig.nodes.len()],
            weights: self.pose.weights.clone(),
            values: self.motion.values.clone(),
            hidden: rig.hidden_nodes(),
        };
        for Playing { clip, weight, time_s } in playing {
            let channels = self.motion.clips.get(*clip).into_iter().flat_map(|clip| &clip.channels);
            channels.for_each(|channel| moved.apply(channel, f64::from(*weight), *time_s, rig));
        }
        places.roots.iter().for_each(|(root, transform)| moved.nodes[*root] = Some(*transform));
        let Moved { nodes, mut weights, values, hidden } = moved;
        held.iter().for_each(|(index, weight)| weights[*index] = *weight);
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
            hidden: Hidden::new(rig, hidden),
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

    /// This model, as it was loaded, while clips play and weights are held.
    #[must_use]
    pub fn at(&self, playing: &[Playing], held: &[(usize, f32)], places: &Places) -> Self {
        self.posed(&self.pose_with(playing, held, places).into(), &self.extent(playing, held, places))
    }

    /// Where this model, as it was loaded, is while these clips play and these weights are held.
    pub fn extent(&self, playing: &[Playing], held: &[(usize, f32)], places: &Places) -> Extent {
        let extent = match (playing, held) {
            _ if !places.roots.is_empty() => return Extent::of_mix(self, playing, held, places),
            ([], []) => self.whole_extent(),
            ([Playing { clip, weight: 1.0, .. }], []) => self.motion.clips[*clip].extent.clone(),
            _ => Extent::of_mix(self, playing, held, &Places::default()),
        };
        places.whole.map_or(extent.clone(), |place| extent.placed(place))
    }

    /// Where this model is while the clips play that play now.
    pub fn whole_extent(&self) -> Extent {
        Extent { bounds: self.bounds, outline: self.outline.clone() }
    }
}

/// The nodes, weights, values and visibilities as the clips so far have moved them.
struct Moved {
    /// The transforms of the nodes of the rig that are not as they are in the file.
    nodes: Vec<Option<Transform>>,
    weights: Vec<f32>,
    values: Vec<Values>,
    /// Whether each node of the rig hides itself.
    hidden: Vec<bool>,
}

/// The weight from which on a clip shows and hides nodes.
pub(super) const SWITCHES: f32 = 0.5;

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
            Target::Visible(at) if weight >= f64::from(SWITCHES) => self.hidden[at] = curve.numbers(time_s) == [0.0],
            Target::Visible(_) => {}
            Target::Weights(first) => {
                for (number, to) in self.weights[first..].iter_mut().zip(curve.numbers(time_s)) {
                    *number += ((to - f64::from(*number)) * weight) as f32;
                }
            }
            Target::Values(index, first) => self.values[index].follow(first, curve, time_s, weight),
        }
    }
}
