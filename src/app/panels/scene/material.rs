//! The factors of a material as rows: those of the file, or what the user has set instead.

use egui::{Button, RichText, Ui};

use super::details::title;
use super::tree::textures;
use crate::app::command::Command;
use crate::app::layout::Panel;
use crate::app::numbers::Scale;
use crate::app::panels::{ACCENT, QUIET, WARNING};
use crate::app::state::selection::Selected;
use crate::app::viewer::Viewer;
use crate::app::widgets::rows::{Row, color, edit_number, heading, set_option, short};
use crate::frame::Scene;
use crate::scene::{AlphaMode, Material, factor, slot_name};
use crate::settings::{Factor, FactorValue, Settings, factor_path};

/// Shows the material with this index. Values that are set are stored under its name.
pub(super) fn show(ui: &mut Ui, viewer: &mut Viewer, scene: &Scene, index: usize, commands: &mut Vec<Command>) {
    let model = scene.model();
    let Some(of_file) = model.materials.get(index) else { return };
    let key = model.material_key(index);
    let settings = &mut viewer.session.settings;
    ui.horizontal(|ui| {
        title(ui, "Material", &key);
        if settings.materials.get(&key).is_some_and(|values| !values.is_empty())
            && ui.small_button("Reset").on_hover_text("Reset all factors to those in the file").clicked()
        {
            settings.materials.remove(&key);
        }
    });
    note_override(ui, settings);
    let shown = scene.material(index);
    let (used, unused): (Vec<Factor>, Vec<Factor>) =
        Factor::ALL.iter().copied().filter(|factor| applies(*factor, of_file)).partition(|factor| {
            let is_set = settings.materials.get(&key).is_some_and(|values| values.contains_key(factor));
            is_set || is_used(*factor, shown)
        });
    for factor in used {
        row(ui, settings, &key, of_file, factor);
    }
    if !unused.is_empty() {
        let header = egui::CollapsingHeader::new(RichText::new("More").small().color(QUIET)).id_salt("more factors");
        header.show_unindented(ui, |ui| unused.into_iter().for_each(|factor| row(ui, settings, &key, of_file, factor)));
    }
    let of_material: Vec<_> = textures(model)
        .into_iter()
        .filter_map(|(source, uses)| {
            let slots: Vec<String> =
                uses.iter().filter(|(material, _)| *material == index).map(|(_, slot)| slot_name(*slot)).collect();
            (!slots.is_empty()).then(|| (source, slots.join(", ")))
        })
        .collect();
    if of_material.is_empty() {
        return;
    }
    heading(ui, "Textures");
    for (source, slots) in of_material {
        let name = source.image(model).map_or("", |image| &image.name);
        let text = RichText::new(&slots).color(ACCENT);
        let link = ui.add(Button::new(text).frame(false).truncate());
        if link.on_hover_text(format!("{name}\nClick to see the texture")).clicked() {
            commands.push(Command::Select(Selected::Texture(source)));
            commands.push(Command::OpenPanel(Panel::Texture));
        }
    }
}

/// Says which values the material override hides.
fn note_override(ui: &mut Ui, settings: &Settings) {
    let channels: Vec<&str> = settings.material.channels.names().collect();
    let text = match settings.material.enabled {
        true => "The material override hides this material (Model > Material override).".to_owned(),
        false if channels.is_empty() => return,
        false => format!("The material override replaces {} (Model).", channels.join(", ")),
    };
    ui.label(RichText::new(text).small().color(WARNING));
}

