//! Puts several models side by side into one. Each gets a node above its own nodes, which the settings move.

use std::collections::HashSet;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3, Vec4};

use super::members::Member;
use super::model::{Camera, Contents, Instance, Light, LoadTiming, Model, Node, Primitive};
use super::motion::{Channel, Clip, Motion, Placement, Pose, Property, Rig, RigNode, Skin, Target, Values};

/// Space between two models, as a part of the larger one's width.
const GAP: f32 = 0.2;

/// Models in a row along +X, each beside the one before; the first stays where it is. `files`: how the settings name the others. The numbers of
/// the first model's nodes and materials stay as they are; those of the others follow.
pub fn side_by_side(models: Vec<(String, Model)>) -> Model {
    let mut all = Together::default();
    for (file, model) in models {
        all.add(file, model);
    }
    all.finish()
}

/// The models so far. Everything is as in the file of each, but for its indices and its place.
#[derive(Default)]
struct Together {
    names: Vec<String>,
    model: Model,
    primitives: Vec<Primitive>,
    nodes: Vec<Node>,
    motion: Motion,
    weights: Vec<f32>,
    joints: usize,
    members: Vec<Member>,
    contents: Contents,
    files: Vec<PathBuf>,
    warnings: Vec<String>,
    /// The next number of a node.
    next_node: usize,
    /// Width of the last model, and where it ends.
    row: Option<(f32, f32)>,
}

/// The offsets of the indices of a model.
struct Offsets {
    /// To all but 0, glTF's default material, which all models share.
    materials: usize,
    primitives: usize,
    /// To the numbers of nodes in their file.
    node_numbers: usize,
    /// Of `Rig::nodes`.
    rig_nodes: usize,
    joints: usize,
    weights: usize,
    values: usize,
    lights: usize,
    cameras: usize,
    /// 0 for the model whose environment is shown.
    environments: usize,
}

impl Offsets {
    fn material(&self, index: usize) -> usize {
        if index == 0 { 0 } else { index + self.materials }
    }

    fn property(&self, property: Property) -> Property {
        match property {
            Property::BaseColor(of) => Property::BaseColor(self.material(of)),
            Property::Emission(of) => Property::Emission(self.material(of)),
            Property::Anisotropy(of) => Property::Anisotropy(self.material(of)),
            Property::Glossiness(of) => Property::Glossiness(self.material(of)),
            Property::CoatNormalScale(of) => Property::CoatNormalScale(self.material(of)),
            Property::ThinnestFilm(of) => Property::ThinnestFilm(self.material(of)),
            Property::Factor(of, factor) => Property::Factor(self.material(of), factor),
            Property::Texture(of, slot) => Property::Texture(self.material(of), slot),
            Property::Light(of) => Property::Light(of + self.lights),
            Property::Range(of) => Property::Range(of + self.lights),
            Property::Cone(of) => Property::Cone(of + self.lights),
            Property::Fovy(of) => Property::Fovy(of + self.cameras),
            Property::Height(of) => Property::Height(of + self.cameras),
            Property::EnvironmentIntensity(of) => Property::EnvironmentIntensity(of + self.environments),
            Property::EnvironmentRotation(of) => Property::EnvironmentRotation(of + self.environments),
        }
    }

    fn target(&self, target: Target) -> Target {
        match target {
            Target::Translation(node) => Target::Translation(node + self.rig_nodes),
            Target::Rotation(node) => Target::Rotation(node + self.rig_nodes),
            Target::Scale(node) => Target::Scale(node + self.rig_nodes),
            Target::Visible(node) => Target::Visible(node + self.rig_nodes),
            Target::Weights(first) => Target::Weights(first + self.weights),
            Target::Values(index, first) => Target::Values(index + self.values, first),
        }
    }
}

