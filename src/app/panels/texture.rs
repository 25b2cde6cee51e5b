//! The panel Texture: the selected texture as the device has it, with its channels, levels, zoom and the texture coordinates of the
//! meshes that use it.

use egui::{Color32, Label, Rect, RichText, Sense, Ui, Vec2, pos2, vec2};

use super::scene::rows::textures;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::selection::Selected;
use crate::app::state::workspace::TextureRequest;
use crate::app::widgets::elide::middle;
use crate::app::widgets::search;
use crate::app::widgets::theme::{EDGE, QUIET, body_font, small_mono_font};
use crate::frame::Scene;
use crate::render::tools::{TextureView, UvMesh};
use crate::scene::{Mip, Model, TextureSource, Wrap, slot_name};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Texture", Group::Modes, "channels mip levels UV", || Box::<TextureState>::default())
        .opens_on_request();

/// The channels that can be looked at, with their hover texts.
const CHANNELS: [(&str, &str); 6] = [
    ("RGB", "Colors, ignoring alpha"),
    ("RGBA", "Colors blended over a checkerboard by alpha"),
    ("R", "The red channel: occlusion, where it shares a texture with metallic and roughness"),
    ("G", "The green channel: roughness"),
    ("B", "The blue channel: metallic"),
    ("A", "The alpha channel: coverage"),
];

/// State of the panel between frames.
pub(super) struct TextureState {
    source: Option<TextureSource>,
    /// The texture that was selected in the scene in the last frame.
    selected: Option<TextureSource>,
    channels: u32,
    /// `None` is the level that fits the scale.
    level: Option<u32>,
    shows_uv: bool,
    /// Points per texel; `None` fits the texture into the panel.
    scale: Option<f32>,
    /// The texture coordinates in the middle.
    middle: [f32; 2],
    /// The search in the list of textures.
    search: String,
}

impl Default for TextureState {
    fn default() -> Self {
        Self {
            source: None,
            selected: None,
            channels: 0,
            level: None,
            shows_uv: false,
            scale: None,
            middle: [0.5; 2],
            search: String::new(),
        }
    }
}

impl PanelUi for TextureState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        commands.sight.texture = show(ui, context, self);
    }
}

/// Shows the panel. Returns the picture that it needs.
fn show(ui: &mut Ui, context: &Context<'_>, own: &mut TextureState) -> Option<TextureRequest> {
    let scene = context.scene.as_ref()?;
    let model = scene.model();
    let all = textures(model);
    let selected = if let Selected::Texture(source) = context.state.selected { Some(source) } else { None };
    // A texture that the user has chosen in the list since then stays.
    if std::mem::replace(&mut own.selected, selected) != selected && selected.is_some() {
        (own.source, own.level, own.scale, own.middle) = (selected, None, None, [0.5; 2]);
    }
    let source = own.source.filter(|source| all.contains_key(source)).or_else(|| all.keys().next().copied());
    let Some(source) = source else {
        ui.label(RichText::new("The model has no textures").color(QUIET));
        return None;
    };
    own.source = Some(source);
    let (uses, (width, height)) = (&all[&source], source.size(model));
    let names: Vec<(TextureSource, &str)> = all.keys().map(|other| (*other, name_of(*other, model))).collect();
    list(ui, own, source, &names);
    controls(ui, own, source.levels(model));
    let about = about(model, source, uses, (width, height));
    let text_height = 4.0 * 14.0;
    let area = vec2(ui.available_width(), (ui.available_height() - text_height).max(80.0));
    let meshes = if own.shows_uv { meshes(scene, source, uses) } else { Vec::new() };
    let (view, size) = picture(ui, own, source, (width, height), area, context.readings.texture);
    ui.add(Label::new(RichText::new(about).small().color(QUIET)).selectable(true));
    Some(TextureRequest { source, view, meshes, size })
}

/// The name of the image of a texture.
fn name_of(source: TextureSource, model: &Model) -> &str {
    source.image(model).map_or("", |image| image.name.as_str())
}

