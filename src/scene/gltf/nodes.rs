//! Walks the node hierarchy and places meshes, lights and cameras.

use std::collections::HashSet;
use std::sync::Arc;

use glam::{DMat4, DVec3, Mat4, Quat, Vec3};
use gltf::json;
use json::extensions::scene::khr_lights_punctual as punctual;

use super::left_out::{LeftOut, Part};
use super::objects::{read_lens, read_light};
use super::place::{get, out_of_range, place};
use crate::scene::error::Problem;
use crate::scene::model::{Camera, Light, Node};
use crate::scene::motion::{Rig, RigNode, Transform};

/// The extension that hides a node with all below it.
pub const VISIBILITY: &str = "KHR_node_visibility";

/// How many more nodes than the file has a scene may show, since a node with several parents is shown below each of them.
const MOST_REPEATED: usize = 1 << 16;

/// The objects of a scene.
#[derive(Default)]
pub struct Scene {
    /// The nodes, in the order of the hierarchy.
    pub nodes: Vec<Node>,
    /// Meshes, in the order of the hierarchy.
    pub meshes: Vec<PlacedMesh>,
    /// Lights, with their exact positions.
    pub lights: Vec<(Light, DVec3)>,
    /// Cameras, with their exact positions.
    pub cameras: Vec<(Camera, DVec3)>,
    /// The hierarchy, with the nodes of all of these.
    pub rig: Rig,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
    /// Parts that cannot be used.
    pub left_out: LeftOut,
}

/// A mesh in the world.
pub struct PlacedMesh {
    /// Index of the mesh; in range.
    pub mesh: usize,
    /// Index of the node in the file.
    pub node: usize,
    /// Index of the node in the rig.
    pub at: usize,
    /// Name of the node, or empty.
    pub name: Arc<str>,
    /// Object to world; finite. In doubles, so that a model far from the origin can be moved there without loss.
    pub world_from_object: DMat4,
    /// Node from object, if the node shows its mesh many times.
    pub node_from_object: Option<DMat4>,
    /// Index of its skin in the rig.
    pub skin: Option<usize>,
}

/// The nodes below each node.
struct Hierarchy {
    /// Each child once.
    children: Vec<Vec<usize>>,
    /// How many parents each node has.
    parents: Vec<usize>,
}

/// The index of the scene to show: the chosen one, or else that of the file, or the first.
pub fn chosen_scene(root: &json::Root, chosen: Option<usize>) -> usize {
    let chosen = chosen.filter(|index| *index < root.scenes.len());
    chosen.or(root.scene.map(|index| index.value())).unwrap_or_default()
}

/// Walks the chosen scene, or else the default scene, or the first scene, or all nodes without a parent. Meshes and lights of hidden nodes are left
/// out, unless a clip may show them: `switched` are the nodes whose visibility clips change. Cameras are never hidden.
pub fn walk(root: &json::Root, chosen: Option<usize>, switched: &HashSet<usize>) -> Result<Scene, Problem> {
    let mut scene = Scene::default();
    let hierarchy = Hierarchy::new(root, &mut scene.warnings)?;
    let chosen = chosen.and_then(|index| root.scenes.get(index));
    let start = match (root.scene, chosen.or(root.scenes.first())) {
        (Some(index), _) if chosen.is_none() => {
            hierarchy.roots(get(&root.scenes, index, "scene", "scenes")?, root, &mut scene.warnings)?
        }
        (_, Some(first)) => hierarchy.roots(first, root, &mut scene.warnings)?,
        (_, None) => hierarchy.tops(),
    };
    // An explicit stack, since files may nest deeper than the thread's stack allows.
    let root_of = |node| (node, None, DMat4::IDENTITY, false);
    let mut stack: Vec<(usize, Option<usize>, DMat4, bool)> = start.into_iter().rev().map(root_of).collect();
    let mut hidden = 0;
    while let Some((index, parent, world_from_parent, is_below_hidden)) = stack.pop() {
        let node = &root.nodes[index];
        let hides = is_hidden(node);
        let is_first = hides && !is_below_hidden && !switched.contains(&index);
        let is_hidden = is_below_hidden || is_first;
        hidden += usize::from(is_first);
        let place = place("nodes", index, node.name.as_deref());
        let (rest, parent_from_node) = local_transform(node, &place, &mut scene.warnings)?;
        let world_from_object = world_from_parent * parent_from_node;
        if !world_from_object.as_mat4().is_finite() {
            return Err(Problem::invalid(place, "a finite world transform", "one that overflows"));
        }
        let at = scene.nodes.len();
        let name = node.name.clone().unwrap_or_default();
        scene.nodes.push(Node { index, name, parent, is_hidden, ..Node::default() });
        let weights = 0..0;
        scene.rig.nodes.push(RigNode {
            index,
            parent,
            rest,
            parent_from_node,
            world_from_node: world_from_object,
            is_hidden: hides,
            weights,
        });
        scene.add(root, node, (index, at), &world_from_object, &place);
        let children = hierarchy.children[index].iter().rev();
        stack.extend(children.map(|child| (*child, Some(at), world_from_object, is_hidden)));
    }
    if hidden > 0 {
        scene.warnings.push(format!("{VISIBILITY} hides {hidden} nodes with all below them: they are not shown."));
    }
    if scene.meshes.is_empty() {
        let left = match hidden {
            0 => "none in the scene".to_owned(),
            _ => format!("none that is seen, since {VISIBILITY} hides {hidden} nodes with all below them"),
        };
        let found = format!("{} nodes, {} meshes in the file, {left}", root.nodes.len(), root.meshes.len());
        return Err(scene.left_out.into_cause().unwrap_or(Problem::NothingToDraw { found }));
    }
    Ok(scene)
}