impl Together {
    fn add(&mut self, file: String, model: Model) {
        let origin = DVec3::new(self.place_in_row(&model).into(), 0.0, 0.0);
        let offsets = Offsets {
            materials: self.model.materials.len().saturating_sub(1),
            primitives: self.primitives.len(),
            node_numbers: self.next_node,
            // The root comes first.
            rig_nodes: self.motion.rig.nodes.len() + 1,
            joints: self.joints,
            weights: self.weights.len(),
            values: self.motion.values.len(),
            lights: self.model.lights.len(),
            cameras: self.model.cameras.len(),
            environments: usize::from(self.model.environment.is_some() || model.environment.is_none()),
        };
        let name = unused(&model.name, |name| self.members.iter().any(|member| *member.name == *name));
        let first_clip = self.motion.clips.len();
        let member = Member {
            name: name.as_str().into(),
            file,
            node: self.nodes.len(),
            root: offsets.rig_nodes - 1,
            origin,
            shift: model.motion.rig.shift,
            clips: first_clip..first_clip + model.motion.clips.len(),
        };
        self.warnings.extend(model.warnings.iter().map(|warning| format!("{name}: {warning}")));
        self.add_nodes(&member, &model, &offsets);
        self.add_motion(&member, &model, &offsets);
        self.add_geometry(&name, &model, &offsets);
        self.add_objects(&model, &offsets, origin.as_vec3());
        self.add_contents(&model);
        self.names.push(model.name.to_string());
        self.members.push(member);
    }

    /// How far a model moves to stand beside the one before.
    fn place_in_row(&mut self, model: &Model) -> f32 {
        let (min, max) = match model.bounds.is_empty() {
            true => (0.0, 0.0),
            false => (model.bounds.min.x, model.bounds.max.x),
        };
        let width = max - min;
        let moved = self.row.map_or(0.0, |(before, end)| end + GAP * width.max(before) - min);
        self.row = Some((width, max + moved));
        moved
    }

    fn add_nodes(&mut self, member: &Member, model: &Model, offsets: &Offsets) {
        let first = self.nodes.len() + 1;
        let most = model.nodes.iter().map(|node| node.index + 1).max().unwrap_or(0);
        let number = offsets.node_numbers + most;
        self.next_node = number + 1;
        self.nodes.push(Node { index: number, name: member.name.to_string(), ..Node::default() });
        self.nodes.extend(model.nodes.iter().map(|node| Node {
            index: node.index + offsets.node_numbers,
            name: node.name.clone(),
            parent: Some(node.parent.map_or(member.node, |parent| parent + first)),
            mesh: node.mesh.clone(),
            light: node.light.map(|light| light + offsets.lights),
            camera: node.camera.map(|camera| camera + offsets.cameras),
            is_hidden: node.is_hidden,
        }));
    }

    fn add_geometry(&mut self, name: &str, model: &Model, offsets: &Offsets) {
        let (first_texture, first_image) = (self.model.textures.len(), self.model.images.len());
        let skipped = usize::from(!self.model.materials.is_empty());
        let mut materials: Vec<_> = model.materials.iter().skip(skipped).cloned().collect();
        for texture in materials.iter_mut().flat_map(|material| material.textures.iter_mut().flatten()) {
            texture.texture += first_texture;
        }
        let mut textures = model.textures.to_vec();
        textures.iter_mut().for_each(|texture| texture.image += first_image);
        Arc::make_mut(&mut self.model.materials).extend(materials);
        Arc::make_mut(&mut self.model.textures).extend(textures);
        Arc::make_mut(&mut self.model.images).extend(model.images.iter().cloned());
        let variants = Arc::make_mut(&mut self.model.variants);
        let mut variant = |index: usize| {
            let name = &model.variants[index];
            variants.iter().position(|known| known == name).unwrap_or_else(|| {
                variants.push(name.clone());
                variants.len() - 1
            })
        };
        let known: HashSet<String> = self.primitives.iter().map(|known| known.name.clone()).collect();
        self.primitives.extend(model.primitives.iter().map(|primitive| {
            Primitive {
                // Settings hide a primitive by its name.
                name: match known.contains(&primitive.name) {
                    true => format!("{name} {}", primitive.name),
                    false => primitive.name.clone(),
                },
                material: offsets.material(primitive.material),
                default_material: offsets.material(primitive.default_material),
                variant_materials: primitive
                    .variant_materials
                    .iter()
                    .map(|(of, material)| (variant(*of), offsets.material(*material)))
                    .collect(),
                ..primitive.clone()
            }
        }));
    }

