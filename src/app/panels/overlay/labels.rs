//! The names of the objects of a built-in chart, below each in the picture.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Align2, Galley, Id, LayerId, Order, Painter, Pos2, Rect, Vec2, pos2, vec2};

use crate::app::widgets::theme::{CARD, TEXT, small_font};
use crate::identity::Identity;
use crate::scene::{BUILT_IN, Bounds, CameraView, Model, view_of};
use crate::settings::CameraSettings;

/// Above this, labels are hidden: the model is not a chart of materials.
const MOST: usize = 40;
/// A chart has at least this many objects with a number in their name.
const FEWEST: usize = 4;

/// Smallest width of a name, points: no word is longer.
const LEAST_WIDTH: f32 = 64.0;
/// Fraction of an object that its name may hide.
const MOST_HIDDEN: f32 = 0.4;

/// Where each named object of a chart is. Empty for other models.
#[derive(Default)]
pub(in crate::app::panels) struct Labels {
    /// The model.
    of: Identity,
    /// Name and bounds in the world.
    objects: Vec<(String, Bounds)>,
}

impl Labels {
    fn update(&mut self, model: &Arc<Model>) {
        let of = Identity::of(model);
        if self.of != of {
            *self = Self { of, objects: objects(model) };
        }
    }
}

/// The objects of a chart: nodes with a name of several words.
fn objects(model: &Model) -> Vec<(String, Bounds)> {
    if !BUILT_IN.contains(&&*model.name) {
        return Vec::new();
    }
    let mut nodes: BTreeMap<usize, (String, Bounds)> = BTreeMap::new();
    for instance in &model.instances {
        if !instance.node_name.contains(' ') {
            continue;
        }
        let Some(primitive) = model.primitives.get(instance.primitive) else { continue };
        let entry = nodes.entry(instance.node).or_insert_with(|| (instance.node_name.to_string(), Bounds::default()));
        for corner in primitive.bounds.corners() {
            entry.1.include(instance.world_from_object.transform_point3(corner));
        }
    }
    let with_number = nodes.values().filter(|(name, _)| name.contains(|c: char| c.is_ascii_digit())).count();
    let is_chart = with_number >= FEWEST && nodes.len() <= MOST;
    if is_chart { nodes.into_values().collect() } else { Vec::new() }
}

/// Shows the names over the picture, below cards. A name that would cover that of a nearer object is left out.
pub(super) fn show(
    egui: &egui::Context,
    labels: &mut Labels,
    model: &Arc<Model>,
    camera: &CameraSettings,
    picture: Rect,
) {
    labels.update(model);
    if labels.objects.is_empty() {
        return;
    }
    let camera = &view_of(model, camera, picture.aspect_ratio());
    let painter = egui.layer_painter(LayerId::new(Order::Background, Id::new("labels"))).with_clip_rect(picture);
    let (pointer, mut has_pointed) = (egui.pointer_hover_pos(), false);
    let mut shown: Vec<Rect> = Vec::new();
    for (name, bounds) in nearest_first(&labels.objects, camera.eye) {
        let corners = bounds.corners().map(|corner| project(camera, corner, picture));
        let Some(corners) = corners.into_iter().collect::<Option<Vec<Pos2>>>() else { continue };
        let around = Rect::from_points(&corners);
        let (center, low) = (bounds.center(), bounds.min.y);
        let Some(foot) = project(camera, glam::Vec3::new(center.x, low, center.z), picture) else { continue };
        let label = Label::new(&painter, name, foot, around.width(), picture);
        // A name would hide a small object, so there it appears under the mouse.
        if label.rect.area() > MOST_HIDDEN * around.area() {
            let is_pointed = pointer.is_some_and(|at| around.contains(at));
            if !is_pointed || std::mem::replace(&mut has_pointed, true) {
                continue;
            }
        }
        if is_free(label.rect, &shown) {
            shown.push(label.rect);
            label.show(&painter);
        }
    }
}

