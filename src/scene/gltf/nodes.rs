//! Walks the node hierarchy and places meshes, lights and cameras.

use std::collections::HashSet;

use glam::{DMat4, DVec3, Mat4, Quat, Vec3};
use gltf::json;
use json::extensions::scene::khr_lights_punctual as punctual;
use json::validation::Checked;

use super::super::error::Problem;
use super::super::model::{Camera, Lens, Light, LightKind, Node};
use super::place::{get, out_of_range, place};

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
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
}

/// A mesh in the world.
pub struct PlacedMesh {
    /// Index of the mesh; in range.
    pub mesh: usize,
    /// Index of the node.
    pub node: usize,
    /// Name of the node, or empty.
    pub name: String,
    /// Object to world; finite. In doubles, so that a model far from the origin can be moved there without loss.
    pub world_from_object: DMat4,
}

/// The nodes below each node.
struct Hierarchy {
    /// Each child once.
    children: Vec<Vec<usize>>,
    /// How many parents each node has.
    parents: Vec<usize>,
}

/// Walks the chosen scene, or else the default scene, or the first scene, or all nodes without a parent.
pub fn walk(root: &json::Root, chosen: Option<usize>) -> Result<Scene, Problem> {
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
    let root_of = |node| (node, None, DMat4::IDENTITY);
    let mut stack: Vec<(usize, Option<usize>, DMat4)> = start.into_iter().rev().map(root_of).collect();
    let mut hidden = 0;
    while let Some((index, parent, world_from_parent)) = stack.pop() {
        let node = &root.nodes[index];
        if is_hidden(node) {
            hidden += 1;
            continue;
        }
        let place = place("nodes", index, node.name.as_deref());
        let world_from_object = world_from_parent * local_transform(node, &place, &mut scene.warnings)?.as_dmat4();
        if !world_from_object.as_mat4().is_finite() {
            return Err(Problem::invalid(place, "a finite world transform", "one that overflows"));
        }
        let at = scene.nodes.len();
        scene.nodes.push(Node { index, name: node.name.clone().unwrap_or_default(), parent, ..Node::default() });
        scene.add(root, node, index, &world_from_object, &place)?;
        let children = hierarchy.children[index].iter().rev();
        stack.extend(children.map(|child| (*child, Some(at), world_from_object)));
    }
    if hidden > 0 {
        scene.warnings.push(format!("{VISIBILITY} hides {hidden} nodes with all below them: they are not shown."));
    }
    if scene.meshes.is_empty() {
        let found = format!("{} nodes, {} meshes in the file, none in the scene", root.nodes.len(), root.meshes.len());
        return Err(Problem::NothingToDraw { found });
    }
    scene.note_motion(root);
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

fn local_transform(node: &json::Node, place: &str, warnings: &mut Vec<String>) -> Result<Mat4, Problem> {
    let matrix = if let Some(matrix) = &node.matrix {
        Mat4::from_cols_array(matrix)
    } else {
        let rotation = Quat::from_array(node.rotation.unwrap_or_default().0);
        let length = rotation.length();
        let rotation = if length > 0.0 && length.is_finite() {
            rotation / length
        } else if rotation.is_finite() {
            warnings.push(format!("{place} has a rotation of length {length}: none is used."));
            Quat::IDENTITY
        } else {
            rotation
        };
        let scale = Vec3::from(node.scale.unwrap_or([1.0; 3]));
        Mat4::from_scale_rotation_translation(scale, rotation, Vec3::from(node.translation.unwrap_or_default()))
    };
    if !matrix.is_finite() {
        return Err(Problem::invalid(place, "a finite transform", "one that is not"));
    }
    let last_row = matrix.row(3);
    if (last_row - glam::Vec4::W).abs().max_element() > 1e-4 {
        return Err(Problem::invalid(place, "a matrix with the last row 0 0 0 1", last_row.to_string()));
    }
    Ok(matrix)
}

impl Scene {
    fn add(
        &mut self,
        root: &json::Root,
        node: &json::Node,
        index: usize,
        world: &DMat4,
        place: &str,
    ) -> Result<(), Problem> {
        let name = node.name.clone().unwrap_or_default();
        if let Some(mesh) = node.mesh {
            let named = get(&root.meshes, mesh, place, "meshes")?.name.clone().unwrap_or_default();
            self.last_node().mesh = Some(named);
            let placed = PlacedMesh { mesh: mesh.value(), node: index, name: name.clone(), world_from_object: *world };
            self.meshes.push(placed);
        }
        if let Some(camera) = node.camera {
            let lens = read_lens(get(&root.cameras, camera, place, "cameras")?, camera.value())?;
            let name =
                root.cameras[camera.value()].name.clone().filter(|n| !n.is_empty()).unwrap_or_else(|| name.clone());
            let number = self.cameras.len();
            self.last_node().camera = Some(number);
            self.cameras.push((camera_in(world, name, lens), world.w_axis.truncate()));
        }
        if let Some(light) = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref()) {
            let lights: &[punctual::Light] = root.as_ref();
            let source = get(lights, light.light, place, "KHR_lights_punctual.lights")?;
            let light = read_light(source, light.light.value(), &world.as_mat4(), &mut self.warnings)?;
            let number = self.lights.len();
            self.last_node().light = Some(number);
            self.lights.push((light, world.w_axis.truncate()));
        }
        Ok(())
    }

    /// The node that is being added.
    fn last_node(&mut self) -> &mut Node {
        if self.nodes.is_empty() {
            self.nodes.push(Node::default());
        }
        let last = self.nodes.len() - 1;
        &mut self.nodes[last]
    }

    /// Warns of animations, skins and morph targets, which are not supported.
    fn note_motion(&mut self, root: &json::Root) {
        if !root.animations.is_empty() {
            self.warnings.push(format!("{} animations are not played: the rest pose is shown.", root.animations.len()));
        }
        if root.nodes.iter().any(|node| node.skin.is_some()) {
            self.warnings.push("Skins are not supported: skinned meshes are shown where their nodes are.".into());
        }
        if root.meshes.iter().any(|mesh| mesh.primitives.iter().any(|primitive| primitive.targets.is_some())) {
            self.warnings.push("Morph targets are not supported: the base shape is shown.".into());
        }
    }
}

