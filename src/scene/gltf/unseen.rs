//! Finds models of which nothing can be seen.

use glam::{Mat3, Vec3};

use super::geometry::triangles::has_faces;
use crate::scene::model::{AlphaMode, Instance, Model};

/// Whether an instance passes a check.
type Check = fn(&Model, &Instance) -> bool;

/// A sentence that says why nothing of the model can be seen; `None` if something can.
pub fn reason(model: &Model) -> Option<String> {
    // Each check looks at the instances that all checks before it have passed.
    let mut left: Vec<&Instance> = model.instances.iter().collect();
    let checks: [(&str, Check); 3] = [
        ("all vertices of a mesh are in one point or line", has_area),
        ("the nodes have a scale of 0", is_spread),
        ("the alpha of all materials is 0, or below their cutoff", has_alpha),
    ];
    for (why, passes) in checks {
        left.retain(|instance| passes(model, instance));
        if left.is_empty() {
            return Some(format!("Nothing of the model can be seen: {why}."));
        }
    }
    None
}

/// The edges of the box around a primitive, of which the longest has a length of 1, since the area of a very small model is 0 in floats.
fn edges(model: &Model, instance: &Instance) -> [Vec3; 3] {
    let bounds = &model.primitives[instance.primitive].bounds;
    let size = bounds.max - bounds.min;
    let size = size / size.max_element().max(f32::MIN_POSITIVE);
    [Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z]
}

/// Points and lines always have an area, since they are drawn with a width.
fn spans_area([x, y, z]: [Vec3; 3], model: &Model, instance: &Instance) -> bool {
    !has_faces(model.primitives[instance.primitive].topology)
        || [x.cross(y), y.cross(z), z.cross(x)].iter().any(|area| *area != Vec3::ZERO)
}

fn has_area(model: &Model, instance: &Instance) -> bool {
    spans_area(edges(model, instance), model, instance)
}

fn is_spread(model: &Model, instance: &Instance) -> bool {
    let linear = Mat3::from_mat4(instance.world_from_object);
    let longest = linear.to_cols_array().into_iter().fold(0.0, |most: f32, element| most.max(element.abs()));
    longest > 0.0 && spans_area(edges(model, instance).map(|edge| linear * edge / longest), model, instance)
}

fn has_alpha(model: &Model, instance: &Instance) -> bool {
    let material = &model.materials[model.primitives[instance.primitive].material];
    let alpha = material.numbers.base_color_factor[3];
    match material.alpha_mode {
        AlphaMode::Opaque => true,
        AlphaMode::Mask => alpha >= material.numbers.alpha_cutoff,
        AlphaMode::Blend => alpha > 0.0,
    }
}
