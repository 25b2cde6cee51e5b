//! The panel Model: variant, material override, statistics, and the loader's warnings.

use egui::{RichText, Slider, Ui};

use super::{QUIET, WARNING, angle, color, plural, row, slide};
use crate::app::command::Command;
use crate::app::viewer::ModelStatus;
use crate::scene::{BUILT_IN, Model};
use crate::settings::{MaterialOverride, Settings};

pub(super) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    model: &Model,
    status: &ModelStatus,
    commands: &mut Vec<Command>,
) {
    row(ui, "Model", "Built-in models. Drop a .gltf or .glb file on the window to open it", |ui| {
        let name = if status.loading { "loading…" } else { model.name.as_str() };
        egui::ComboBox::from_id_salt("model").selected_text(name).width(ui.available_width()).truncate().show_ui(
            ui,
            |ui| {
                for name in BUILT_IN {
                    if ui.selectable_label(name == model.name, name).clicked() {
                        commands.push(Command::OpenModel(name.into()));
                    }
                }
            },
        );
    });
    if !model.variants.is_empty() {
        let variant = &mut settings.variant;
        row(ui, "Variant", "Variant of the model's materials (KHR_materials_variants)", |ui| {
            let shown = if variant.is_empty() { "default materials" } else { variant.as_str() }.to_owned();
            egui::ComboBox::from_id_salt("variant").selected_text(shown).show_ui(ui, |ui| {
                ui.selectable_value(variant, String::new(), "default materials");
                for name in &model.variants {
                    ui.selectable_value(variant, name.clone(), name);
                }
            });
        });
    }
    override_material(ui, &mut settings.material);
    let triangles: usize = model.instances.iter().map(|i| model.primitives[i.primitive].indices.len() / 3).sum();
    let size = if model.bounds.is_empty() { glam::Vec3::ZERO } else { model.bounds.max - model.bounds.min };
    let timing = model.timing;
    let lines = [
        format!("{} in {}", plural(triangles, "triangle"), plural(model.instances.len(), "draw")),
        format!(
            "{}, {}",
            plural(model.materials.len().saturating_sub(1), "material"),
            plural(model.images.len(), "image")
        ),
        format!("{:.3} × {:.3} × {:.3} m", size.x, size.y, size.z),
        format!(
            "loaded in {:.0} ms: parse {:.0}, decode {:.0}, tangents {:.0}",
            status.load_ms, timing.parse_ms, timing.decode_ms, timing.tangents_ms
        ),
    ];
    ui.label(RichText::new(lines.join("\n")).small().color(QUIET));
    for warning in &model.warnings {
        ui.label(RichText::new(warning).small().color(WARNING));
    }
    let hint = "Drop a model (.gltf, .glb), an environment (.hdr, .exr) or a shader folder on the window.";
    ui.label(RichText::new(hint).small().color(QUIET));
}

/// The material override.
fn override_material(ui: &mut Ui, material: &mut MaterialOverride) {
    row(ui, "Override", "Replace all materials with one that has no textures", |ui| {
        ui.checkbox(&mut material.enabled, "");
        if material.enabled {
            color(ui, &mut material.base_color);
        }
    });
    if !material.enabled {
        return;
    }
    row(ui, "Metallic", "1 is metal", |ui| slide(ui, Slider::new(&mut material.metallic, 0.0..=1.0).max_decimals(3)));
    row(ui, "Roughness", "Perceptual", |ui| slide(ui, Slider::new(&mut material.roughness, 0.0..=1.0).max_decimals(3)));
    row(ui, "Anisotropy", "Strength", |ui| slide(ui, Slider::new(&mut material.anisotropy, 0.0..=1.0).max_decimals(3)));
    if material.anisotropy > 0.0 {
        let doc = "Angle from the tangent towards the bitangent, in degrees";
        angle(ui, "Direction", doc, &mut material.anisotropy_rotation, -90.0..=90.0);
    }
}
