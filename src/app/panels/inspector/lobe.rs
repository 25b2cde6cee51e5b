//! The BRDF of the inspected pixel's material: its lobe in the plane of incidence and in space, and its albedo over the angle. The curves
//! before the last edit are dashed.

use egui::{RichText, Sense, Ui, vec2};

use super::plot::{PARTS, Pair, albedo, polar};
use super::solid;
use crate::app::state::inspection::directions::Directions;
use crate::app::state::inspection::{Asked, Reading, Shown};
use crate::app::widgets::theme::{ERROR, QUIET, WARNING};
use crate::measure::{Curves, Material};

/// Height of the lobe in space, points.
const TALL: f32 = 160.0;
/// Controls of a plot.
const MOVE: &str = "Drag moves the plot, Ctrl+wheel zooms, a double click shows all";

/// The modes of properties that the curves ignore, with glTF's default values.
const LEFT_OUT: [(&str, &str, f32); 9] = [
    ("clearcoat", "clearcoat", 0.0),
    ("sheen-color", "sheen", 0.0),
    ("anisotropy", "anisotropy", 0.0),
    ("iridescence", "iridescence", 0.0),
    ("transmission", "transmission", 0.0),
    ("diffuse-transmission", "diffuse transmission", 0.0),
    ("specular-factor", "specular factor", 1.0),
    ("specular-color", "specular color", 0.04),
    ("ior", "index of refraction", 1.5),
];

/// Shows the page.
pub(super) fn show(
    ui: &mut Ui,
    reading: &Reading,
    shown: Option<&Shown>,
    asked: Option<&Asked>,
    light: u32,
    turn_deg: &mut f32,
) {
    if !reading.is_hit() {
        let text = if reading.is_complete { "The model does not cover this pixel" } else { "Reading the pixel…" };
        ui.label(RichText::new(text).small().color(QUIET));
        return;
    }
    let Some((directions, material)) = reading.directions(light).zip(reading.material(light)) else {
        ui.label(RichText::new(why_not(reading, light)).small().color(QUIET));
        return;
    };
    about(ui, &material, &directions, reading, light);
    let Some(shown) = shown else {
        ui.label(RichText::new("Measuring…").small().color(QUIET));
        return;
    };
    if asked.is_none_or(|asked| asked.material != shown.of) {
        ui.label(RichText::new("Measuring… the curves below still show the previous material").small().color(QUIET));
    }
    let curves = match &shown.now {
        Ok(curves) => curves,
        Err(message) => return drop(ui.label(RichText::new(message).small().color(ERROR))),
    };
    let before = shown.before.as_ref();
    let title = |ui: &mut Ui, title: &str, doc: &str| {
        ui.label(RichText::new(title).small().color(QUIET)).on_hover_text(format!("{doc}. {MOVE}"));
    };
    let doc = "The plane of incidence: the luminance of f NoV, 1/sr, in each direction to the eye. The light comes from the left. \
        The arrow of the eye has this pixel's angle; out of plane: the eye lies outside this plane";
    legend(ui, before.is_some(), &format!("{doc}. {MOVE}"));
    polar(ui, &Pair { now: curves, before }, &shown.of, &directions);
    let chart = |ui: &mut Ui, name: &str, doc: &str, of: fn(&Curves) -> &[[f32; 3]]| {
        title(ui, name, doc);
        albedo(ui, name, &Pair { now: of(curves), before: before.map(of) }, directions.eye_deg);
    };
    let doc = "Part of the light from a uniform white sky that leaves the surface towards the eye, over the angle of the eye from the \
        normal: the integral of f NoL over the hemisphere. Red, green and blue";
    chart(ui, "Albedo", doc, |curves| &curves.albedo);
    let doc = "The same for a base color of white. 1: the surface reflects all light. More: it gains energy. Less: it loses energy";
    chart(ui, "White furnace", doc, |curves| &curves.furnace);
    if let Some(hemisphere) = &curves.hemisphere {
        let doc =
            "f NoV over the hemisphere of directions to the eye, drawn as a length in each direction. Drag to turn it";
        ui.label(RichText::new("Lobe in space").small().color(QUIET)).on_hover_text(doc);
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), TALL), Sense::drag());
        *turn_deg = (*turn_deg - 0.7 * response.drag_delta().x).rem_euclid(360.0);
        if ui.is_rect_visible(rect) {
            solid::paint(&ui.painter().with_clip_rect(rect), rect, hemisphere, &directions, *turn_deg);
        }
        response.on_hover_text(doc);
    }
}