fn read_light(
    light: &punctual::Light,
    index: usize,
    world: &Mat4,
    warnings: &mut Vec<String>,
) -> Result<Light, Problem> {
    let place = place("KHR_lights_punctual.lights", index, light.name.as_deref());
    let color = Vec3::from(light.color);
    // Check both factors, since the product of two negative numbers is positive.
    if !(light.intensity >= 0.0 && light.intensity.is_finite()) {
        let (place, found) = (format!("{place}.intensity"), light.intensity.to_string());
        return Err(Problem::invalid(place, "a finite number of at least 0", found));
    }
    if !(color.is_finite() && color.min_element() >= 0.0) {
        return Err(Problem::invalid(format!("{place}.color"), "finite numbers of at least 0", color.to_string()));
    }
    let intensity = color * light.intensity;
    if !intensity.is_finite() {
        return Err(Problem::invalid(place, "a finite color times intensity", intensity.to_string()));
    }
    let kind = match light.type_ {
        Checked::Valid(punctual::Type::Directional) => LightKind::Directional,
        Checked::Valid(punctual::Type::Point) => LightKind::Point,
        Checked::Valid(punctual::Type::Spot) => {
            let spot = light
                .spot
                .clone()
                .unwrap_or(punctual::Spot { inner_cone_angle: 0.0, outer_cone_angle: std::f32::consts::FRAC_PI_4 });
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(0.0 <= inner && inner < outer && outer <= std::f32::consts::FRAC_PI_2 + 1e-6) {
                let expected = "cone angles with 0 <= inner < outer <= pi/2";
                return Err(Problem::invalid(place, expected, format!("{inner} and {outer}")));
            }
            LightKind::Spot { inner, outer }
        }
        Checked::Invalid => return Err(Problem::invalid(place, "the type directional, point or spot", "another")),
    };
    let range = light.range.filter(|range| *range > 0.0 && range.is_finite());
    if range != light.range {
        warnings.push(format!("{place} has a range that is not above 0: it is taken as endless."));
    }
    Ok(Light {
        name: light.name.clone().unwrap_or_default(),
        kind,
        position: world.w_axis.truncate(),
        // Lights shine along -Z of their node.
        direction: world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z),
        intensity,
        range,
    })
}

fn read_lens(camera: &json::Camera, index: usize) -> Result<Lens, Problem> {
    let place = place("cameras", index, camera.name.as_deref());
    let between = |value: f32, least: f32, most: f32| value > least && value < most;
    if let Some(perspective) = &camera.perspective {
        if between(perspective.yfov, 0.0, std::f32::consts::PI) {
            return Ok(Lens::Perspective { fovy: perspective.yfov });
        }
        return Err(Problem::invalid(place, "a yfov above 0 and below pi", perspective.yfov.to_string()));
    }
    let Some(orthographic) = &camera.orthographic else {
        return Err(Problem::invalid(place, "a perspective or an orthographic projection", "neither"));
    };
    let height = 2.0 * orthographic.ymag.abs();
    if between(height, 0.0, f32::INFINITY) {
        return Ok(Lens::Orthographic { height });
    }
    Err(Problem::invalid(place, "a finite ymag that is not 0", orthographic.ymag.to_string()))
}

/// The camera of a node.
fn camera_in(world: &DMat4, name: String, lens: Lens) -> Camera {
    let world = world.as_mat4();
    let forward = world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
    let up = world.transform_vector3(Vec3::Y).reject_from_normalized(forward);
    let up = up.normalize_or(forward.any_orthonormal_vector());
    Camera { name, eye: world.w_axis.truncate(), forward, up, lens }
}
