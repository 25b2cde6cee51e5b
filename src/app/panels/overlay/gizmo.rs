//! Handles of the lights in the picture. They are shown while a light is selected. A drag turns a light around the model; with Ctrl it
//! changes the distance. A light of the model's file has a mark that selects it.

use egui::{Align2, Area, Color32, CursorIcon, Id, LayerId, Order, Painter, Pos2, Rect, Sense, Stroke, pos2, vec2};
use glam::Vec3;

use crate::app::command::scene::SELECT;
use crate::app::commands::Commands;
use crate::app::state::State;
use crate::app::state::selection::{LightId, Selected, name_or};
use crate::app::widgets::theme::{SELECTION, small_font, small_mono_font};
use crate::scene::{Bounds, CameraView, Light, light_direction, ray};
use crate::settings::{LightSettings, LightSource};

/// Radius of a handle, points.
const HANDLE: f32 = 8.0;
/// Points between a handle and the edge of the picture.
const MARGIN: f32 = 16.0;
/// Radius of the smallest sphere that a handle moves on, in radii of the model.
const SMALLEST: f32 = 0.3;
/// Points of a drag that double the distance.
const DOUBLE: f32 = 120.0;

/// Most lights of a file that have a mark, besides the selected one.
const MOST_MARKS: usize = 64;

/// State of the light handles: the drag in progress, and where earlier drags have left handles.
#[derive(Default)]
pub(in crate::app::panels) struct Gizmo {
    drag: Option<Drag>,
    /// Handles that stay where they were dropped, as long as the camera and the light's distance are the same.
    kept: Vec<Kept>,
    view: Option<CameraView>,
}

impl Gizmo {
    /// Forgets where handles were dropped, if the camera has moved since.
    fn follow(&mut self, view: &CameraView) {
        if self.view.replace(*view) != Some(*view) {
            self.kept.clear();
        }
    }

    /// The radius at which a handle was dropped.
    fn kept_radius(&self, light: LightId, distance: f32) -> Option<f32> {
        let found = self.kept.iter().find(|kept| kept.light == light && kept.distance == distance)?;
        Some(found.radius)
    }

    /// Keeps a handle at a radius.
    fn keep(&mut self, light: LightId, distance: f32, radius: f32) {
        self.kept.retain(|kept| kept.light != light);
        self.kept.push(Kept { light, distance, radius });
    }
}

/// A handle that was dropped. A light outside of the picture has its handle nearer to the center, so the handle would jump at the
/// end of a drag that turns the light.
struct Kept {
    light: LightId,
    /// Distance of the light then, in radii of the model.
    distance: f32,
    /// Radius of the sphere that the handle is on, meters.
    radius: f32,
}

struct Drag {
    light: LightId,
    /// Radius of the sphere that the handle moves on, meters.
    radius: f32,
    /// Whether the handle is on the side of the sphere that faces the camera.
    is_near: bool,
}

/// Azimuth, polar angle and distance of a light.
struct LightPlace<'a> {
    azimuth: &'a mut f32,
    polar: &'a mut f32,
    distance: &'a mut f32,
    color: [f32; 3],
}

fn place(lights: &mut LightSettings, light: LightId) -> Option<LightPlace<'_>> {
    match light {
        LightId::Orbit(index) => {
            let light = lights.orbit.get_mut(index)?;
            let (azimuth, polar, distance) = (&mut light.azimuth, &mut light.polar, &mut light.distance);
            Some(LightPlace { azimuth, polar, distance, color: light.color })
        }
        LightId::Rectangle => {
            let light = &mut lights.rect;
            let (azimuth, polar, distance) = (&mut light.azimuth, &mut light.polar, &mut light.distance);
            Some(LightPlace { azimuth, polar, distance, color: light.color })
        }
        LightId::Model(_) => None,
    }
}

/// A picture with its camera.
struct Frame {
    view: CameraView,
    bounds: Bounds,
    rect: Rect,
    /// Pixels.
    size: (u32, u32),
}

impl Frame {
    /// Where a point is in the window; `None` behind the camera.
    fn project(&self, point: Vec3) -> Option<Pos2> {
        let clip = self.view.clip_from_world() * point.extend(1.0);
        let (x, y) = (clip.x / clip.w * 0.5 + 0.5, clip.y / clip.w * 0.5 + 0.5);
        (clip.w > 0.0).then(|| self.rect.min + vec2(x, y) * self.rect.size())
    }