impl Hierarchy {
    /// Reads the hierarchy. A child that does not exist and a cycle are errors. A node with several parents, which glTF forbids and
    /// some programs write, is shown below each.
    fn new(root: &json::Root, warnings: &mut Vec<String>) -> Result<Self, Problem> {
        let count = root.nodes.len();
        let place = |index: usize| place("nodes", index, root.nodes[index].name.as_deref());
        let mut this = Self { children: vec![Vec::new(); count], parents: vec![0; count] };
        for (index, node) in root.nodes.iter().enumerate() {
            let mut listed = HashSet::new();
            for child in node.children.iter().flatten().map(json::Index::value) {
                if child >= count {
                    return Err(out_of_range(&place(index), "nodes", child, count));
                }
                if listed.insert(child) {
                    this.children[index].push(child);
                    this.parents[child] += 1;
                } else {
                    warnings.push(format!(
                        "{} lists the child {} twice: it is shown once.",
                        place(index),
                        place(child)
                    ));
                }
            }
        }
        let mut shared = (0..count).filter(|&node| this.parents[node] > 1);
        if let Some(first) = shared.next() {
            let parents = this.parents[first];
            let others = match shared.count() {
                0 => String::new(),
                more => format!(", as are {more} others with several parents"),
            };
            warnings.push(format!("{} has {parents} parents: it is shown below each{others}.", place(first)));
        }
        // Takes away nodes without parents until only those on a cycle, or below one, are left.
        let mut waits_for = this.parents.clone();
        let mut shown: Vec<usize> = this.parents.iter().map(|&parents| usize::from(parents == 0)).collect();
        let mut ready = this.tops();
        while let Some(node) = ready.pop() {
            for &child in &this.children[node] {
                shown[child] = shown[child].saturating_add(shown[node]);
                waits_for[child] -= 1;
                if waits_for[child] == 0 {
                    ready.push(child);
                }
            }
        }
        if let Some(node) = waits_for.iter().position(|waits| *waits > 0) {
            let found = "a node that is its own ancestor, or below one";
            return Err(Problem::invalid(place(node), "a hierarchy without cycles", found));
        }
        let total = shown.iter().fold(0_usize, |sum, times| sum.saturating_add(*times));
        if total - count > MOST_REPEATED {
            let expected = format!("nodes with several parents that are shown at most {MOST_REPEATED} times more");
            return Err(Problem::invalid("nodes", expected, (total - count).to_string()));
        }
        Ok(this)
    }

    /// The nodes without a parent.
    fn tops(&self) -> Vec<usize> {
        (0..self.parents.len()).filter(|&node| self.parents[node] == 0).collect()
    }

    /// The nodes at which a scene begins: those that it lists, without those that are below others, each once.
    fn roots(&self, scene: &json::Scene, root: &json::Root, warnings: &mut Vec<String>) -> Result<Vec<usize>, Problem> {
        for node in &scene.nodes {
            get(&root.nodes, *node, "scenes[].nodes", "nodes")?;
        }
        let listed = || scene.nodes.iter().map(json::Index::value);
        let mut is_below = vec![false; self.parents.len()];
        let mut stack: Vec<usize> = listed().flat_map(|node| &self.children[node]).copied().collect();
        while let Some(node) = stack.pop() {
            if !std::mem::replace(&mut is_below[node], true) {
                stack.extend(&self.children[node]);
            }
        }
        let mut seen = HashSet::new();
        let roots: Vec<usize> = listed().filter(|node| !is_below[*node] && seen.insert(*node)).collect();
        match scene.nodes.len() - roots.len() {
            0 => {}
            1 => warnings.push("The scene lists a node that it already has: the node is shown once.".into()),
            more => warnings.push(format!("The scene lists {more} nodes that it already has: each is shown once.")),
        }
        Ok(roots)
    }
}