/// Where a point of the world is in the picture; `None` behind the eye.
fn project(camera: &CameraView, point: glam::Vec3, picture: Rect) -> Option<Pos2> {
    let clip = camera.clip_from_world() * point.extend(1.0);
    let ndc = clip.truncate() / clip.w;
    let at = vec2(0.5 + 0.5 * ndc.x, 0.5 + 0.5 * ndc.y) * picture.size();
    (clip.w > 0.0).then(|| pos2(picture.min.x + at.x, picture.min.y + at.y))
}

/// The objects by their distance from the eye.
fn nearest_first(objects: &[(String, Bounds)], eye: glam::Vec3) -> Vec<&(String, Bounds)> {
    let mut sorted: Vec<_> = objects.iter().collect();
    let distance = |(_, bounds): &(String, Bounds)| bounds.center().distance_squared(eye);
    sorted.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    sorted
}

/// Whether a label may lie here.
fn is_free(rect: Rect, shown: &[Rect]) -> bool {
    shown.iter().all(|other| !other.intersects(rect))
}

/// A name at the foot of an object, a line for each part of it.
struct Label {
    text: Arc<Galley>,
    rect: Rect,
}

impl Label {
    fn new(painter: &Painter, name: &str, foot: Pos2, width: f32, picture: Rect) -> Self {
        let text = name.replace(", ", "\n");
        let text = painter.layout(text, small_font(), TEXT.color(), (0.7 * width).max(LEAST_WIDTH));
        let rect = Align2::CENTER_CENTER.anchor_size(foot, text.size() + vec2(8.0, 2.0));
        // At the edge of the picture it moves inwards.
        let inside = picture.shrink(2.0);
        let low = (inside.min - rect.min).max(Vec2::ZERO);
        let rect = rect.translate(low + (inside.max - rect.max).min(Vec2::ZERO));
        Self { text, rect }
    }

    fn show(self, painter: &Painter) {
        painter.rect_filled(self.rect, 3.0, CARD.color().gamma_multiply(0.72));
        painter.galley(self.rect.min + vec2(4.0, 1.0), self.text, TEXT.color());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::built_in;

    #[test]
    fn charts_have_names_and_other_models_none() {
        for (name, count) in [("clearcoat", 12), ("sphere-grid", 35), ("shader-ball", 0), ("many-lights", 0)] {
            let objects = objects(&built_in(name).unwrap().unwrap());
            assert_eq!(objects.len(), count, "{name}");
        }
    }

    #[test]
    fn a_name_lies_at_its_object() {
        let model = built_in("clearcoat").unwrap().unwrap();
        let camera = CameraSettings { azimuth: 0.0, elevation: 0.0, ..CameraSettings::default() };
        let view = view_of(&model, &camera, 1.5);
        let picture = Rect::from_min_size(Pos2::ZERO, vec2(900.0, 600.0));
        let places: Vec<Pos2> =
            objects(&model).iter().map(|(_, bounds)| project(&view, bounds.center(), picture).unwrap()).collect();
        assert!(places.iter().all(|place| picture.contains(*place)));
        // The first row runs from left to right, above the second.
        assert!(places[0].x < places[1].x && places[0].y < places[4].y);
    }

    #[test]
    fn the_nearest_names_come_first_and_never_overlap() {
        let objects = [4.0, 1.0, 9.0].map(|z| {
            let mut bounds = Bounds::default();
            bounds.include(glam::Vec3::new(0.0, 0.0, z));
            (z.to_string(), bounds)
        });
        let order: Vec<&str> =
            nearest_first(&objects, glam::Vec3::ZERO).into_iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(order, ["1", "4", "9"]);
        let at = |x: f32| Rect::from_min_size(pos2(x, 0.0), vec2(50.0, 20.0));
        assert!(is_free(at(60.0), &[at(0.0)]) && !is_free(at(40.0), &[at(0.0)]));
    }
}
