//! The factors of a material as rows: those of the file, or what the user has set instead.

use egui::{Button, RichText, Ui};

use super::rows::textures;
use super::title::title;
use crate::app::command::layout::OPEN_PANEL;
use crate::app::command::scene::SELECT;
use crate::app::command::spec::Command;
use crate::app::numbers::Scale;
use crate::app::state::arrangement::Panel;
use crate::app::state::selection::Selected;
use crate::app::widgets::color;
use crate::app::widgets::rows::{Row, edit_number, heading, set_option, short};
use crate::app::widgets::theme::{ACCENT, QUIET, WARNING};
use crate::frame::Scene;
use crate::scene::{Material, MaterialFactor, material_factors, slot_name};
use crate::settings::{FactorValue, Settings, factor_path};

/// Shows the material with this index. Values that are set are stored under its name.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, scene: &Scene, index: usize, commands: &mut Vec<Command>) {
    let model = scene.model();
    let Some(of_file) = model.materials.get(index) else { return };
    let key = model.material_key(index);
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
    // Factors of extensions that the material does not use are folded away.
    let (used, unused): (Vec<&MaterialFactor>, Vec<&MaterialFactor>) =
        material_factors().filter(|factor| (factor.applies)(of_file)).partition(|factor| {
            let is_set = settings.materials.get(&key).is_some_and(|values| values.contains_key(&factor.factor));
            is_set || (factor.is_used)(shown)
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
            commands.push(SELECT.with(Selected::Texture(source)));
            commands.push(OPEN_PANEL.with(Panel::TEXTURE));
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
fn row(ui: &mut Ui, settings: &mut Settings, key: &str, of_file: &Material, field: &MaterialFactor) {
    let of = field.factor;
    let (entry, original) = (of.entry(), (field.get)(of_file));
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
        FactorValue::Color(linear) => color::edit(ui, linear),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Factor;

    #[test]
    fn rows_that_nobody_edits_set_nothing() {
        let egui = egui::Context::default();
        let mut settings = Settings::default();
        for _ in 0..3 {
            let _ = egui.run_ui(egui::RawInput::default(), |ui| {
                for factor in material_factors() {
                    row(ui, &mut settings, "Paint", &Material::default(), factor);
                }
            });
        }
        assert!(settings.materials.is_empty(), "{:?}", settings.materials);
        // Nor do they change what was set.
        settings.materials.entry("Paint".into()).or_default().insert(Factor::Roughness, FactorValue::Number(0.3));
        let before = settings.clone();
        let _ = egui.run_ui(egui::RawInput::default(), |ui| {
            let roughness = material_factors().find(|known| known.factor == Factor::Roughness).unwrap();
            row(ui, &mut settings, "Paint", &Material::default(), roughness);
        });
        assert_eq!(settings, before);
    }
}