fn is_hidden(node: &json::Node) -> bool {
    let others = node.extensions.as_ref().map(|extensions| &extensions.others);
    others.and_then(|others| others.get(VISIBILITY)?.get("visible")?.as_bool()) == Some(false)
}

/// The transform of a node relative to its parent.
pub fn local_transform(
    node: &json::Node,
    place: &str,
    warnings: &mut Vec<String>,
) -> Result<(Transform, DMat4), Problem> {
    let scale = Vec3::from(node.scale.unwrap_or([1.0; 3]));
    let translation = Vec3::from(node.translation.unwrap_or_default());
    let rotation = Quat::from_array(node.rotation.unwrap_or_default().0);
    let length = rotation.length();
    let rotation = if length > 0.0 && length.is_finite() {
        rotation / length
    } else if rotation.is_finite() && node.matrix.is_none() {
        warnings.push(format!("{place} has a rotation of length {length}: none is used."));
        Quat::IDENTITY
    } else {
        rotation
    };
    let matrix = match &node.matrix {
        Some(matrix) => Mat4::from_cols_array(matrix),
        None => Mat4::from_scale_rotation_translation(scale, rotation, translation),
    };
    if !matrix.is_finite() {
        return Err(Problem::invalid(place, "a finite transform", "one that is not"));
    }
    let last_row = matrix.row(3);
    if (last_row - glam::Vec4::W).abs().max_element() > 1e-4 {
        return Err(Problem::invalid(place, "a matrix with the last row 0 0 0 1", last_row.to_string()));
    }
    let matrix = matrix.as_dmat4();
    let transform = match &node.matrix {
        Some(_) => Transform::from_matrix(matrix),
        None => Transform {
            translation: translation.as_dvec3(),
            rotation: rotation.as_dquat().normalize(),
            scale: scale.as_dvec3(),
        },
    };
    Ok((transform, matrix))
}

impl Scene {
    fn add(&mut self, root: &json::Root, node: &json::Node, (index, at): (usize, usize), world: &DMat4, place: &str) {
        let name: Arc<str> = node.name.as_deref().unwrap_or_default().into();
        let is_shown = !self.last_node().is_hidden;
        let found =
            node.mesh.filter(|_| is_shown).map(|mesh| get(&root.meshes, mesh, place, "meshes").map(|of| (mesh, of)));
        if let Some((mesh, of_file)) = found.and_then(|found| self.left_out.unless(Part::MESH, place, found)) {
            self.last_node().mesh = Some(of_file.name.clone().unwrap_or_default());
            self.meshes.push(PlacedMesh {
                mesh: mesh.value(),
                node: index,
                at,
                name: name.clone(),
                world_from_object: *world,
                node_from_object: None,
                skin: None,
            });
        }
        let found = node.camera.map(|camera| {
            let of_file = get(&root.cameras, camera, place, "cameras")?;
            Ok((camera.value(), read_lens(of_file, camera.value())?))
        });
        if let Some((source, lens)) = found.and_then(|found| self.left_out.unless(Part::CAMERA, place, found)) {
            let own = root.cameras[source].name.as_deref().filter(|name| !name.is_empty());
            let (name, eye) = (own.map_or(name, Arc::from), Vec3::ZERO);
            let number = self.cameras.len();
            self.last_node().camera = Some(number);
            let camera = Camera { name, eye, forward: Vec3::NEG_Z, up: Vec3::Y, lens }.at(world);
            self.cameras.push((camera, world.w_axis.truncate()));
            self.rig.cameras.push((at, source));
        }
        let extensions = node.extensions.as_ref().filter(|_| is_shown);
        let found = extensions.and_then(|extensions| extensions.khr_lights_punctual.as_ref()).map(|light| {
            let lights: &[punctual::Light] = root.as_ref();
            let of_file = get(lights, light.light, place, "KHR_lights_punctual.lights")?;
            Ok((light.light.value(), read_light(of_file, light.light.value(), world, &mut self.warnings)?))
        });
        if let Some((light_index, light)) = found.and_then(|found| self.left_out.unless(Part::LIGHT, place, found)) {
            let number = self.lights.len();
            self.last_node().light = Some(number);
            self.lights.push((light, world.w_axis.truncate()));
            self.rig.lights.push((at, light_index));
        }
    }

    /// The node that is being added.
    fn last_node(&mut self) -> &mut Node {
        if self.nodes.is_empty() {
            self.nodes.push(Node::default());
        }
        let last = self.nodes.len() - 1;
        &mut self.nodes[last]
    }
}
