//! What a pixel shows: the instances of a model that may cover it, and the nearest point of a surface.

use glam::{Mat4, Vec2, Vec3, Vec4Swizzles as _};

use super::CameraView;
use super::gltf::triangles;
use super::model::{Model, Primitive, Topology};

/// Margin in pixels around a primitive: for the width of points and lines, and for the neighbors that derivatives use.
const REACH: f32 = 4.0;

/// For each instance, whether one of its triangles, lines or points comes near the pixel `at` of a picture of this size,
/// hidden or not. The test is conservative: it may be true for an instance that misses the pixel, but never the reverse.
pub fn near_pixel(model: &Model, clip_from_world: Mat4, size: (u32, u32), at: (u32, u32)) -> Vec<bool> {
    let half = Vec2::new(size.0 as f32, size.1 as f32) * 0.5;
    let pixel = Vec2::new(at.0 as f32, at.1 as f32) + 0.5;
    let is_near = |instance: &super::Instance| {
        let primitive = &model.primitives[instance.primitive];
        let clip_from_object = clip_from_world * instance.world_from_object;
        // Position in pixels, relative to `at`. `None` behind the eye.
        let place = |position: [f32; 3]| {
            let clip = clip_from_object * glam::Vec3::from(position).extend(1.0);
            (clip.w > 0.0).then(|| (clip.xy() / clip.w + 1.0) * half - pixel)
        };
        let places: Vec<Option<Vec2>> = primitive.vertices.iter().map(|v| place(v.position)).collect();
        pieces(primitive).any(|piece| reaches(piece.iter().map(|index| places[*index as usize])))
    };
    model.instances.iter().map(is_near).collect()
}

/// The nearest point of the model's triangles, world space, that the middle of the pixel `at` sees in a picture of this size. Hidden
/// back faces and transparent surfaces count too. `None` beside the model.
pub fn point_at(model: &Model, view: &CameraView, size: (u32, u32), at: (u32, u32)) -> Option<Vec3> {
    hit_at(model, view, size, at).map(|(_, point)| point)
}

/// [`point_at`], with the index of the instance that the point is on.
pub fn hit_at(model: &Model, view: &CameraView, (width, height): (u32, u32), at: (u32, u32)) -> Option<(usize, Vec3)> {
    let across = 2.0 * (at.0 as f32 + 0.5) / width.max(1) as f32 - 1.0;
    let up = 1.0 - 2.0 * (at.1 as f32 + 0.5) / height.max(1) as f32;
    let (half, forward) = ((0.5 * view.fovy_rad).tan(), view.forward());
    let right = forward.cross(view.up);
    let ray = forward + right * (across * half * view.aspect) + view.up * (up * half);
    let distances = model.instances.iter().enumerate().flat_map(|(index, instance)| {
        let primitive = &model.primitives[instance.primitive];
        let place = |index: u32| {
            instance.world_from_object.transform_point3(primitive.vertices[index as usize].position.into()) - view.eye
        };
        let triangles = triangles(primitive.topology, &primitive.indices);
        triangles.into_iter().filter_map(move |triangle| Some((index, distance(ray, triangle.map(place))?)))
    });
    let (instance, nearest) = distances.min_by(|(_, a), (_, b)| a.total_cmp(b))?;
    Some((instance, view.eye + ray * nearest))
}

/// Where a ray from the origin meets a triangle, in lengths of `ray` (Moller & Trumbore 1997).
fn distance(ray: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = ray.cross(ac);
    let per_volume = ab.dot(across).recip();
    let u = -a.dot(across) * per_volume;
    let side = (-a).cross(ab);
    let v = ray.dot(side) * per_volume;
    let distance = ac.dot(side) * per_volume;
    // A ray along the triangle makes these infinite or NaN, which no comparison lets pass.
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance.is_finite()).then_some(distance)
}

/// The indices of each triangle, line or point. A fan is one piece.
fn pieces(primitive: &Primitive) -> Box<dyn Iterator<Item = &[u32]> + '_> {
    let indices = primitive.indices.as_slice();
    match primitive.topology {
        Topology::Points => Box::new(indices.chunks(1)),
        Topology::Lines => Box::new(indices.chunks(2)),
        Topology::LineStrip => Box::new(indices.windows(2)),
        Topology::Triangles => Box::new(indices.chunks(3)),
        Topology::TriangleStrip => Box::new(indices.windows(3)),
        Topology::TriangleFan => Box::new(std::iter::once(indices)),
    }
}

/// Whether the bounding box of `places`, with a margin, contains the origin. True if a place is behind the eye.
fn reaches(places: impl Iterator<Item = Option<Vec2>>) -> bool {
    let (mut min, mut max) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for place in places {
        let Some(place) = place else { return true };
        min = min.min(place);
        max = max.max(place);
    }
    min.max_element() <= REACH && max.min_element() >= -REACH
}

#[cfg(test)]
mod tests {
    use super::super::{BUILT_IN, Bounds, built_in};
    use super::*;

    #[test]
    fn what_a_pixel_shows_is_near_and_what_lies_elsewhere_is_not() {
        let mut model = built_in(BUILT_IN[0]).unwrap().unwrap();
        let Bounds { min, max } = model.bounds;
        let (center, radius) = ((min + max) * 0.5, model.bounds.radius());
        let view = CameraView::new(center + Vec3::Z * radius * 4.0, center, 0.6, 1.0, &model.bounds);
        let near = |model: &Model, at| near_pixel(model, view.clip_from_world(), (200, 200), at);
        assert!(near(&model, (100, 100)).contains(&true));
        assert!(!near(&model, (0, 0)).contains(&true));
        // Moved to the right by half of the visible width.
        let shift = Mat4::from_translation(Vec3::X * radius * 4.0 * 0.3_f32.tan());
        model.instances.iter_mut().for_each(|i| i.world_from_object = shift * i.world_from_object);
        assert!(near(&model, (195, 100)).contains(&true));
        // An instance that reaches behind the eye may cover any pixel.
        model.instances.iter_mut().for_each(|i| i.world_from_object = Mat4::from_translation(view.eye - center));
        assert!(near(&model, (0, 0)).contains(&true));
    }
    #[test]
    fn the_point_of_a_pixel_lies_on_the_nearest_surface() {
        let model = built_in("sphere-grid").unwrap().unwrap();
        let Bounds { min, max } = model.bounds;
        let (center, radius) = ((min + max) * 0.5, model.bounds.radius());
        let view = CameraView::new(center + Vec3::Z * radius * 4.0, center, 0.6, 2.0, &model.bounds);
        let size = (400, 200);
        let points: Vec<Vec3> = (0..400).step_by(7).filter_map(|x| point_at(&model, &view, size, (x, 100))).collect();
        assert!(points.len() > 5, "{points:?}");
        for point in points {
            // Its pixel is the one that was asked for, and it is on the side of the spheres towards the eye.
            let clip = view.clip_from_world() * point.extend(1.0);
            let y = (clip.y / clip.w + 1.0) * 100.0;
            assert!((y - 100.5).abs() < 0.01, "{point}: row {y}");
            assert!(point.z > center.z, "{point} is behind the middle of the spheres");
        }
        assert_eq!(point_at(&model, &view, size, (0, 0)), None);
    }
}
