//! Details of the selection: its properties and the actions for it.

use egui::{Button, Label, RichText, Ui};

use super::material;
use super::rows::kind;
use super::title::title;
use crate::app::command::camera::LOOK_THROUGH;
use crate::app::command::layout::OPEN_PANEL;
use crate::app::command::scene::{HIDE, ISOLATE, SELECT};
use crate::app::commands::Commands;
use crate::app::panels::{beside, lights};
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::selection::{LightId, Selected, common_material, name_or};
use crate::app::widgets::elide::middle;
use crate::app::widgets::plural;
use crate::app::widgets::rows::heading;
use crate::app::widgets::theme::{ACCENT, QUIET, body_font};
use crate::frame::Scene;
use crate::scene::{Bounds, Model};
use crate::settings::{LightSource, Settings};

pub(super) fn show(
    ui: &mut Ui,
    (state, scene): (&State, &Scene),
    selected: Selected,
    kept: &mut Counts,
    commands: &mut Commands,
) {
    let model = scene.model();
    match selected {
        Selected::Nothing => {}
        Selected::Node(node) => {
            let Some(of) = model.nodes.get(node) else { return };
            let member = model.members.iter().position(|member| member.node == node);
            title(ui, if member.is_some() { "Model" } else { "Node" }, &name_or(&of.name, || format!("#{}", of.index)));
            member.into_iter().for_each(|number| beside::place(ui, &mut commands.settings, number));
            parts(ui, (state, scene), selected, kept, commands);
        }
        Selected::Instance(index) => {
            let Some(instance) = model.instances.get(index) else { return };
            title(ui, "Primitive", &model.primitives[instance.primitive].name);
            parts(ui, (state, scene), selected, kept, commands);
        }
        Selected::Material(index) => material::show(ui, &mut commands.settings, scene, index, &mut commands.list),
        Selected::Texture(source) => {
            let image = source.image(model);
            title(ui, "Texture", image.map_or("", |image| &image.name));
            if ui.button("Show it").on_hover_text("Open the Texture panel").clicked() {
                commands.push(OPEN_PANEL.with(Panel::TEXTURE));
            }
        }
        Selected::Camera(index) => {
            let Some(camera) = model.cameras.get(index) else { return };
            title(ui, "Camera", &camera.name);
            if ui.button("Look through it").on_hover_text("R frames the model again").clicked() {
                commands.push(LOOK_THROUGH.with(index));
            }
        }
        Selected::Light(light) => show_light(ui, &mut commands.settings, model, light),
    }
}

/// The counts of a selection, kept while it is the same.
pub(super) type Counts = Option<(Selected, Scene, String, Option<usize>)>;

/// The counts and the size of the selected primitives, and their material if it is one.
fn counts(kept: &mut Counts, scene: &Scene, selected: Selected, instances: &[bool]) -> (String, Option<usize>) {
    if let Some((of, in_scene, text, material)) = kept
        && *of == selected
        && in_scene.has_same_draws(scene)
    {
        return (text.clone(), *material);
    }
    let model = scene.model();
    let of = || model.instances.iter().zip(instances).filter(|(_, is)| **is).map(|(instance, _)| instance);
    let (mut bounds, mut vertices, mut triangles) = (Bounds::default(), 0, 0);
    for instance in of() {
        let primitive = &model.primitives[instance.primitive];
        vertices += primitive.vertices.len();
        triangles += primitive.indices.len() / 3;
        for corner in primitive.bounds.corners() {
            bounds.include(instance.world_from_object.transform_point3(corner));
        }
    }
    let size = if bounds.is_empty() { glam::Vec3::ZERO } else { bounds.max - bounds.min };
    let text = format!(
        "{}, {triangles} triangles, {vertices} vertices\n{:.3} × {:.3} × {:.3} m",
        plural(of().count(), "primitive"),
        size.x,
        size.y,
        size.z
    );
    let material = common_material(scene, instances);
    // The scene on screen may still be the one before.
    if of().next().is_some() {
        *kept = Some((selected, scene.clone(), text.clone(), material));
    }
    (text, material)
}

