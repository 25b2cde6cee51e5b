//! The texel of each texture of the material at the pixel. A click shows the texture.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, Rect, Response, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use super::values::{HEIGHT, SWATCH};
use crate::app::command::layout::OPEN_PANEL;
use crate::app::command::scene::SELECT;
use crate::app::command::spec::Command;
use crate::app::state::arrangement::Panel;
use crate::app::state::selection::Selected;
use crate::app::widgets::search::Words;
use crate::app::widgets::spoken;
use crate::app::widgets::theme::{ACCENT, EDGE, QUIET, small_font, small_mono_font};
use crate::render::Texel;

/// Shows a row for each texture that has the words of the search.
pub(super) fn show(ui: &mut Ui, texels: &[Texel], words: &Words, commands: &mut Vec<Command>) {
    let is_found =
        |texel: &&Texel| words.are_in(&format!("texture texel {} {}", texel.place.slot_name(), texel.place.name));
    let found: Vec<&Texel> = texels.iter().filter(is_found).collect();
    if found.is_empty() {
        return;
    }
    ui.add_space(6.0);
    ui.label(RichText::new("Textures").small().color(QUIET));
    for texel in found {
        if row(ui, texel).clicked() {
            commands.push(SELECT.with(Selected::Texture(texel.place.source)));
            commands.push(OPEN_PANEL.with(Panel::TEXTURE));
        }
    }
}

/// The stored value as text.
fn stored(texel: &Texel) -> String {
    texel.stored.map(|byte| format!("{byte:>3}")).join(" ")
}

fn row(ui: &mut Ui, texel: &Texel) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click());
    let (slot, stored) = (texel.place.slot_name(), stored(texel));
    let label = format!("{slot} texel {stored}");
    spoken::button(&response, &label);
    if ui.is_rect_visible(rect) {
        let painter = ui.painter();
        if response.hovered() {
            painter.rect_filled(rect, 3.0, EDGE);
        }
        let middle = rect.center().y;
        let swatch = Rect::from_center_size(pos2(rect.min.x + 0.5 * SWATCH + 1.0, middle), vec2(SWATCH, SWATCH));
        let [r, g, b] = texel.color();
        painter.rect_filled(swatch, 2.0, Color32::from_rgb(r, g, b));
        painter.rect_stroke(swatch, 2.0, Stroke::new(1.0, Color32::from_gray(70)), StrokeKind::Inside);
        let color = ui.visuals().text_color();
        let numbers = painter.layout_no_wrap(stored, small_mono_font(), color);
        let left_of_numbers = rect.max.x - 4.0 - numbers.size().x;
        painter.galley(pos2(left_of_numbers, middle - 0.5 * numbers.size().y), numbers, color);
        let left = rect.min.x + SWATCH + 7.0;
        let mut job = LayoutJob::simple_singleline(slot, small_font(), color);
        job.wrap = TextWrapping::truncate_at_width((left_of_numbers - 6.0 - left).max(10.0));
        let name = painter.layout_job(job);
        painter.galley(pos2(left, middle - 0.5 * name.size().y), name, color);
    }
    response.on_hover_ui(|ui| about(ui, texel))
}

/// Hover text that describes a texel.
fn about(ui: &mut Ui, texel: &Texel) {
    ui.set_max_width(400.0);
    let place = &texel.place;
    let [[x, y], [width, height], [u, v], [mesh_u, mesh_v]] = [
        place.texel.map(|number| number.to_string()),
        place.size.map(|number| number.to_string()),
        place.uv.map(|number| format!("{number:.4}")),
        place.mesh_uv.map(|number| format!("{number:.4}")),
    ];
    ui.label(RichText::new(format!("{} · {}", place.slot_name(), place.name)).strong());
    let linear = texel.linear.map(|number| format!("{number:.4}")).join(" ");
    let space = if place.source.is_srgb() { "sRGB" } else { "linear" };
    let lines = format!(
        "texel   {x} {y} of {width} × {height}, {}\nuv      {u} {v} after transform and wrap\nmesh uv {mesh_u} {mesh_v}, TEXCOORD_{}\n\
         stored  {} {space}\nlinear  {linear}",
        place.form,
        place.uv_set,
        stored(texel)
    );
    ui.label(RichText::new(lines).monospace());
    ui.label("The nearest texel of level 0, in the encoding of the image. The shader filters texels and mip levels.");
    ui.label(RichText::new("Click to show the texture").small().color(ACCENT));
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::super::not_finite;
    use std::path::PathBuf;

    use super::*;
    use crate::app::command::file::OPEN_EDITOR;
    use crate::app::editor::Place;
    use crate::app::state::inspection::NotFiniteSearch;
    use crate::render::TexelPlace;
    use crate::scene::{TexelForm, TextureSource};
    use crate::shader::not_finite::NotFinite;
    use crate::shader::{FirstNotFinite, Site};

    #[test]
    fn a_row_opens_its_texture_and_a_line_the_editor() {
        let source = TextureSource::Image { image: 0, srgb: true };
        let place = TexelPlace {
            slot: 0,
            source,
            form: TexelForm::Rgba8,
            name: "checker".into(),
            size: [2, 2],
            uv_set: 0,
            mesh_uv: [0.75, 0.25],
            uv: [0.75, 0.25],
            texel: [1, 0],
        };
        let texels = vec![Texel::of_bytes(place, [255, 0, 128, 255])];
        let first = Site {
            file: "/home/me/shaders/brdf/ndf.glsl".into(),
            line: 20,
            column: 5,
            code: "return a2 / 0.0;".into(),
        };
        let found = FirstNotFinite { first, value: "Inf", components: vec!["Inf"], nan: None };
        let found = Some(NotFinite { mode: "final".into(), found: Ok(Some(found)) });
        let search = NotFiniteSearch { number: 1, mode: "final".into(), found };
        let show = move |ui: &mut Ui, commands: &mut Vec<Command>| {
            not_finite::show(ui, &search, true, commands);
            super::show(ui, &texels, &Words::default(), commands);
        };
        let mut harness = Harness::new_ui_state(show, Vec::new());
        harness.run();
        harness.get_by_label("base color texel 255   0 128 255").click();
        harness.run();
        let opened = [SELECT.with(Selected::Texture(source)), OPEN_PANEL.with(Panel::TEXTURE)];
        assert_eq!(*harness.state(), opened);
        harness.get_by_label("Inf  brdf/ndf.glsl:20  return a2 / 0.0;").click();
        harness.run();
        let file = PathBuf::from("/home/me/shaders/brdf/ndf.glsl");
        let place = Place { file, line: Some(20), column: Some(5) };
        assert_eq!(harness.state().last(), Some(&OPEN_EDITOR.with(place)));
    }
}