/// The reason why there is nothing to measure.
fn why_not(reading: &Reading, light: u32) -> String {
    let missing = ["position", "shading-normal", "base-color", "metallic", "roughness"];
    let missing: Vec<&str> = missing.into_iter().filter(|slug| reading.numbers(slug).is_none()).collect();
    match missing.as_slice() {
        [] if reading.lights.is_empty() => "There is no light. Turn lights on in the Lights panel".to_owned(),
        [] => format!("Light {} has no direction here", light.max(1)),
        missing => format!("The curves need {}, which this pixel does not have", missing.join(", ")),
    }
}

/// The material and the angles, and the ignored properties.
fn about(ui: &mut Ui, material: &Material, directions: &Directions, reading: &Reading, light: u32) {
    let [r, g, b] = material.base_color;
    let Material { metallic, roughness, .. } = material;
    let text = format!("Base {r:.3} {g:.3} {b:.3}, metallic {metallic:.2}, roughness {roughness:.3}");
    let doc = "The curves are measured with the base color (linear RGB), metallic and roughness of this pixel";
    ui.label(RichText::new(text).small()).on_hover_text(doc);
    let Directions { light_deg, eye_deg, azimuth_deg } = directions;
    let number = reading.light_of(light).map_or(1, |index| index + 1);
    let text = format!("Light {number} at {light_deg:.1}°, eye {eye_deg:.1}°, azimuth of the eye {azimuth_deg:.0}°");
    let doc = "Angles from the shading normal to the light and to the eye, and the azimuth of the eye: 0° on the side where a mirror \
        would reflect the light, 180° on the side of the light. Of all lights, the one nearest to the normal is measured";
    ui.label(RichText::new(text).small()).on_hover_text(doc);
    if *light_deg >= 90.0 {
        let text = "The light is below the horizon of this surface, so the lobe is shown for a light at 89°";
        ui.label(RichText::new(text).small().color(WARNING));
    }
    let left_out = left_out(reading);
    if !left_out.is_empty() {
        let text = format!("Not in the curves: {}", left_out.join(", "));
        let doc =
            "The measured surface has base color, metallic and roughness. All other properties have glTF's defaults";
        ui.label(RichText::new(text).small().color(WARNING)).on_hover_text(doc);
    }
}

/// The properties of the pixel's material that the curves ignore.
fn left_out(reading: &Reading) -> Vec<&'static str> {
    let differs = |slug: &str, default: f32| {
        let numbers = reading.numbers(slug);
        numbers.is_some_and(|numbers| numbers.iter().any(|number| (number - default).abs() > 1e-3))
    };
    LEFT_OUT.into_iter().filter(|(slug, _, default)| differs(slug, *default)).map(|(_, name, _)| name).collect()
}

fn legend(ui: &mut Ui, has_before: bool, doc: &str) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Lobe").small().color(QUIET)).on_hover_text(doc);
        for part in &PARTS {
            ui.label(RichText::new(part.name).small().color(part.color)).on_hover_text(part.doc);
        }
        if has_before {
            let doc = "The shaders before the last edit, with the same material and light";
            ui.label(RichText::new("- - before the last edit").small().color(QUIET)).on_hover_text(doc);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::PixelValue;

    fn reading(values: &[(&str, [f32; 3])]) -> Reading {
        let value = |[r, g, b]: [f32; 3]| PixelValue { value: [r, g, b, 1.0], ..PixelValue::default() };
        let values = values.iter().map(|(slug, numbers)| ((*slug).to_owned(), (value(*numbers), 1)));
        Reading::sample(values.collect())
    }

    #[test]
    fn only_properties_that_differ_from_the_defaults_are_left_out() {
        assert!(left_out(&reading(&[("ior", [1.5; 3]), ("clearcoat", [0.0; 3])])).is_empty());
        let found = left_out(&reading(&[("ior", [1.3; 3]), ("clearcoat", [1.0; 3]), ("anisotropy", [0.0; 3])]));
        assert_eq!(found, ["clearcoat", "index of refraction"]);
    }

    #[test]
    fn what_is_missing_is_named() {
        let known = [("position", [0.0; 3]), ("shading-normal", [0.0, 0.0, 1.0]), ("metallic", [0.0; 3])];
        assert_eq!(
            why_not(&reading(&known), 0),
            "The curves need base-color, roughness, which this pixel does not have"
        );
        let all = [&known[..], &[("base-color", [1.0; 3]), ("roughness", [0.5; 3])]].concat();
        assert!(why_not(&reading(&all), 0).contains("no light"));
    }
}