    /// Whether there is room for a handle at a point of the picture.
    fn shows(&self, point: Vec3) -> bool {
        self.project(point).is_some_and(|at| self.rect.shrink(MARGIN).contains(at))
    }

    /// The distance of a light's handle from the model's center: that of the light, `own`, or the largest one that the picture shows.
    fn visible_radius(&self, direction: Vec3, own: f32) -> f32 {
        let is_seen = |radius: f32| self.shows(self.bounds.center() + direction * radius);
        let (mut seen, mut hidden) = (SMALLEST * self.bounds.radius(), own);
        if is_seen(own) || seen > own {
            return own;
        }
        for _ in 0..12 {
            let middle = 0.5 * (seen + hidden);
            *(if is_seen(middle) { &mut seen } else { &mut hidden }) = middle;
        }
        seen
    }

    /// The direction from the model's center to the point of a sphere around it that lies under a point of the window. Beside the
    /// sphere, that of its silhouette.
    fn direction_at(&self, at: Pos2, radius: f32, is_near: bool) -> Vec3 {
        let scale = vec2(self.size.0 as f32, self.size.1 as f32) / self.rect.size();
        let pixel = (at - self.rect.min) * scale;
        let clamp = |x: f32, most: u32| (x.max(0.0) as u32).min(most.saturating_sub(1));
        let ray = ray(&self.view, self.size, (clamp(pixel.x, self.size.0), clamp(pixel.y, self.size.1))).normalize();
        let to_eye = self.view.eye - self.bounds.center();
        let along = to_eye.dot(ray);
        let beside = along * along - (to_eye.length_squared() - radius * radius);
        let distance = match (beside > 0.0, is_near) {
            (false, _) => -along,
            (true, true) => -along - beside.sqrt(),
            (true, false) => -along + beside.sqrt(),
        };
        (to_eye + ray * distance).normalize_or(Vec3::Y)
    }
}

/// Shows the handles over the picture while a light is selected.
pub(super) fn show(egui: &egui::Context, state: &State, gizmo: &mut Gizmo, rect: Rect, commands: &mut Commands) {
    let Selected::Light(selected) = state.selected else {
        gizmo.drag = None;
        return;
    };
    let Some(picture) = state.shown().filter(|picture| picture.pipelines.draws_model) else { return };
    let Some(model) = picture.scene.as_ref().map(|scene| scene.model().clone()) else { return };
    let frame = Frame { view: picture.camera, bounds: model.bounds, rect, size: picture.size };
    let painter = egui.layer_painter(LayerId::new(Order::Background, Id::new("gizmo"))).with_clip_rect(rect);
    gizmo.follow(&frame.view);
    let lights = &mut commands.settings.lights;
    let mut shown = Vec::new();
    if lights.source == LightSource::Orbit {
        shown.extend((0..lights.orbit.len()).map(LightId::Orbit));
    }
    if lights.rect.enabled && lights.source != LightSource::None {
        shown.push(LightId::Rectangle);
    }
    let mut chosen = None;
    let marks = marks(lights.source, model.lights.len(), selected);
    for index in marks.into_iter().filter(|index| !model.pose.hidden.light(*index)) {
        let (light, of) = (&model.lights[index], LightId::Model(index));
        if mark(egui, &painter, &frame, light, of, of == selected) {
            chosen = Some(of);
        }
    }
    for light in shown {
        if handle(egui, &painter, &frame, lights, light, light == selected, gizmo) {
            chosen = Some(light);
        }
    }
    if let Some(light) = chosen.filter(|light| *light != selected) {
        commands.push(SELECT.with(Selected::Light(light)));
    }
}

