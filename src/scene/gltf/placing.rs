//! Places the meshes, lights and cameras of a scene in the world.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::{DMat4, DVec3, Mat4};

use super::nodes::PlacedMesh;
use super::place::LARGEST_COORDINATE;
use crate::scene::error::Problem;
use crate::scene::model::{Camera, Instance, Light, Model};
use crate::scene::motion::{Motion, Placement, Pose, Rig};
use crate::scene::outline::used_vertices;

/// A model that is farther from the origin than this many times its radius is moved there: single floats would then tear it by more
/// than a tenth of a pixel.
const FARTHEST: f64 = 1e4;

/// The objects of a scene, with their exact positions.
pub struct Objects {
    /// Meshes.
    pub meshes: Vec<PlacedMesh>,
    /// Lights.
    pub lights: Vec<(Light, DVec3)>,
    /// Cameras.
    pub cameras: Vec<(Camera, DVec3)>,
}

/// Fills `model` with instances, bounds, lights, cameras and motion. `weights` are the morph weights of the file's own pose. `ranges` says
/// which primitives each mesh has.
pub fn place(
    model: &mut Model,
    Objects { meshes, lights, cameras }: Objects,
    (mut motion, weights): (Motion, Vec<f32>),
    ranges: &HashMap<usize, Range<usize>>,
    warnings: &mut Vec<String>,
) -> Result<(), Problem> {
    let first_joints: Vec<usize> = motion.rig.first_joints().collect();
    let mut world = Vec::new();
    for mesh in meshes {
        for primitive in ranges.get(&mesh.mesh).cloned().unwrap_or_default() {
            let deformation = model.primitives[primitive].deformation.as_deref();
            let skin = mesh.skin.filter(|_| deformation.is_some_and(|d| d.influences_per_vertex > 0));
            let has_targets = deformation.is_some_and(|deformation| !deformation.targets.is_empty());
            let first_weight = has_targets.then(|| motion.rig.nodes[mesh.at].weights.start as u32);
            model.instances.push(Instance {
                primitive,
                world_from_object: Mat4::IDENTITY,
                node: mesh.node,
                node_name: mesh.name.clone(),
                first_joint: skin.map(|skin| first_joints[skin] as u32),
                first_weight,
            });
            world.push(mesh.world_from_object);
            let node_from_object = mesh.node_from_object.map(Box::new);
            motion.rig.instances.push(Placement { node: mesh.at, node_from_object, skin });
        }
    }
    if model.instances.is_empty() {
        return Err(Problem::NothingToDraw { found: "meshes without drawable primitives".into() });
    }
    (model.motion, model.pose) = (motion.into(), Pose { weights, ..Pose::default() }.into());
    let shift = center(model, &world, warnings)?;
    Arc::make_mut(&mut model.motion).rig.shift = shift;
    for (instance, world) in model.instances.iter_mut().zip(&world) {
        instance.world_from_object = (DMat4::from_translation(-shift) * *world).as_mat4();
    }
    let moved = |position: DVec3| (position - shift).as_vec3();
    model.lights = lights.into_iter().map(|(light, at)| Light { position: moved(at), ..light }).collect();
    model.cameras = cameras.into_iter().map(|(camera, at)| Camera { eye: moved(at), ..camera }).collect();
    if model.motion.clips.is_empty() && model.motion.rig.skins.is_empty() && model.motion.target_names.is_empty() {
        // It never moves.
        Arc::make_mut(&mut model.motion).rig = Rig::default();
    }
    *model = std::mem::take(model).settled();
    Ok(())
}

/// The center of a model that is far from the origin, and 0 for others.
fn center(model: &Model, world: &[DMat4], warnings: &mut Vec<String>) -> Result<DVec3, Problem> {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut include = |corner: DVec3| (min, max) = (min.min(corner), max.max(corner));
    let pose = model.rest_pose();
    for (instance, world) in model.instances.iter().zip(world) {
        let primitive = &model.primitives[instance.primitive];
        match &primitive.deformation {
            None => {
                let corners = primitive.bounds.corners();
                corners.iter().for_each(|corner| include(world.transform_point3(corner.as_dvec3())));
            }
            Some(deformation) => {
                let (joints, weights) = pose.deformers(instance, deformation);
                // Joints lead to the world.
                let world = if joints.is_empty() { *world } else { DMat4::IDENTITY };
                for index in used_vertices(primitive) {
                    let vertex = &primitive.vertices[index as usize];
                    let position = deformation.position(index as usize, vertex, joints, weights);
                    include(world.transform_point3(position.as_dvec3()));
                }
            }
        }
    }
    let size = min.abs().max(max.abs()).max_element();
    if size.is_nan() || size > f64::from(LARGEST_COORDINATE) {
        let expected = format!("coordinates up to {LARGEST_COORDINATE:e} in world space");
        return Err(Problem::invalid("the scene", expected, format!("{size:e}")));
    }
    let (center, radius) = ((min + max) * 0.5, (max - min).length() * 0.5);
    let is_far = radius > 0.0 && center.length() > FARTHEST * radius;
    if is_far {
        warnings.push(format!(
            "The model is {:.0} m away from the origin, too far for its size of {:.3} m: it is shown at the origin.",
            center.length(),
            2.0 * radius
        ));
    }
    // A vector of single floats, so that vertices far from their mesh's origin are moved without rounding, too.
    Ok(if is_far { center.as_vec3().as_dvec3() } else { DVec3::ZERO })
}