/// The counts of the selected primitives, what is done with them, and their material.
fn parts(
    ui: &mut Ui,
    (state, scene): (&State, &Scene),
    selected: Selected,
    kept: &mut Counts,
    commands: &mut Commands,
) {
    let model = scene.model();
    let instances = state.selected_instances();
    let (text, material) = counts(kept, scene, selected, &instances);
    ui.add(Label::new(RichText::new(text).small().color(QUIET)).selectable(true));
    ui.horizontal_wrapped(|ui| {
        let is_isolated = !commands.settings.scene.isolated.is_empty();
        if ui.button("Hide").on_hover_text("Do not draw it (Ctrl+H). Alt+H draws everything again").clicked() {
            commands.push(HIDE.with(()));
        }
        let (name, about) = match is_isolated {
            true => ("Show others", "Draw everything again (/)"),
            false => ("Isolate", "Draw nothing else (/)"),
        };
        if ui.button(name).on_hover_text(about).clicked() {
            commands.push(ISOLATE.with(()));
        }
        if ui.button("Deselect").on_hover_text("Select nothing (Esc)").clicked() {
            commands.push(SELECT.with(Selected::Nothing));
        }
    });
    if let Some(index) = material {
        ui.add_space(4.0);
        material::show(ui, &mut commands.settings, scene, index, &mut commands.list);
    } else {
        heading(ui, "Materials");
        let of = model.instances.iter().zip(instances.iter()).filter(|(_, is)| **is);
        let mut used: Vec<usize> = of.map(|(instance, _)| scene.material_of(instance)).collect();
        used.sort_unstable();
        used.dedup();
        for index in used {
            let name = model.material_key(index);
            let shown = middle(ui.painter(), &name, &body_font(), ui.available_width());
            let link = ui.add(Button::new(RichText::new(shown).color(ACCENT)).frame(false).truncate());
            if link.on_hover_text(format!("{name}\nSelect the material")).clicked() {
                commands.push(SELECT.with(Selected::Material(index)));
            }
        }
    }
}

/// Offers to switch on lights that are off.
fn use_source(ui: &mut Ui, settings: &mut Settings, source: LightSource, text: &str) {
    let now = &mut settings.lights.source;
    if *now != source
        && ui.button(text).on_hover_text("This light is off because another light source is selected").clicked()
    {
        *now = source;
    }
}

fn show_light(ui: &mut Ui, settings: &mut Settings, model: &Model, light: LightId) {
    match light {
        LightId::Orbit(index) => {
            title(ui, "Orbiting light", &format!("Light {}", index + 1));
            use_source(ui, settings, LightSource::Orbit, "Use the orbiting lights");
            lights::orbit(ui, settings, index);
        }
        LightId::Rectangle => {
            title(ui, "Area light", "Rectangle");
            lights::rectangle(ui, settings);
        }
        LightId::Model(index) => {
            let Some(light) = model.lights.get(index) else { return };
            title(ui, kind(light.kind), &name_or(&light.name, || format!("light {index} of the file")));
            use_source(ui, settings, LightSource::Model, "Use the lights of the file");
            let unit = if kind(light.kind) == "directional" { "lx" } else { "cd" };
            let [r, g, b] = light.intensity.to_array();
            let [x, y, z] = light.position.to_array();
            let text =
                format!("{r:.2} {g:.2} {b:.2} {unit}\nat {x:.2} {y:.2} {z:.2} m\nIts position comes from the file.");
            ui.label(RichText::new(text).small().color(QUIET));
            return;
        }
    }
    let text = "Drag its handle in the picture to turn it around the model; Ctrl+drag changes its distance.";
    ui.label(RichText::new(text).small().color(QUIET));
}