    fn add_objects(&mut self, model: &Model, offsets: &Offsets, origin: Vec3) {
        self.model.instances.extend(model.instances.iter().map(|instance| {
            let mut world_from_object = instance.world_from_object;
            if instance.first_joint.is_none() {
                world_from_object.w_axis += Vec4::from((origin, 0.0));
            }
            Instance {
                primitive: instance.primitive + offsets.primitives,
                world_from_object,
                node: instance.node + offsets.node_numbers,
                node_name: instance.node_name.clone(),
                first_joint: instance.first_joint.map(|first| first + offsets.joints as u32),
                first_weight: instance.first_weight.map(|first| first + offsets.weights as u32),
            }
        }));
        let lights = model.lights.iter().map(|light| Light { position: light.position + origin, ..light.clone() });
        self.model.lights.extend(lights);
        let cameras = model.cameras.iter().map(|camera| Camera { eye: camera.eye + origin, ..camera.clone() });
        self.model.cameras.extend(cameras);
    }

    fn add_motion(&mut self, member: &Member, model: &Model, offsets: &Offsets) {
        let root = member.rest();
        let rig = &mut self.motion.rig;
        rig.nodes.push(RigNode {
            index: self.next_node - 1,
            parent: None,
            rest: root,
            parent_from_node: root.matrix(),
            world_from_node: root.matrix(),
            is_hidden: false,
            weights: self.weights.len()..self.weights.len(),
        });
        if model.motion.rig.nodes.is_empty() {
            follow_root(rig, member.root, model);
        } else {
            follow(rig, member, model, offsets);
        }
        self.joints += model.motion.rig.skins.iter().map(|skin| skin.joints.len()).sum::<usize>();
        self.weights.extend(&model.pose.weights);
        self.motion.target_names.extend(model.motion.target_names.iter().cloned());
        let channel = |channel: &Channel| Channel { target: offsets.target(channel.target), ..channel.clone() };
        self.motion.clips.extend(
            model
                .motion
                .clips
                .iter()
                .map(|clip| Clip { channels: clip.channels.iter().map(channel).collect(), ..clip.clone() }),
        );
        self.motion.values.extend(
            model
                .motion
                .values
                .iter()
                .map(|values| Values { property: offsets.property(values.property), ..values.clone() }),
        );
    }

    fn add_contents(&mut self, model: &Model) {
        let (all, more) = (&mut self.contents, &model.contents);
        // `--scene` chooses among those of the first file.
        if self.members.is_empty() {
            (all.scenes, all.scene) = (more.scenes.clone(), more.scene);
        }
        all.meshes += more.meshes;
        all.skins += more.skins;
        all.animations.extend(more.animations.iter().cloned());
        let unknown = |extension: &&String| !all.extensions.contains(extension);
        let extensions: Vec<String> = more.extensions.iter().filter(unknown).cloned().collect();
        all.extensions.extend(extensions);
        self.files.extend(model.files.iter().cloned());
        // A picture has one environment: that of the first model with one.
        let environment = &mut self.model.environment;
        *environment = environment.take().or_else(|| model.environment.clone());
        let (sum, more) = (&mut self.model.timing, model.timing);
        *sum = LoadTiming {
            parse_ms: sum.parse_ms + more.parse_ms,
            decode_ms: sum.decode_ms + more.decode_ms,
            tangents_ms: sum.tangents_ms + more.tangents_ms,
        };
    }