/// Shows the handle of a light and moves the light with it. Returns whether the user grabs it.
fn handle(
    egui: &egui::Context,
    painter: &Painter,
    frame: &Frame,
    lights: &mut LightSettings,
    light: LightId,
    is_selected: bool,
    gizmo: &mut Gizmo,
) -> bool {
    let Some(place) = place(lights, light) else { return false };
    let (center, model_radius) = (frame.bounds.center(), frame.bounds.radius());
    let direction = light_direction(*place.azimuth, *place.polar);
    let drag = gizmo.drag.take_if(|drag| drag.light == light);
    let own = model_radius * *place.distance;
    let kept = gizmo.kept_radius(light, *place.distance).filter(|radius| frame.shows(center + direction * *radius));
    let at_rest = || kept.unwrap_or_else(|| frame.visible_radius(direction, own));
    let radius = drag.as_ref().map_or_else(at_rest, |drag| drag.radius);
    let (Some(at), Some(middle)) = (frame.project(center + direction * radius), frame.project(center)) else {
        return false;
    };
    let color = if is_selected { SELECTION } else { Color32::from_gray(200) };
    let thin = Stroke::new(1.0, color.gamma_multiply(0.6));
    painter.extend(egui::Shape::dashed_line(&[middle, at], thin, 5.0, 4.0));
    let area = Area::new(Id::new(("light", light))).order(Order::Middle).fade_in(false).constrain(false);
    let side = vec2(2.5 * HANDLE, 2.5 * HANDLE);
    let area = area.fixed_pos(at - 0.5 * side);
    let response = area.show(egui, |ui| ui.allocate_response(side, Sense::click_and_drag())).inner;
    let [r, g, b] = place.color.map(|channel| (channel.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0) as u8);
    let size = if response.hovered() || drag.is_some() { HANDLE + 1.5 } else { HANDLE };
    painter.circle(at, size, Color32::from_rgb(r, g, b), Stroke::new(2.5, Color32::from_black_alpha(200)));
    painter.circle_stroke(at, size + 1.0, Stroke::new(1.5, color));
    let name = match light {
        LightId::Orbit(index) => (index + 1).to_string(),
        _ => "R".to_owned(),
    };
    painter.text(at, Align2::CENTER_CENTER, name, small_font(), Color32::BLACK);
    let is_held = response.dragged();
    if is_held {
        // Towards the camera is on its side of the sphere.
        let is_near = (frame.view.eye - center).dot(direction) > radius * radius / (frame.view.eye - center).length();
        let mut drag = drag.unwrap_or(Drag { light, radius, is_near });
        if egui.input(|input| input.modifiers.command) {
            let factor = (-response.drag_delta().y / DOUBLE).exp2();
            *place.distance = (*place.distance * factor).clamp(1e-3, 1e6);
            drag.radius = if radius == own { model_radius * *place.distance } else { radius };
        } else if let Some(to) = response.interact_pointer_pos() {
            let direction = frame.direction_at(to, radius, drag.is_near);
            *place.azimuth = direction.x.atan2(direction.z).to_degrees();
            *place.polar = direction.y.clamp(-1.0, 1.0).acos().to_degrees();
        }
        gizmo.keep(light, *place.distance, drag.radius);
        gizmo.drag = Some(drag);
        let text = format!("{:.0}° {:.0}°  {:.2} R", *place.azimuth, *place.polar, *place.distance);
        let label = painter.layout_no_wrap(text, small_mono_font(), Color32::WHITE);
        let size = label.size() + vec2(8.0, 4.0);
        // On the side that has room.
        let left = if at.x + 14.0 + size.x <= frame.rect.max.x { at.x + 14.0 } else { at.x - 14.0 - size.x };
        let back = Rect::from_min_size(pos2(left, at.y - 8.0), size);
        painter.rect_filled(back, 3.0, Color32::from_black_alpha(200));
        painter.galley(back.min + vec2(4.0, 2.0), label, Color32::WHITE);
        // The next frame shows the light where it is now.
        egui.request_repaint();
    }
    if light == LightId::Rectangle {
        outline(painter, frame, lights, color);
    }
    let is_taken = is_held || response.clicked() || response.is_pointer_button_down_on();
    response.on_hover_cursor(CursorIcon::Grab).on_hover_text(
        "Drag to turn the light around the model. Ctrl+drag up or down changes its distance. Esc hides the handles",
    );
    is_taken
}

/// The rectangle of the area light.
fn outline(painter: &Painter, frame: &Frame, lights: &LightSettings, color: Color32) {
    let light = crate::scene::rectangle_corners(&lights.rect, &frame.bounds);
    let corners: Option<Vec<Pos2>> = light.into_iter().map(|corner| frame.project(corner)).collect();
    if let Some(corners) = corners {
        painter.add(egui::Shape::closed_line(corners, Stroke::new(1.5, color)));
    }
}

/// The lights of the file that have a mark: the selected one, and the first of the others if they are on.
fn marks(source: LightSource, count: usize, selected: LightId) -> Vec<usize> {
    let is_selected = |index: &usize| selected == LightId::Model(*index);
    let shining = (0..count).filter(|index| source == LightSource::Model && !is_selected(index)).take(MOST_MARKS);
    shining.chain((0..count).filter(is_selected)).collect()
}

