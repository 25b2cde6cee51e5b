//! Reads skins and morph weights into the rig of a scene.

use std::collections::HashMap;

use glam::{DMat4, Mat4};
use gltf::json;
use json::accessor::{ComponentType as C, Type};

use super::raw::Raw;
use crate::scene::error::Problem;
use crate::scene::gltf::geometry::accessor::{Format, Normalized as N, Reader};
use crate::scene::gltf::left_out::Part;
use crate::scene::gltf::nodes::{PlacedMesh, Scene, local_transform};
use crate::scene::gltf::place::{get, place};
use crate::scene::motion::{Rig, RigNode, Skin};

const MATRICES: Format = Format { types: &[Type::Mat4], components: &[(C::F32, N::No)] };

/// The morph weights of a scene: of the file's own pose, and their names.
#[derive(Default)]
pub struct Weights {
    /// One after the other: `Pose::weights`.
    pub rest: Vec<f32>,
    /// Names, or empty.
    pub names: Vec<String>,
}

/// Gives the meshes of a scene their skins and their nodes morph weights. A skin that is invalid is left out.
pub fn attach(reader: Reader<'_>, raw: &Raw, scene: &mut Scene) -> Weights {
    let mut nodes = Nodes::new(reader.root, &scene.rig);
    let mut skins = HashMap::new();
    let mut weights = Weights::default();
    for mesh in &mut scene.meshes {
        add_weights(reader.root, raw, mesh, &mut scene.rig, &mut weights);
        let Some(index) = reader.root.nodes[mesh.node].skin else { continue };
        let user = place("nodes", mesh.node, Some(&mesh.name));
        let source = get(&reader.root.skins, index, &user, "skins");
        let Some(source) = scene.left_out.unless(Part::SKIN, &user, source) else { continue };
        if source.joints.is_empty() {
            let skin = place("skins", index.value(), source.name.as_deref());
            scene.warnings.push(format!("{skin} has no joints: its meshes are where their nodes are."));
            continue;
        }
        mesh.skin = *skins.entry(index.value()).or_insert_with(|| {
            let skin = read(reader, (index.value(), source), &mut nodes, &mut scene.rig, &mut scene.warnings);
            scene.left_out.unless(Part::SKIN, &user, skin).map(|skin| {
                scene.rig.skins.push(skin);
                scene.rig.skins.len() - 1
            })
        });
    }
    weights
}

/// Adds the morph weights of a node: its own, or those of its mesh, or 0.
fn add_weights(root: &json::Root, raw: &Raw, mesh: &PlacedMesh, rig: &mut Rig, weights: &mut Weights) {
    let targets = raw.mesh(mesh.mesh).target_count();
    if targets == 0 {
        return;
    }
    let first = weights.rest.len();
    let of_file = root.nodes[mesh.node].weights.as_ref().or(root.meshes[mesh.mesh].weights.as_ref());
    let weight = |target: usize| of_file.and_then(|all| all.get(target)).copied().filter(|weight| weight.is_finite());
    weights.rest.extend((0..targets).map(|target| weight(target).unwrap_or_default()));
    weights.names.extend((0..targets).map(|target| raw.mesh(mesh.mesh).target_name(target).to_owned()));
    rig.nodes[mesh.at].weights = first..first + targets;
}

fn read(
    reader: Reader<'_>,
    (index, source): (usize, &json::Skin),
    nodes: &mut Nodes,
    rig: &mut Rig,
    warnings: &mut Vec<String>,
) -> Result<Skin, Problem> {
    let place = place("skins", index, source.name.as_deref());
    let matrices = source.inverse_bind_matrices.map(|accessor| {
        let place = format!("{place}.inverseBindMatrices");
        let matrices = reader.floats::<16>(accessor, &MATRICES, 0.0, &place)?;
        match matrices.len() >= source.joints.len() {
            true => Ok(matrices),
            false => {
                let expected = format!("a matrix for each of the {} joints", source.joints.len());
                Err(Problem::invalid(place, expected, matrices.len().to_string()))
            }
        }
    });
    let matrices = matrices.transpose()?;
    let mut joints = Vec::with_capacity(source.joints.len());
    for (number, joint) in source.joints.iter().enumerate() {
        get(&reader.root.nodes, *joint, &place, "nodes")?;
        let matrix = matrices.as_ref().map_or(Mat4::IDENTITY, |all| Mat4::from_cols_array(&all[number])).as_dmat4();
        let node = nodes.find(joint.value(), reader.root, rig, warnings)?;
        if !(rig.nodes[node].world_from_node * matrix).as_mat4().is_finite() {
            let place = format!("{place}, joint {number}");
            return Err(Problem::invalid(place, "a finite inverse bind matrix and world transform", "another"));
        }
        joints.push((node, matrix));
    }
    Ok(Skin { name: source.name.clone().unwrap_or_default(), index, joints })
}

/// Finds the nodes of the file in the rig.
struct Nodes {
    /// Index in the rig of the first of the nodes with an index in the file.
    known: HashMap<usize, usize>,
    /// A parent of each node of the file.
    parents: HashMap<usize, usize>,
}

impl Nodes {
    fn new(root: &json::Root, rig: &Rig) -> Self {
        let mut this = Self { known: HashMap::new(), parents: HashMap::new() };
        if root.skins.is_empty() {
            return this;
        }
        for (at, node) in rig.nodes.iter().enumerate() {
            this.known.entry(node.index).or_insert(at);
        }
        for (parent, node) in root.nodes.iter().enumerate() {
            for child in node.children.iter().flatten() {
                this.parents.entry(child.value()).or_insert(parent);
            }
        }
        this
    }

    /// The node of the file in the rig. One that the scene does not show is added, with those above it.
    fn find(
        &mut self,
        index: usize,
        root: &json::Root,
        rig: &mut Rig,
        warnings: &mut Vec<String>,
    ) -> Result<usize, Problem> {
        let mut missing = Vec::new();
        let mut above = Some(index);
        // The hierarchy has no cycles.
        while let Some(index) = above.filter(|index| !self.known.contains_key(index)) {
            missing.push(index);
            above = self.parents.get(&index).copied();
        }
        let mut at = above.map(|index| self.known[&index]);
        for index in missing.into_iter().rev() {
            let node = &root.nodes[index];
            let place = place("nodes", index, node.name.as_deref());
            let (rest, parent_from_node) = local_transform(node, &place, warnings)?;
            let world_from_parent = at.map_or(DMat4::IDENTITY, |parent| rig.nodes[parent].world_from_node);
            let world_from_node = world_from_parent * parent_from_node;
            if !world_from_node.as_mat4().is_finite() {
                return Err(Problem::invalid(place, "a finite world transform", "one that overflows"));
            }
            rig.nodes.push(RigNode {
                index,
                parent: at,
                rest,
                parent_from_node,
                world_from_node,
                is_hidden: false,
                weights: 0..0,
            });
            at = Some(rig.nodes.len() - 1);
            self.known.insert(index, rig.nodes.len() - 1);
        }
        // `missing` is empty only if the node was known.
        Ok(at.unwrap_or_default())
    }
}