    fn finish(self) -> Model {
        let name = match self.names.as_slice() {
            [first, rest @ ..] if rest.len() > 2 => format!("{first} + {} more", rest.len()),
            names => names.join(" + "),
        };
        let model = Model {
            name: name.into(),
            primitives: self.primitives.into(),
            nodes: self.nodes.into(),
            motion: self.motion.into(),
            pose: Pose { weights: self.weights, ..Pose::default() }.into(),
            members: self.members.into(),
            contents: self.contents.into(),
            files: self.files.into(),
            warnings: self.warnings.into(),
            ..self.model
        };
        model.settled()
    }
}

/// Adds the hierarchy of a model below its root.
fn follow(rig: &mut Rig, member: &Member, model: &Model, offsets: &Offsets) {
    let from_file = member.rest().matrix();
    let weights = |range: &Range<usize>| range.start + offsets.weights..range.end + offsets.weights;
    let own = &model.motion.rig;
    rig.nodes.extend(own.nodes.iter().map(|node| RigNode {
        index: node.index + offsets.node_numbers,
        parent: Some(node.parent.map_or(member.root, |parent| parent + offsets.rig_nodes)),
        world_from_node: from_file * node.world_from_node,
        weights: weights(&node.weights),
        ..node.clone()
    }));
    let first_skin = rig.skins.len();
    rig.skins.extend(own.skins.iter().map(|skin| Skin {
        joints: skin.joints.iter().map(|(node, joint)| (node + offsets.rig_nodes, *joint)).collect(),
        ..skin.clone()
    }));
    rig.instances.extend(own.instances.iter().map(|placement| Placement {
        node: placement.node + offsets.rig_nodes,
        node_from_object: placement.node_from_object.clone(),
        skin: placement.skin.map(|skin| skin + first_skin),
    }));
    rig.lights.extend(own.lights.iter().map(|(node, light)| (node + offsets.rig_nodes, *light)));
    rig.cameras.extend(own.cameras.iter().map(|(node, camera)| (node + offsets.rig_nodes, *camera)));
}

/// Makes all of a model that never moves follow its root.
fn follow_root(rig: &mut Rig, root: usize, model: &Model) {
    rig.instances.extend(model.instances.iter().map(|instance| Placement {
        node: root,
        node_from_object: Some(Box::new(instance.world_from_object.as_dmat4())),
        skin: None,
    }));
    let mut below = |root_from_node: DMat4| {
        let world_from_node = rig.nodes[root].world_from_node * root_from_node;
        let weights = rig.nodes[root].weights.clone();
        let rest = super::motion::Transform::from_matrix(root_from_node);
        let index = rig.nodes[root].index;
        rig.nodes.push(RigNode {
            index,
            parent: Some(root),
            rest,
            parent_from_node: root_from_node,
            world_from_node,
            is_hidden: false,
            weights,
        });
        rig.nodes.len() - 1
    };
    let lights: Vec<(usize, usize)> = (0..)
        .zip(&model.lights)
        .map(|(index, light)| {
            let up = light.direction.any_orthonormal_vector();
            (below(facing(light.position, light.direction, up)), index)
        })
        .collect();
    let cameras: Vec<(usize, usize)> = (0..)
        .zip(&model.cameras)
        .map(|(index, camera)| (below(facing(camera.eye, camera.forward, camera.up)), index))
        .collect();
    rig.lights.extend(lights);
    rig.cameras.extend(cameras);
}

/// The transform of a node at a position, whose -Z axis points forward. Both directions are unit vectors, at a right angle.
fn facing(position: Vec3, forward: Vec3, up: Vec3) -> DMat4 {
    let [forward, up] = [forward, up].map(Vec3::as_dvec3);
    let right = forward.cross(up);
    let column = |axis: DVec3| axis.extend(0.0);
    DMat4::from_cols(column(right), column(up), column(-forward), position.as_dvec3().extend(1.0))
}

/// The name, or with the first number that makes it a new one.
fn unused(name: &str, is_used: impl Fn(&str) -> bool) -> String {
    let numbered = |number: usize| if number == 1 { name.to_owned() } else { format!("{name} {number}") };
    (1..).map(numbered).find(|name| !is_used(name)).unwrap_or_default()
}
