//! The colors of a mode that shows one for each number: swatches with their meaning in the legend.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Color32, Rect, Rgba, Sense, Stroke, StrokeKind, Ui, WidgetInfo, WidgetType, pos2, vec2};

use crate::app::widgets::theme::small_font;
use crate::frame::Scene;
use crate::shader::{Mode, Numbers, ShaderSet, TreePath, embedded};

/// Most rows of swatches. A mode with more numbers has none.
const MOST: usize = 8;
/// Height of a row and size of a swatch, points.
const HEIGHT: f32 = 15.0;
const SIZE: f32 = 10.0;
/// Gap between a swatch and its name, points.
const GAP: f32 = 6.0;
/// Most characters of a name.
const LONGEST: usize = 32;
/// The files whose functions give the colors of indices.
const COLORS_OF_INDICES: [&str; 2] = ["common/color.glsl", "debug/geometry.glsl"];

/// A color of the picture and its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct Swatch {
    color: Color32,
    name: String,
}

/// The swatches of a mode: its named numbers that have colors, or the few nodes, materials or primitives of the scene.
pub(in crate::app) fn swatches(mode: &Mode, scene: Option<&Scene>, shaders: &ShaderSet) -> Vec<Swatch> {
    match (&mode.numbers, scene) {
        (Some(Numbers::Names(names)), _) => named(names, &mode.number_colors),
        (Some(Numbers::Index), Some(scene)) if has_shipped_colors(shaders) => indexed(&mode.slug, scene),
        _ => Vec::new(),
    }
}

fn named(names: &[String], colors: &[Option<[u8; 3]>]) -> Vec<Swatch> {
    let swatch = |(name, color): (&String, &Option<[u8; 3]>)| {
        let [r, g, b] = (*color)?;
        Some(Swatch { color: Color32::from_rgb(r, g, b), name: name.clone() })
    };
    names.iter().zip(colors).filter_map(swatch).collect()
}

/// Whether the functions that give the colors of indices are those that Specula comes with.
fn has_shipped_colors(shaders: &ShaderSet) -> bool {
    COLORS_OF_INDICES.map(TreePath::from).iter().all(|path| {
        let text = shaders.texts.get(path).map(|text: &Arc<str>| text.as_bytes());
        text.is_some() && text == embedded::read(None, path)
    })
}

/// The parts of the scene that are drawn, if they are few.
fn indexed(slug: &str, scene: &Scene) -> Vec<Swatch> {
    let model = scene.model();
    let instances = model.instances.iter();
    let used: BTreeSet<usize> = match slug {
        "node-id" => instances.map(|instance| instance.node).collect(),
        "material-id" => instances.map(|instance| scene.material_of(instance)).collect(),
        "mesh-id" => instances.map(|instance| instance.primitive).collect(),
        _ => return Vec::new(),
    };
    if used.len() > MOST {
        return Vec::new();
    }
    let swatch = |at: usize| {
        let name = match slug {
            "node-id" => model.node_key(at),
            "material-id" => model.material_key(at),
            _ => model.primitives[at].name.clone(),
        };
        let name: String = name.chars().take(LONGEST).collect();
        Swatch { color: color_from_id(at as u32), name: format!("{at}  {name}").trim_end().to_owned() }
    };
    used.into_iter().map(swatch).collect()
}

/// `color_from_id` of `common/color.glsl`.
fn color_from_id(id: u32) -> Color32 {
    // The fraction of id / phi.
    let hue = (f64::from(id.wrapping_add(1).wrapping_mul(2_654_435_769)) / 4_294_967_296.0) as f32;
    let [r, g, b] = [0.0, 1.0, 2.0].map(|third: f32| 0.55 + 0.45 * (std::f32::consts::TAU * (hue + third / 3.0)).cos());
    Color32::from(Rgba::from_rgb(r, g, b))
}

/// Shows a row for each swatch.
pub(super) fn show(ui: &mut Ui, swatches: &[Swatch]) {
    ui.spacing_mut().item_spacing.y = 1.0;
    for Swatch { color, name } in swatches {
        let text_color = ui.visuals().text_color();
        let galley = ui.painter().layout_no_wrap(name.clone(), small_font(), text_color);
        let size = vec2(SIZE + GAP + galley.size().x, HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, name));
        let middle = rect.center().y;
        let square = Rect::from_center_size(pos2(rect.min.x + 0.5 * SIZE, middle), vec2(SIZE, SIZE));
        ui.painter().rect_filled(square, 2.0, *color);
        ui.painter().rect_stroke(square, 2.0, Stroke::new(1.0, Color32::from_gray(70)), StrokeKind::Inside);
        let at = pos2(rect.min.x + SIZE + GAP, middle - 0.5 * galley.size().y);
        ui.painter().galley(at, galley, text_color);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_of_indices_are_those_of_the_shader() {
        // The formula of common/color.glsl in double precision, with the sRGB curve.
        let expected = [[129, 253, 179], [202, 105, 246], [234, 221, 91], [92, 218, 236]];
        for (id, expected) in (0..).zip(expected) {
            let [r, g, b, _] = color_from_id(id).to_array();
            let off = [r, g, b].iter().zip(expected).map(|(a, b)| a.abs_diff(b)).max();
            assert!(off <= Some(1), "{id}: {r} {g} {b}");
        }
    }

    /// The sRGB color of `const vec3 NAME = vec3(R, G, B);` in a file of the tree.
    fn constant(path: &str, name: &str) -> Option<[u8; 3]> {
        let text = String::from_utf8(embedded::read(None, &TreePath::from(path)).unwrap().to_vec()).unwrap();
        let start = text.find(&format!("const vec3 {name} = vec3(")).unwrap();
        let list = text[start..].split(['(', ')']).nth(1).unwrap();
        let linear: Vec<f32> = list.split(',').map(|number| number.trim().parse().unwrap()).collect();
        let [r, g, b, _] = Color32::from(Rgba::from_rgb(linear[0], linear[1], linear[2])).to_array();
        Some([r, g, b])
    }

    #[test]
    fn named_colors_are_those_of_the_shader() {
        let text = String::from_utf8(embedded::read(None, &"debug/modes.glsl".into()).unwrap().to_vec()).unwrap();
        let colors = |slug: &str| {
            let line = text.lines().find(|line| line.starts_with(&format!("//@mode {slug} "))).unwrap();
            let list = line.split("colors=\"").nth(1).unwrap().split('"').next().unwrap();
            let color = |text: &str| {
                let hex = u32::from_str_radix(text.strip_prefix('#')?, 16).unwrap();
                Some([(hex >> 16) as u8, (hex >> 8) as u8, hex as u8])
            };
            list.split('|').map(color).collect::<Vec<_>>()
        };
        let [good, bad] = ["GOOD", "BAD"].map(|name| constant("debug/geometry.glsl", name));
        let [low, high, outside] =
            ["TOO_LOW", "TOO_HIGH", "OUT_OF_RANGE"].map(|name| constant("debug/truth.glsl", name));
        assert_eq!(colors("face-orientation"), [good, bad]);
        assert_eq!(colors("tangent-sign"), [bad, good]);
        assert_eq!(colors("albedo-range"), [None, low, high]);
        assert_eq!(colors("f0-range"), [None, low, high]);
        assert_eq!(colors("nan"), [None, Some([255, 0, 255]), Some([255, 255, 0]), Some([0, 255, 255]), outside]);
    }
}
