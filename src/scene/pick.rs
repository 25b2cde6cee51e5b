//! Picking: finds the instances of a model that may cover a pixel, and the nearest surface.
//!
//! Lines and points are not picked, and alpha is ignored. Lights of a file are selected by the mark that the window
//! draws for them; they have no handle, since their place is no setting.

use glam::{Mat4, Vec2, Vec3, Vec4Swizzles as _};
use rayon::prelude::*;

use super::CameraView;
use super::gltf::triangles;
use super::model::{Bounds, Instance, Model, Primitive, Topology};

/// Margin in pixels around a primitive: for the width of points and lines, and for the neighbors that derivatives use.
const REACH: f32 = 4.0;

/// For each instance, whether one of its triangles, lines or points comes near the pixel `at` of a frame of this size, hidden or
/// not. The test is conservative: it may be true for an instance that misses the pixel, but never the reverse.
pub fn near_pixel(model: &Model, clip_from_world: Mat4, size: (u32, u32), at: (u32, u32)) -> Vec<bool> {
    let half = Vec2::new(size.0 as f32, size.1 as f32) * 0.5;
    let pixel = Vec2::new(at.0 as f32, at.1 as f32) + 0.5;
    let is_near = |instance: &Instance| {
        let primitive = &model.primitives[instance.primitive];
        let clip_from_object = clip_from_world * instance.world_from_object;
        // Position in pixels, relative to `at`. `None` behind the eye.
        let place = |position: [f32; 3]| {
            let clip = clip_from_object * glam::Vec3::from(position).extend(1.0);
            (clip.w > 0.0).then(|| (clip.xy() / clip.w + 1.0) * half - pixel)
        };
        let places: Vec<Option<Vec2>> = model.vertices(instance).iter().map(|v| place(v.position)).collect();
        pieces(primitive).any(|piece| reaches(piece.iter().map(|index| places[*index as usize])))
    };
    model.instances.iter().map(is_near).collect()
}

/// A surface under a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index into `Model::instances`.
    pub instance: usize,
    /// World space.
    pub point: Vec3,
    /// The vertices of its triangle, as indices into `Primitive::vertices`.
    pub triangle: [u32; 3],
    /// Their weights at the point, which sum to 1.
    pub weights: [f32; 3],
}

/// Which sides of an instance are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// The instance is not drawn.
    None,
    /// Triangles that face the eye.
    Front,
    /// All triangles.
    Both,
}

/// The nearest triangle at the center of the pixel `at` in a frame of this size, among the instances and sides that are drawn.
/// Transparent surfaces count too. `None` where the pixel misses the model.
pub fn pick(
    model: &Model,
    view: &CameraView,
    size: (u32, u32),
    at: (u32, u32),
    sides: impl Fn(usize) -> Sides + Sync,
) -> Option<Hit> {
    let ray = ray(view, size, at);
    let near = |(instance, placed): (usize, &Instance)| {
        let sides = sides(instance);
        let primitive = &model.primitives[placed.primitive];
        // Joints and morph targets may move a primitive out of its box.
        let has_box = model.deformers(placed) == (&[], &[]);
        if sides == Sides::None || (has_box && !enters(ray, view.eye, placed, primitive)) {
            return None;
        }
        let vertices = model.vertices(placed);
        let place =
            |index: u32| placed.world_from_object.transform_point3(vertices[index as usize].position.into()) - view.eye;
        // The renderer reverses the winding of mirrored meshes.
        let mirror = if placed.world_from_object.determinant() < 0.0 { -1.0 } else { 1.0 };
        let hit = |triangle: &[u32; 3]| {
            let corners = triangle.map(place);
            let [a, b, c] = corners;
            let faces_away = (b - a).cross(c - a).dot(ray) * mirror > 0.0;
            let found = distance(ray, corners).filter(|_| sides == Sides::Both || !faces_away)?;
            Some((found, *triangle))
        };
        let triangles = triangles(primitive.topology, &primitive.indices);
        let nearest = triangles
            .par_iter()
            .with_min_len(TRIANGLES_A_TASK)
            .filter_map(hit)
            .min_by(|(a, _), (b, _)| a.0.total_cmp(&b.0))?;
        Some((nearest, instance))
    };
    let all = model.instances.iter().enumerate().filter_map(near);
    let (((nearest, [u, v]), triangle), instance) = all.min_by(|a, b| a.0.0.0.total_cmp(&b.0.0.0))?;
    Some(Hit { instance, point: view.eye + ray * nearest, triangle, weights: [1.0 - u - v, u, v] })
}