/// A light of the file, which does not move: a ring at its place, and where it shines. Returns whether the user clicks it.
fn mark(egui: &egui::Context, painter: &Painter, frame: &Frame, light: &Light, id: LightId, is_selected: bool) -> bool {
    let Some(at) = frame.project(light.position).filter(|at| frame.rect.contains(*at)) else { return false };
    let color = if is_selected { SELECTION } else { Color32::from_gray(200) };
    painter.circle_stroke(at, HANDLE, Stroke::new(2.0, color));
    let ahead = frame.project(light.position + light.direction * 0.25 * frame.bounds.radius());
    if let Some(ahead) = ahead.filter(|ahead| ahead.distance(at) > HANDLE) {
        let start = at + (ahead - at).normalized() * HANDLE;
        painter.arrow(start, ahead - start, Stroke::new(1.5, color));
    } else {
        painter.circle_filled(at, 2.0, color);
    }
    let side = vec2(2.5 * HANDLE, 2.5 * HANDLE);
    let area = Area::new(Id::new(("light", id))).order(Order::Middle).fade_in(false).constrain(false);
    let area = area.fixed_pos(at - 0.5 * side);
    let response = area.show(egui, |ui| ui.allocate_response(side, Sense::click())).inner;
    let is_clicked = response.clicked();
    let name = name_or(&light.name, || "A light".to_owned());
    response.on_hover_text(format!("{name}, of the model's file, which says where it is. Esc hides the marks"));
    is_clicked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_of_the_window_is_the_direction_that_it_shows() {
        let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let view = CameraView::new(Vec3::new(1.0, 2.0, 8.0), Vec3::ZERO, 0.7, 1.5, &bounds);
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(600.0, 400.0));
        let frame = Frame { view, bounds, rect, size: (600, 400) };
        for (azimuth, polar) in [(0.0, 90.0), (40.0, 60.0), (-30.0, 110.0), (170.0, 80.0)] {
            let direction = light_direction(azimuth, polar);
            let radius = 1.3 * bounds.radius();
            let at = frame.project(direction * radius).unwrap();
            let is_near = (view.eye - direction * radius).dot(direction) > 0.0;
            let found = frame.direction_at(at, radius, is_near);
            assert!(found.distance(direction) < 0.02, "{azimuth} {polar}: {found} instead of {direction}");
        }
        // A handle that would be outside comes nearer.
        let left = Vec3::NEG_X;
        let radius = frame.visible_radius(left, 50.0);
        let at = frame.project(left * radius).unwrap();
        assert!(radius < 50.0 && (at.x - rect.min.x - MARGIN).abs() < 1.0, "{radius} {at:?}");
        assert_eq!(frame.visible_radius(left, 1.0), 1.0);
        // Beside the sphere, its edge.
        let edge = frame.direction_at(pos2(101.0, 51.0), 0.5, true);
        assert!((edge.length() - 1.0).abs() < 1e-4);
    }

    #[test]
    fn the_lights_of_a_file_have_marks_while_they_shine() {
        let selected = LightId::Model(1);
        assert_eq!(marks(LightSource::Model, 3, selected), [0, 2, 1], "the selected one lies over the others");
        assert_eq!(marks(LightSource::Orbit, 3, selected), [1]);
        assert_eq!(marks(LightSource::Model, 3, LightId::Rectangle), [0, 1, 2]);
        assert_eq!(marks(LightSource::Orbit, 3, LightId::Orbit(0)), [0; 0]);
        assert_eq!(marks(LightSource::Model, 200, LightId::Model(199)).len(), MOST_MARKS + 1);
    }

    #[test]
    fn a_dropped_handle_stays_until_the_camera_or_the_distance_changes() {
        let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let view = |x: f32| CameraView::new(Vec3::new(x, 2.0, 8.0), Vec3::ZERO, 0.7, 1.5, &bounds);
        let light = LightId::Orbit(1);
        let mut gizmo = Gizmo::default();
        gizmo.follow(&view(1.0));
        gizmo.keep(light, 2.0, 1.3);
        gizmo.follow(&view(1.0));
        assert_eq!(gizmo.kept_radius(light, 2.0), Some(1.3));
        assert_eq!(gizmo.kept_radius(light, 2.5), None, "another distance");
        assert_eq!(gizmo.kept_radius(LightId::Rectangle, 2.0), None, "another light");
        gizmo.follow(&view(1.1));
        assert_eq!(gizmo.kept_radius(light, 2.0), None, "another camera");
    }
}