/// The list of all textures with their names, with a search.
fn list(ui: &mut Ui, own: &mut TextureState, source: TextureSource, all: &[(TextureSource, &str)]) {
    let name = all.iter().find(|(other, _)| *other == source).map_or("", |(_, name)| name);
    // The box has an arrow and margins.
    let shown = middle(ui.painter(), name, &body_font(), ui.available_width() - 34.0);
    let list = egui::ComboBox::from_id_salt("texture").selected_text(shown).width(ui.available_width()).truncate();
    // A click into the search leaves the list open.
    let list = list.close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    let list = list.show_ui(ui, |ui| {
        let words = search::above(ui, &mut own.search, "textures", all.len());
        if !all.iter().any(|(_, name)| words.are_in(name)) {
            words.no_match(ui, "texture");
        }
        for (other, name) in all.iter().filter(|(_, name)| words.are_in(name)) {
            if ui.selectable_label(*other == source, *name).clicked() {
                own.source = Some(*other);
                own.search.clear();
                ui.close();
            }
        }
    });
    list.response.on_hover_text("The texture to show. The Scene panel lists textures by material");
}

/// Channels, level and texture coordinates.
fn controls(ui: &mut Ui, own: &mut TextureState, levels: u32) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        for ((name, doc), channels) in CHANNELS.into_iter().zip(0..) {
            ui.selectable_value(&mut own.channels, channels, name).on_hover_text(doc);
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let shown = own.level.map_or_else(|| "auto".to_owned(), |level| level.to_string());
        let list = egui::ComboBox::from_id_salt("level").selected_text(format!("level {shown}")).width(74.0);
        let list = list.show_ui(ui, |ui| {
            ui.selectable_value(&mut own.level, None, "auto");
            for level in 0..levels {
                ui.selectable_value(&mut own.level, Some(level), format!("level {level}"));
            }
        });
        list.response.on_hover_text("Mip level: each has half the width and height of the one before");
        ui.toggle_value(&mut own.shows_uv, "UV")
            .on_hover_text("Draw the texture coordinates of the meshes that use it, as lines");
        if ui.small_button("Fit").on_hover_text("Show the whole texture").clicked() {
            (own.scale, own.middle) = (None, [0.5; 2]);
        }
        if ui.small_button("1:1").on_hover_text("One texel per point").clicked() {
            own.scale = Some(1.0);
        }
    });
}

/// Shows the picture, zooms and pans, and asks the screen to draw it.
fn picture(
    ui: &mut Ui,
    own: &mut TextureState,
    source: TextureSource,
    (width, height): (u32, u32),
    area: Vec2,
    shown: Option<(egui::TextureId, Rect)>,
) -> (TextureView, (u32, u32)) {
    let (rect, response) = ui.allocate_exact_size(area, Sense::click_and_drag());
    let texels = vec2(width as f32, height as f32);
    let fit = (area.x / texels.x).min(area.y / texels.y);
    let mut scale = own.scale.unwrap_or(fit);
    // Texture coordinates of a point of the window.
    let corner_of = |middle: [f32; 2], scale: f32| {
        [middle[0] - 0.5 * area.x / (scale * texels.x), middle[1] - 0.5 * area.y / (scale * texels.y)]
    };
    let drag = response.drag_delta();
    if drag != Vec2::ZERO {
        own.scale = Some(scale);
        own.middle[0] -= drag.x / (scale * texels.x);
        own.middle[1] -= drag.y / (scale * texels.y);
    }
    let zoom = ui.input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y * 0.005).exp());
    if let Some(at) = response.hover_pos().filter(|_| zoom != 1.0) {
        let next = (scale * zoom).clamp(fit * 0.2, 64.0_f32.max(fit));
        let offset = at - rect.center();
        for (axis, (offset, texels)) in [(offset.x, texels.x), (offset.y, texels.y)].into_iter().enumerate() {
            own.middle[axis] += offset / texels * (scale.recip() - next.recip());
        }
        (scale, own.scale) = (next, Some(next));
    }
    if response.double_clicked() {
        (own.scale, own.middle) = (None, [0.5; 2]);
        scale = fit;
    }
    let (corner, size) = (corner_of(own.middle, scale), [area.x / (scale * texels.x), area.y / (scale * texels.y)]);
    let per_point = ui.ctx().pixels_per_point();
    let pixels = ((area.x * per_point).round().max(1.0) as u32, (area.y * per_point).round().max(1.0) as u32);
    let view = TextureView { corner, size, level: own.level, channels: own.channels, is_srgb: source.is_srgb() };
    match shown {
        Some((texture, part)) => {
            ui.painter().image(texture, rect, part, Color32::WHITE);
        }
        None => drop(ui.painter().rect_filled(rect, 0.0, EDGE)),
    }
    let border = Rect::from_min_size(
        rect.min + vec2(-corner[0] * scale * texels.x, -corner[1] * scale * texels.y),
        texels * scale,
    );
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_stroke(border, 0.0, egui::Stroke::new(1.0, Color32::from_gray(110)), egui::StrokeKind::Outside);
    if let Some(at) = response.hover_pos() {
        let uv = [
            corner[0] + (at.x - rect.min.x) / (scale * texels.x),
            corner[1] + (at.y - rect.min.y) / (scale * texels.y),
        ];
        let texel = [(uv[0] * texels.x).floor(), (uv[1] * texels.y).floor()];
        let text = format!("uv {:.4} {:.4}   texel {} {}   {:.0} %", uv[0], uv[1], texel[0], texel[1], 100.0 * scale);
        let at = pos2(rect.min.x + 6.0, rect.max.y - 6.0);
        let galley = ui.painter().layout_no_wrap(text, small_mono_font(), Color32::WHITE);
        let back = Rect::from_min_size(at - vec2(2.0, galley.size().y + 2.0), galley.size() + vec2(4.0, 4.0));
        painter.rect_filled(back, 3.0, Color32::from_black_alpha(190));
        painter.galley(back.min + vec2(2.0, 2.0), galley, Color32::WHITE);
        response.on_hover_cursor(egui::CursorIcon::Crosshair);
    }
    (view, pixels)
}