/// Triangles that one task tests.
const TRIANGLES_A_TASK: usize = 1 << 14;

/// The direction of the view ray through a pixel, world space; not normalized.
pub fn ray(view: &CameraView, (width, height): (u32, u32), at: (u32, u32)) -> Vec3 {
    let across = 2.0 * (at.0 as f32 + 0.5) / width.max(1) as f32 - 1.0;
    let up = 1.0 - 2.0 * (at.1 as f32 + 0.5) / height.max(1) as f32;
    let (half, forward) = ((0.5 * view.fovy_rad).tan(), view.forward());
    let right = forward.cross(view.up);
    forward + right * (across * half * view.aspect) + view.up * (up * half)
}

/// Whether a ray from `eye` enters the box around an instance. Conservative.
fn enters(ray: Vec3, eye: Vec3, placed: &Instance, primitive: &Primitive) -> bool {
    let mut bounds = Bounds::default();
    for corner in primitive.bounds.corners() {
        bounds.include(placed.world_from_object.transform_point3(corner) - eye);
    }
    // Flat boxes and rounding.
    let margin =
        1e-4 * (bounds.max - bounds.min).max_element() + 1e-6 * bounds.max.abs().max(bounds.min.abs()).max_element();
    let (low, high) = (bounds.min - margin, bounds.max + margin);
    let (mut first, mut last) = (0.0_f32, f32::INFINITY);
    for axis in 0..3 {
        if ray[axis] == 0.0 {
            if low[axis] > 0.0 || high[axis] < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low[axis] / ray[axis], high[axis] / ray[axis]);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    first <= last
}

/// Where a ray from the origin meets a triangle, in lengths of `ray` (Moller & Trumbore 1997), and the weights of its second and third
/// corner there.
fn distance(ray: Vec3, [a, b, c]: [Vec3; 3]) -> Option<(f32, [f32; 2])> {
    let (ab, ac) = (b - a, c - a);
    let across = ray.cross(ac);
    let per_volume = ab.dot(across).recip();
    let u = -a.dot(across) * per_volume;
    let side = (-a).cross(ab);
    let v = ray.dot(side) * per_volume;
    let distance = ac.dot(side) * per_volume;
    // A ray along the triangle makes these infinite or NaN, which no comparison lets pass.
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance.is_finite()).then_some((distance, [u, v]))
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

    /// The nearest point of the model's triangles at a pixel: [`pick`] with both sides of all instances.
    fn point_at(model: &Model, view: &CameraView, size: (u32, u32), at: (u32, u32)) -> Option<Vec3> {
        pick(model, view, size, at, |_| Sides::Both).map(|hit| hit.point)
    }

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
            // It is the requested pixel, and the point is on the near side of the spheres.
            let clip = view.clip_from_world() * point.extend(1.0);
            let y = (clip.y / clip.w + 1.0) * 100.0;
            assert!((y - 100.5).abs() < 0.01, "{point}: row {y}");
            assert!(point.z > center.z, "{point} is behind the middle of the spheres");
        }
        assert_eq!(point_at(&model, &view, size, (0, 0)), None);
    }

    #[test]
    fn a_pixel_picks_the_nearest_instance_that_is_drawn() {
        let model = built_in("sphere-grid").unwrap().unwrap();
        let center = model.bounds.center();
        let eye = center + Vec3::Z * model.bounds.radius() * 4.0;
        let view = CameraView::new(eye, center, 0.6, 1.0, &model.bounds);
        let size = (200, 200);
        for (index, instance) in model.instances.iter().enumerate() {
            let middle = model.primitives[instance.primitive].bounds.center();
            let middle = instance.world_from_object.transform_point3(middle);
            let clip = view.clip_from_world() * middle.extend(1.0);
            let at = (((clip.x / clip.w + 1.0) * 100.0) as u32, ((clip.y / clip.w + 1.0) * 100.0) as u32);
            let hit = |sides: &(dyn Fn(usize) -> Sides + Sync)| pick(&model, &view, size, at, sides);
            let front = hit(&|_| Sides::Front).unwrap();
            let toward = (front.point - middle).dot(eye - middle);
            assert!(front.instance == index && toward > 0.0, "{index}: {front:?}");
            assert_eq!(hit(&|_| Sides::Both), Some(front));
            let others = |other| if other == index { Sides::None } else { Sides::Front };
            assert_ne!(hit(&others).map(|hit| hit.instance), Some(index));
        }
    }
}
