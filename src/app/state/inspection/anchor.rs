//! The place of the pinned pixel on the model, so that the pin stays on its surface while the picture changes its size.

use glam::{Vec2, Vec3, Vec4Swizzles as _};

use crate::frame::{FrameState, Scene};
use crate::scene::{CameraView, pick};

/// The surface at a pinned pixel.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::app) struct Anchor {
    /// World space; `None` where the pixel misses the model.
    point: Option<Vec3>,
    /// The share of the width and of the height.
    share: Vec2,
    /// The pinned pixel, and the picture in which it has this place.
    at: [u32; 2],
    size: (u32, u32),
    camera: CameraView,
}

impl Anchor {
    /// The place of a pixel of a picture.
    pub(in crate::app) fn new(at: [u32; 2], picture: &FrameState) -> Self {
        let FrameState { camera, size, scene, .. } = picture;
        let point = |scene: &Scene| {
            pick(scene.model(), camera, *size, at.into(), |instance| scene.sides(instance)).map(|hit| hit.point)
        };
        let share = (Vec2::new(at[0] as f32, at[1] as f32) + 0.5) / extent(*size);
        Self { point: scene.as_ref().and_then(point), share, at, size: *size, camera: *camera }
    }

    /// The pixel with this place.
    pub(in crate::app) fn at(&self) -> [u32; 2] {
        self.at
    }

    /// Whether it is still the place of a pixel of a picture: pixels are rounded, so a place is kept from one size to the next.
    pub(in crate::app) fn is_of(&self, at: [u32; 2], picture: &FrameState) -> bool {
        (self.at, self.size, self.camera) == (at, picture.size, picture.camera)
    }

    /// The pixel that shows the place in a picture of another size, and the place there; `None` if it is outside.
    pub(in crate::app) fn moved(&self, size: (u32, u32), camera: CameraView) -> Option<([u32; 2], Self)> {
        let place = match self.point {
            Some(point) => {
                let clip = camera.clip_from_world() * point.extend(1.0);
                Some((clip.xy() / clip.w + 1.0) * 0.5).filter(|_| clip.w > 0.0)?
            }
            None => self.share,
        };
        let place = (place * extent(size)).floor();
        let is_inside = place.cmpge(Vec2::ZERO).all() && place.cmplt(extent(size)).all();
        let at = [place.x as u32, place.y as u32];
        is_inside.then(|| (at, Self { at, size, camera, ..self.clone() }))
    }
}

fn extent((width, height): (u32, u32)) -> Vec2 {
    Vec2::new(width as f32, height as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Bounds;

    #[test]
    fn a_pin_stays_on_its_surface() {
        let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let camera = |aspect: f32| CameraView::new(Vec3::Z * 9.0, Vec3::ZERO, 0.7, aspect, &bounds);
        let wide = ((640, 480), camera(4.0 / 3.0));
        // The height decides about the scale: 1 m to the right of the center.
        let pixels = 240.0 / (9.0 * 0.35_f32.tan());
        let at = [320 + pixels as u32, 240];
        let on_surface = Anchor {
            point: Some(Vec3::X * 1.0001),
            share: (Vec2::new(at[0] as f32, 240.0) + 0.5) / extent(wide.0),
            at,
            size: wide.0,
            camera: wide.1,
        };
        let in_background = Anchor { point: None, ..on_surface.clone() };
        let moved = |anchor: &Anchor, size: (u32, u32)| {
            anchor.moved(size, camera(size.0 as f32 / size.1 as f32)).map(|(at, _)| at)
        };
        assert_eq!(moved(&on_surface, wide.0), Some(at));
        assert_eq!(moved(&on_surface, (480, 480)), Some([240 + pixels as u32, 240]));
        assert_eq!(moved(&on_surface, (64, 480)), None, "a narrow picture does not show it");
        assert_eq!(moved(&in_background, (320, 240)), Some([at[0] / 2, 120]));
        // From size to size, the place and not its pixel counts.
        let (_, small) = on_surface.moved((8, 6), wide.1).unwrap();
        assert_eq!(small.moved(wide.0, wide.1).map(|(at, _)| at), Some(at));
    }
}