/// The meshes whose texture coordinates read a texture, each once.
fn meshes(scene: &Scene, source: TextureSource, uses: &[(usize, usize)]) -> Vec<UvMesh> {
    let model = scene.model();
    let mut meshes: Vec<UvMesh> = Vec::new();
    for instance in &model.instances {
        let material = scene.material_of(instance);
        let used = uses.iter().find(|(index, slot)| {
            *index == material && TextureSource::of(model, &model.materials[material], *slot) == source
        });
        let Some(used) = used.and_then(|(index, slot)| model.materials[*index].textures[*slot]) else { continue };
        if meshes.iter().all(|mesh| mesh.primitive != instance.primitive) {
            let (primitive, uv_set, uv_from_mesh) = (instance.primitive, used.uv_set, used.uv_from_mesh);
            meshes.push(UvMesh { primitive, uv_set, uv_from_mesh });
        }
    }
    meshes
}

/// Size, format, color space, sampler and uses of a texture.
fn about(model: &Model, source: TextureSource, uses: &[(usize, usize)], (width, height): (u32, u32)) -> String {
    if model.awaits_textures {
        return "It is being decoded. One pixel stands for it".to_owned();
    }
    let (form, levels) = (source.form(model), source.levels(model));
    let mib = source.bytes(model) as f64 / f64::from(1 << 20);
    let space = if source.is_srgb() { "sRGB" } else { "linear" };
    let packed = if matches!(source, TextureSource::Packed { .. }) { ", occlusion packed into red" } else { "" };
    let sampler = uses.first().and_then(|(material, slot)| {
        let used = model.materials[*material].textures[*slot]?;
        Some(model.textures[used.texture].sampler)
    });
    let sampler = sampler.map_or_else(String::new, |sampler| {
        let filter = |linear| if linear { "linear" } else { "nearest" };
        let mip = match sampler.mip {
            Mip::None => "no mip levels",
            Mip::Nearest => "nearest level",
            Mip::Linear => "linear between levels",
        };
        let wrap = |wrap| match wrap {
            Wrap::Repeat => "repeat",
            Wrap::Mirror => "mirror",
            Wrap::Clamp => "clamp",
        };
        let (mag, min) = (filter(sampler.mag_linear), filter(sampler.min_linear));
        format!("mag {mag}, min {min}, {mip}; u {}, v {}", wrap(sampler.wrap_u), wrap(sampler.wrap_v))
    });
    let users: Vec<String> = uses
        .iter()
        .map(|(material, slot)| format!("{} ({})", model.material_key(*material), slot_name(*slot)))
        .collect();
    format!(
        "{width} × {height}, {levels} levels, {form} {space}, {mib:.1} MiB{packed}\n{sampler}\n{}",
        users.join(", ")
    )
}