/// The row of a factor.
fn row(ui: &mut Ui, settings: &mut Settings, key: &str, of_file: &Material, of: Factor) {
    let (entry, original) = (of.entry(), factor(of_file, of));
    let set = settings.materials.get(key).and_then(|values| values.get(&of)).copied();
    let before = set.unwrap_or(original);
    let text = match before {
        FactorValue::Number(number) => short(f64::from(number)),
        FactorValue::Color(color) => color.map(|number| short(f64::from(number))).join(","),
    };
    let path = factor_path(key, of);
    let needs_quotes = path.contains(|c: char| c.is_whitespace() || "'\"#;&|<>()$`\\*?[]{}~!".contains(c));
    let option = match needs_quotes {
        true => format!("--set '{}={text}'", path.replace('\'', r"'\''")),
        false => set_option(&path, &text),
    };
    let row = Row { name: entry.label, doc: entry.doc(), option, is_changed: set.is_some(), is_indented: false };
    let mut now = before;
    let resets = row.show(ui, |ui| match &mut now {
        FactorValue::Color(linear) => color(ui, linear),
        FactorValue::Number(number) => {
            let mut shown = number.to_string().parse().unwrap_or(f64::from(*number));
            let response = edit_number(ui, entry.label, &mut shown, &Scale::of(entry));
            if response.changed() {
                *number = shown as f32;
            }
            response
        }
    });
    if resets {
        if let Some(values) = settings.materials.get_mut(key) {
            values.remove(&of);
        }
        settings.materials.retain(|_, values| !values.is_empty());
    } else if now != before {
        settings.materials.entry(key.to_owned()).or_default().insert(of, now);
    }
}

/// Whether a factor can have an effect on a material of this kind.
fn applies(factor: Factor, material: &Material) -> bool {
    match factor {
        Factor::Metallic | Factor::Ior | Factor::Specular => !material.specular_glossiness,
        Factor::Alpha => material.alpha_mode != AlphaMode::Opaque,
        Factor::AlphaCutoff => material.alpha_mode == AlphaMode::Mask,
        Factor::NormalScale => material.textures[crate::interface::TEXTURE_NORMAL as usize].is_some(),
        Factor::Occlusion => material.textures[crate::interface::TEXTURE_OCCLUSION as usize].is_some(),
        _ => true,
    }
}

/// Whether a factor has an effect now; those of extensions that the material does not use are folded away.
fn is_used(factor: Factor, material: &Material) -> bool {
    let has_volume = material.volume.thickness > 0.0;
    match factor {
        Factor::BaseColor
        | Factor::Alpha
        | Factor::AlphaCutoff
        | Factor::Metallic
        | Factor::Roughness
        | Factor::NormalScale
        | Factor::Occlusion
        | Factor::Emissive => true,
        Factor::EmissiveStrength => material.emissive_factor != glam::Vec3::ZERO,
        Factor::Ior => material.ior != 1.5 || material.transmission_factor > 0.0,
        Factor::Specular | Factor::SpecularColor => {
            material.specular.factor != 1.0 || material.specular.color != glam::Vec3::ONE
        }
        Factor::Clearcoat | Factor::ClearcoatRoughness => material.clearcoat.factor > 0.0,
        Factor::SheenColor | Factor::SheenRoughness => material.sheen.color != glam::Vec3::ZERO,
        Factor::Anisotropy | Factor::AnisotropyRotation => material.anisotropy.strength > 0.0,
        Factor::Iridescence | Factor::IridescenceIor | Factor::IridescenceThickness => {
            material.iridescence.factor > 0.0
        }
        Factor::Transmission => material.transmission_factor > 0.0,
        Factor::Thickness | Factor::AttenuationColor | Factor::AttenuationDistance => has_volume,
        Factor::Dispersion => material.dispersion > 0.0,
        Factor::DiffuseTransmission | Factor::DiffuseTransmissionColor => material.diffuse_transmission.factor > 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_nobody_edits_set_nothing() {
        let egui = egui::Context::default();
        let mut settings = Settings::default();
        for _ in 0..3 {
            let _ = egui.run_ui(egui::RawInput::default(), |ui| {
                for factor in Factor::ALL {
                    row(ui, &mut settings, "Paint", &Material::default(), *factor);
                }
            });
        }
        assert!(settings.materials.is_empty(), "{:?}", settings.materials);
        // Nor do they change what was set.
        settings.materials.entry("Paint".into()).or_default().insert(Factor::Roughness, FactorValue::Number(0.3));
        let before = settings.clone();
        let _ = egui.run_ui(egui::RawInput::default(), |ui| {
            row(ui, &mut settings, "Paint", &Material::default(), Factor::Roughness);
        });
        assert_eq!(settings, before);
    }
}
