//! Rows of the panel Output that say how values become colors: range, channels, colormap, dither, and the edges of triangles.

use clap::ValueEnum;
use egui::{DragValue, Ui};

use crate::app::widgets::rows::{Value, check, choice_name, choose, setting};
use crate::app::widgets::spoken::named;
use crate::settings::{Channels, Colormap, Settings, ViewRange, ViewSettings};

impl Value for ViewRange {
    fn text(&self) -> String {
        self.to_string()
    }
}

impl Value for Channels {
    fn text(&self) -> String {
        choice_name(self)
    }
}

impl Value for Colormap {
    fn text(&self) -> String {
        choice_name(self)
    }
}

/// Shows the rows.
pub(in crate::app::panels) fn show(ui: &mut Ui, view: &mut ViewSettings) {
    let default = Settings::of_window().view;
    range(ui, view, default.range);
    let doc = "Channels that the picture shows. A single channel is shown in gray; a is coverage";
    setting(ui, ("Channels", doc, "view.channels"), &mut view.channels, default.channels, |ui, channels| {
        list(ui, "channels", channels)
    });
    let doc = "Colors that stand for a number, in modes with one component and for a single channel. None: the colors of the \
        mode. Viridis and magma have even steps of lightness (van der Walt and Smith 2015), turbo has many hues (Mikhailov 2019), \
        and coolwarm diverges from a neutral middle (Moreland 2009)";
    setting(ui, ("Colormap", doc, "view.colormap"), &mut view.colormap, default.colormap, |ui, colormap| {
        list(ui, "colormap", colormap)
    });
    let doc = "Draw the edges of the triangles over the picture, in every mode";
    setting(ui, ("Wireframe", doc, "view.wireframe"), &mut view.wireframe, default.wireframe, check);
    let doc = "Noise of half an 8-bit step, which hides banding in smooth light. Data and EXR files never have it";
    setting(ui, ("Dither", doc, "view.dither"), &mut view.dither, default.dither, check);
}

/// A list of names.
fn list<T: ValueEnum + PartialEq + Copy>(ui: &mut Ui, id: &str, value: &mut T) -> egui::Response {
    choose(ui, id, choice_name(value), |ui| {
        for choice in T::value_variants() {
            ui.selectable_value(value, *choice, choice_name(choice));
        }
    })
}

/// The range, with both ends where the user sets them.
fn range(ui: &mut Ui, view: &mut ViewSettings, default: ViewRange) {
    let doc = "The values shown as black and white. auto: fit to the picture, in modes whose values have a unit or leave 0..1, and for a \
        watched expression; mode: as the mode stores them; fit: fit to the picture in every mode, in place of exposure and tone map; \
        set: two numbers";
    setting(ui, ("Range", doc, "view.range"), &mut view.range, default, |ui, range| {
        let name = match &*range {
            ViewRange::Fixed(..) => "set".to_owned(),
            range => range.to_string(),
        };
        choose(ui, "range", name, |ui| {
            for choice in [ViewRange::Auto, ViewRange::Mode, ViewRange::Fit] {
                ui.selectable_value(range, choice, choice.to_string());
            }
            let is_set = matches!(*range, ViewRange::Fixed(..));
            if ui.selectable_label(is_set, "set").clicked() && !is_set {
                *range = ViewRange::Fixed(0.0, 1.0);
            }
        })
    });
    let ViewRange::Fixed(mut low, mut high) = view.range else { return };
    ui.horizontal(|ui| {
        let speed = f64::from(high - low) / 200.0;
        let first = ui.add(DragValue::new(&mut low).speed(speed).prefix("from ").max_decimals(4));
        let last = ui.add(DragValue::new(&mut high).speed(speed).prefix("to ").max_decimals(4));
        named(first, "Black").on_hover_text("The value that is black");
        named(last, "White").on_hover_text("The value that is white");
    });
    if low < high {
        view.range = ViewRange::Fixed(low, high);
    }
}
