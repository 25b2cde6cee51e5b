//! The model: what was loaded, and what the loader had to say.

use egui::{RichText, Ui};

use super::{QUIET, WARNING, section};
use crate::app::document::Document;

pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    section(ui, "Model", false, |ui| {
        ui.horizontal(|ui| {
            ui.label(if document.model.name.is_empty() { "none" } else { &document.model.name });
            if document.loading {
                ui.label("loading…");
            }
        });
        let model = &document.model;
        let triangles: usize = model.instances.iter().map(|i| model.primitives[i.primitive].indices.len() / 3).sum();
        let size = if model.bounds.is_empty() { glam::Vec3::ZERO } else { model.bounds.max - model.bounds.min };
        let timing = model.timing;
        let lines = [
            format!("{triangles} triangles in {} draws", model.instances.len()),
            format!("{} materials, {} images", model.materials.len().saturating_sub(1), model.images.len()),
            format!("{:.3} × {:.3} × {:.3} m", size.x, size.y, size.z),
            format!(
                "loaded in {:.0} ms: parse {:.0}, decode {:.0}, tangents {:.0}",
                document.load_ms, timing.parse_ms, timing.decode_ms, timing.tangents_ms
            ),
        ];
        ui.label(RichText::new(lines.join("\n")).small().color(QUIET));
        for warning in &document.model.warnings {
            ui.label(RichText::new(warning).small().color(WARNING));
        }
        ui.label(RichText::new("Drop a .gltf, a .glb or a shader folder on the window.").small().color(QUIET));
    });
}
