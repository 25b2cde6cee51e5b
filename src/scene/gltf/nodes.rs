//! Walks the node hierarchy and places meshes, lights and cameras.

use glam::{Mat4, Quat, Vec3};
use gltf::json;
use json::extensions::scene::khr_lights_punctual as punctual;
use json::validation::Checked;

use super::super::error::Problem;
use super::super::model::{Bounds, Camera, Light, LightKind, Node};
use super::place::{get, out_of_range, place};

/// The objects of a scene.
#[derive(Default)]
pub struct Scene {
    /// The nodes, in the order of the hierarchy.
    pub nodes: Vec<Node>,
    /// Meshes, in the order of the hierarchy.
    pub meshes: Vec<PlacedMesh>,
    /// Lights in world space.
    pub lights: Vec<Light>,
    /// Cameras.
    pub cameras: Vec<PlacedCamera>,
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
    /// Object to world; finite.
    pub world_from_object: Mat4,
}

/// A camera in the world, before the scene's bounds are known.
pub struct PlacedCamera {
    name: String,
    world_from_object: Mat4,
    lens: Lens,
}

enum Lens {
    Perspective { fovy: f32 },
    Orthographic { half_height: f32 },
}

/// Walks the default scene, or the first scene, or all nodes without a parent.
pub fn walk(root: &json::Root) -> Result<Scene, Problem> {
    let has_parent = check_hierarchy(root)?;
    let mut scene = Scene::default();
    let start = match (root.scene, root.scenes.first()) {
        (Some(index), _) => scene_roots(get(&root.scenes, index, "scene", "scenes")?, root, &has_parent)?,
        (None, Some(first)) => scene_roots(first, root, &has_parent)?,
        (None, None) => (0..root.nodes.len()).filter(|&node| !has_parent[node]).collect(),
    };
    // An explicit stack, since files may nest deeper than the thread's stack allows.
    let root_of = |node| (node, None, Mat4::IDENTITY);
    let mut stack: Vec<(usize, Option<usize>, Mat4)> = start.into_iter().rev().map(root_of).collect();
    while let Some((index, parent, world_from_parent)) = stack.pop() {
        let node = &root.nodes[index];
        let place = place("nodes", index, node.name.as_deref());
        let world_from_object = world_from_parent * local_transform(node, &place, &mut scene.warnings)?;
        if !world_from_object.is_finite() {
            return Err(Problem::invalid(place, "a finite world transform", "one that overflows"));
        }
        let at = scene.nodes.len();
        scene.nodes.push(Node { index, name: node.name.clone().unwrap_or_default(), parent, ..Node::default() });
        scene.add(root, node, index, world_from_object, &place)?;
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|child| (child.value(), Some(at), world_from_object)));
    }
    if scene.meshes.is_empty() {
        let found = format!("{} nodes, {} meshes in the file, none in the scene", root.nodes.len(), root.meshes.len());
        return Err(Problem::NothingToDraw { found });
    }
    scene.note_motion(root);
    Ok(scene)
}

fn scene_roots(scene: &json::Scene, root: &json::Root, has_parent: &[bool]) -> Result<Vec<usize>, Problem> {
    let mut roots = Vec::with_capacity(scene.nodes.len());
    let mut listed = vec![false; root.nodes.len()];
    for node in &scene.nodes {
        get(&root.nodes, *node, "scenes[].nodes", "nodes")?;
        let node = node.value();
        if has_parent[node] || std::mem::replace(&mut listed[node], true) {
            let found = format!(
                "nodes[{node}], which is {}",
                if has_parent[node] { "a child of another" } else { "listed twice" }
            );
            return Err(Problem::invalid("scenes[].nodes", "each root node once", found));
        }
        roots.push(node);
    }
    Ok(roots)
}

/// Checks that the nodes form a forest: children in range, at most one parent, no cycle. Returns which nodes have a parent.
fn check_hierarchy(root: &json::Root) -> Result<Vec<bool>, Problem> {
    let count = root.nodes.len();
    let mut has_parent = vec![false; count];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let child = child.value();
            if child >= count {
                return Err(out_of_range(&place("nodes", index, node.name.as_deref()), "nodes", child, count));
            }
            if std::mem::replace(&mut has_parent[child], true) {
                let place = place("nodes", child, root.nodes[child].name.as_deref());
                return Err(Problem::invalid(place, "one parent at most", "two (or the same one twice)"));
            }
        }
    }
    // With at most one parent each, the nodes that no root reaches are on a cycle or below one.
    let mut reached = vec![false; count];
    let mut stack: Vec<usize> = (0..count).filter(|&node| !has_parent[node]).collect();
    while let Some(node) = stack.pop() {
        reached[node] = true;
        stack.extend(root.nodes[node].children.iter().flatten().map(|child| child.value()));
    }
    match reached.iter().position(|reached| !reached) {
        Some(node) => {
            let place = place("nodes", node, root.nodes[node].name.as_deref());
            Err(Problem::invalid(place, "a hierarchy without cycles", "a node that is its own ancestor, or below one"))
        }
        None => Ok(has_parent),
    }
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
        world: Mat4,
        place: &str,
    ) -> Result<(), Problem> {
        let name = node.name.clone().unwrap_or_default();
        if let Some(mesh) = node.mesh {
            let named = get(&root.meshes, mesh, place, "meshes")?.name.clone().unwrap_or_default();
            self.last_node().mesh = Some(named);
            let placed = PlacedMesh { mesh: mesh.value(), node: index, name: name.clone(), world_from_object: world };
            self.meshes.push(placed);
        }
        if let Some(camera) = node.camera {
            let lens = read_lens(get(&root.cameras, camera, place, "cameras")?, camera.value())?;
            let name =
                root.cameras[camera.value()].name.clone().filter(|n| !n.is_empty()).unwrap_or_else(|| name.clone());
            let number = self.cameras.len();
            self.last_node().camera = Some(number);
            self.cameras.push(PlacedCamera { name, world_from_object: world, lens });
        }
        if let Some(light) = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref()) {
            let lights: &[punctual::Light] = root.as_ref();
            let source = get(lights, light.light, place, "KHR_lights_punctual.lights")?;
            let light = read_light(source, light.light.value(), &world, &mut self.warnings)?;
            let number = self.lights.len();
            self.last_node().light = Some(number);
            self.lights.push(light);
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
    let half_height = orthographic.ymag.abs();
    if between(half_height, 0.0, f32::INFINITY) {
        return Ok(Lens::Orthographic { half_height });
    }
    Err(Problem::invalid(place, "a finite ymag that is not 0", orthographic.ymag.to_string()))
}

impl PlacedCamera {
    /// The camera in a scene with these bounds. An orthographic camera becomes a perspective camera that shows the same
    /// height at the depth of the center.
    pub fn place(&self, bounds: &Bounds) -> Camera {
        let world = &self.world_from_object;
        let eye = world.w_axis.truncate();
        let forward = world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
        let up = world
            .transform_vector3(Vec3::Y)
            .reject_from_normalized(forward)
            .normalize_or(forward.any_orthonormal_vector());
        let fovy = match self.lens {
            Lens::Perspective { fovy } => fovy,
            Lens::Orthographic { half_height } => {
                let depth = forward.dot(bounds.center() - eye);
                let depth = if depth > 0.0 { depth } else { bounds.radius() };
                2.0 * (half_height / depth).atan()
            }
        };
        // Avoid the extreme angles that an orthographic camera may yield.
        Camera { name: self.name.clone(), eye, forward, up, fovy: fovy.clamp(1e-3, 3.1) }
    }
}
