//! Finds the instances of a model that may cover a pixel.

use glam::{Mat4, Vec2, Vec4Swizzles as _};

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
    use glam::Vec3;

    use super::super::{BUILT_IN, Bounds, CameraView, built_in};
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
}
