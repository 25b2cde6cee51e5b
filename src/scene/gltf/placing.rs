//! Places the meshes, lights and cameras of a scene in the world.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DMat4, DVec3};

use super::nodes::PlacedMesh;
use super::place::LARGEST_COORDINATE;
use crate::scene::error::Problem;
use crate::scene::model::{Camera, Instance, Light, Model};

/// A model that is farther from the origin than this many times its radius is moved there: single floats would then tear it by more
/// than a tenth of a pixel.
const FARTHEST: f64 = 1e4;

/// Fills `model` with instances, bounds, lights and cameras. `ranges` says which primitives each mesh has.
pub fn place(
    model: &mut Model,
    meshes: Vec<PlacedMesh>,
    lights: Vec<(Light, DVec3)>,
    cameras: Vec<(Camera, DVec3)>,
    ranges: &HashMap<usize, Range<usize>>,
    warnings: &mut Vec<String>,
) -> Result<(), Problem> {
    let primitives = |mesh: &PlacedMesh| ranges.get(&mesh.mesh).cloned().unwrap_or_default();
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (mesh, primitive) in meshes.iter().flat_map(|mesh| primitives(mesh).map(move |primitive| (mesh, primitive))) {
        for corner in model.primitives[primitive].bounds.corners() {
            let corner = mesh.world_from_object.transform_point3(corner.as_dvec3());
            (min, max) = (min.min(corner), max.max(corner));
        }
    }
    let size = min.abs().max(max.abs()).max_element();
    if min.x > max.x {
        return Err(Problem::NothingToDraw { found: "meshes without drawable primitives".into() });
    }
    if size > f64::from(LARGEST_COORDINATE) {
        let expected = format!("coordinates up to {LARGEST_COORDINATE:e} in world space");
        return Err(Problem::invalid("the scene", expected, format!("{size:e}")));
    }
    let (center, radius) = ((min + max) * 0.5, (max - min).length() * 0.5);
    let is_far = radius > 0.0 && center.length() > FARTHEST * radius;
    // A vector of single floats, so that vertices far from their mesh's origin are moved without rounding, too.
    let shift = if is_far { center.as_vec3().as_dvec3() } else { DVec3::ZERO };
    if is_far {
        warnings.push(format!(
            "The model is {:.0} m away from the origin, too far for its size of {:.3} m: it is shown at the origin.",
            center.length(),
            2.0 * radius
        ));
    }
    for mesh in meshes {
        let world_from_object = (DMat4::from_translation(-shift) * mesh.world_from_object).as_mat4();
        for primitive in primitives(&mesh) {
            let node_name = mesh.name.clone();
            let (first_joint, first_weight) = (None, None);
            let node = mesh.node;
            model.instances.push(Instance { primitive, world_from_object, node, node_name, first_joint, first_weight });
        }
    }
    model.bounds = model.instance_bounds();
    let moved = |position: DVec3| (position - shift).as_vec3();
    model.lights = lights.into_iter().map(|(light, at)| Light { position: moved(at), ..light }).collect();
    model.cameras = cameras.into_iter().map(|(camera, at)| Camera { eye: moved(at), ..camera }).collect();
    Ok(())
}
