//! The panel Timeline: the versions of the shaders, each with its picture, its times and what it changed.

pub(super) mod comparison;
mod times;

use std::sync::Arc;

use egui::{
    Label, Rect, RectAlign, Response, RichText, Sense, Stroke, StrokeKind, TextureHandle, Tooltip, Ui, Vec2, vec2,
};

use crate::app::command::compare::{COMPARE, CompareFields};
use crate::app::command::shaders::{VERSIONS, VersionsRequest};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::panels::panel_ui::{Group, PanelSpec, PanelUi};
use crate::app::state::State;
use crate::app::state::shaders::difference::{Kind, Line};
use crate::app::state::shaders::versions::{Thumbnail, Version, Versions};
use crate::app::state::workspace::PanelRequest;
use crate::app::widgets::elide::middle;
use crate::app::widgets::rows::elided;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ACCENT, EDGE, ERROR, GOOD, QUIET, TEXT, WARNING, small_font};
use comparison::{ENTRIES, monospace};

/// How the rest of the window finds the panel.
pub(super) static PANEL: PanelSpec =
    PanelSpec::new("Timeline", Group::Shaders, "versions history compare difference restore", || {
        Box::<TimelineState>::default()
    })
    .scrolls_itself();

/// Size of a thumbnail in points.
pub(in crate::app) const THUMBNAIL: Vec2 = vec2(128.0, 80.0);
/// How much smaller it is in a list.
const IN_LIST: f32 = 0.625;
/// Widest entry of a list, points.
const WIDEST: f32 = 320.0;
/// Opacity of the accent behind the chosen entry.
const FAINT: f32 = 0.1;
/// Most lines of a difference in the hover text.
const MOST_LINES: usize = 40;

/// State that the panel keeps between frames.
#[derive(Default)]
pub(in crate::app) struct TimelineState {
    /// The version that the user is asked about before it is written to the files.
    asked: Option<u64>,
    search: String,
    thumbnails: Thumbnails,
}

/// Height of a strip that shows anything of its cards, points.
const ROOM_FOR_CARDS: f32 = 48.0;

/// The thumbnails as textures.
#[derive(Default)]
struct Thumbnails(Vec<(Arc<Thumbnail>, TextureHandle)>);

impl Thumbnails {
    /// Loads those of new versions, and drops those of versions that are no longer kept.
    fn update(&mut self, egui: &egui::Context, versions: &Versions) {
        let all = || versions.iter().filter_map(|version| version.thumbnail.as_ref());
        self.0.retain(|(shown, _)| all().any(|thumbnail| Arc::ptr_eq(shown, thumbnail)));
        for thumbnail in all() {
            if self.of(thumbnail).is_none() {
                let image = egui::ColorImage::from_rgba_unmultiplied(thumbnail.size, &thumbnail.rgba8);
                let texture = egui.load_texture("version", image, egui::TextureOptions::LINEAR);
                self.0.push((thumbnail.clone(), texture));
            }
        }
    }

    fn of(&self, thumbnail: &Arc<Thumbnail>) -> Option<&TextureHandle> {
        self.0.iter().find(|(shown, _)| Arc::ptr_eq(shown, thumbnail)).map(|(_, texture)| texture)
    }
}

impl PanelUi for TimelineState {
    fn ui(&mut self, ui: &mut Ui, context: &Context<'_>, commands: &mut Commands) {
        commands.sight.timeline = true;
        show(ui, context.state, self, &mut commands.list);
    }

    fn on_request(&mut self, request: &PanelRequest) {
        if let PanelRequest::AskVersion(number) = request {
            self.asked = Some(*number);
        }
    }
}

/// Shows the panel.
fn show(ui: &mut Ui, state: &State, own: &mut TimelineState, commands: &mut Vec<Command>) {
    let area = ui.available_size();
    // A wide tile runs from left to right, with the newest version first as in a tall one.
    let is_strip = area.x > 3.0 * area.y && area.y > 40.0;
    let count = state.versions.iter().count();
    // A strip has no height to spare, so the search stands beside the buttons there.
    let beside = (is_strip && count > search::FEW).then_some(&mut own.search);
    comparison::show(ui, &state.compare, beside, commands);
    times::show(ui, state);
    let words = match is_strip {
        true if count <= search::FEW => Words::default(),
        true => Words::new(&own.search),
        false => search::above(ui, &mut own.search, ENTRIES, count),
    };
    if let Some(number) = own.asked {
        ask(ui, state, number, &mut own.asked, commands);
        // The scroll bar of a list without room would lie over the answers.
        if is_strip && ui.available_height() < ROOM_FOR_CARDS {
            return;
        }
    }
    own.thumbnails.update(ui.ctx(), &state.versions);
    let scroll = if is_strip { egui::ScrollArea::horizontal() } else { egui::ScrollArea::vertical() };
    scroll.auto_shrink(false).show(ui, |ui| {
        let layout = match is_strip {
            true => egui::Layout::left_to_right(egui::Align::Min),
            false => egui::Layout::top_down(egui::Align::Min),
        };
        ui.with_layout(layout, |ui| {
            let mut found = state.versions.iter().rev().filter(|version| is_found(state, version, &words)).peekable();
            if found.peek().is_none() && !words.is_empty() {
                words.no_match(ui, "version");
            }
            for version in found {
                let thumbnail = version.thumbnail.as_ref().and_then(|thumbnail| own.thumbnails.of(thumbnail));
                let entry = Entry { state, version, thumbnail };
                let response = if is_strip { entry.card(ui) } else { entry.row(ui) };
                entry.respond(&response, is_strip, &mut own.asked, commands);
            }
            if count == 0 {
                ui.label(RichText::new("Your edits appear here once they are shown").color(QUIET));
            }
        });
    });
}

/// Whether a version has the words of the search in its number, files and time, or in a line that it changed.
fn is_found(state: &State, version: &Version, words: &Words) -> bool {
    let title = || format!("{} {} {}", version.number, version.title(), version.since.format("%H:%M:%S"));
    let is_change = |line: &&Line| matches!(line.kind, Kind::Added | Kind::Removed);
    let mut lines = state.versions.difference(version).iter().filter(is_change);
    words.is_empty() || words.are_in(&title()) || lines.any(|line| words.are_in(&line.text))
}

/// A version in the panel.
struct Entry<'a> {
    state: &'a State,
    version: &'a Version,
    thumbnail: Option<&'a TextureHandle>,
}

impl Entry<'_> {
    fn is_chosen(&self) -> bool {
        self.state.compare.version() == Some(self.version.number)
    }

    fn can_show(&self) -> bool {
        self.state.can_show(self.version)
    }

    /// Whether a click on the version on screen ends a comparison, or shows the newest version in place of an older one.
    fn ends_something(&self) -> bool {
        self.state.shows_version(self.version) && (self.state.compare.is_on() || self.state.edits.restored.is_some())
    }

    /// Its number, and whether it is on screen.
    fn number(&self) -> String {
        let now = if self.state.shows_version(self.version) { " (now)" } else { "" };
        format!("{}{now}", self.version.number)
    }

    /// Number and files.
    fn title(&self) -> String {
        format!("{}  {}", self.number(), self.version.title())
    }

    /// The times of the reload in words.
    fn times(&self) -> String {
        let Version { reload, since, device_ms, .. } = self.version;
        let gpu = device_ms.map_or_else(String::new, |ms| format!("\nThe first frame took {ms:.1} ms on the GPU"));
        format!(
            "{}: {:.0} ms to compile, {:.0} ms for the pipelines, {:.0} ms for the first frame{gpu}",
            since.format("%H:%M:%S"),
            reload.compile_ms,
            reload.pipeline_ms,
            reload.first_frame_ms
        )
    }

    /// In a list: the picture on the left, the texts on the right.
    fn row(&self, ui: &mut Ui) -> Response {
        let size = IN_LIST * THUMBNAIL;
        let width = ui.available_width().min(WIDEST);
        let (rect, response) = ui.allocate_exact_size(vec2(width, size.y + 6.0), Sense::click());
        let picture = Rect::from_min_size(rect.shrink(3.0).min, size);
        self.paint(ui, &response, picture);
        self.texts(ui, rect.shrink(3.0).with_min_x(picture.max.x + 8.0));
        response
    }

    /// In a strip: the texts below the picture.
    fn card(&self, ui: &mut Ui) -> Response {
        let texts = 50.0;
        let height = (ui.available_height() - texts - 6.0).clamp(20.0, THUMBNAIL.y);
        let size = THUMBNAIL * (height / THUMBNAIL.y);
        let width = size.x.max(180.0);
        let (rect, response) = ui.allocate_exact_size(vec2(width, height + texts) + vec2(6.0, 6.0), Sense::click());
        let inner = rect.shrink(3.0);
        self.paint(ui, &response, Rect::from_min_size(inner.min, size));
        self.texts(ui, inner.with_min_y(inner.min.y + height + 2.0));
        response
    }

    /// The background, and the picture in small.
    fn paint(&self, ui: &Ui, response: &Response, picture: Rect) {
        if response.hovered() && (self.can_show() || self.ends_something()) {
            ui.painter().rect_filled(response.rect, 3.0, ui.visuals().widgets.hovered.weak_bg_fill);
        }
        if self.is_chosen() {
            ui.painter().rect_filled(response.rect, 3.0, ACCENT.color().gamma_multiply(FAINT));
            ui.painter().rect_stroke(response.rect, 3.0, Stroke::new(1.5, ACCENT), StrokeKind::Inside);
        }
        match self.thumbnail {
            Some(thumbnail) => egui::Image::new(thumbnail).corner_radius(2).paint_at(ui, picture),
            None => _ = ui.painter().rect_filled(picture, 2.0, EDGE),
        }
    }

    /// Number and time, the files, and how long the reload and a frame took.
    fn texts(&self, ui: &mut Ui, rect: Rect) {
        let Version { reload, since, device_ms, .. } = self.version;
        // A child of its own, which does not move the next entry.
        let layout = egui::Layout::top_down(egui::Align::Min);
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout));
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        ui.spacing_mut().item_spacing.y = 2.0;
        let number = RichText::new(self.number()).strong();
        ui.horizontal(|ui| {
            ui.add(elided(number).selectable(false));
            ui.add(elided(monospace(since.format("%H:%M:%S").to_string()).color(QUIET)).selectable(false));
        });
        let files = middle(ui.painter(), &self.version.title(), &small_font(), ui.available_width());
        ui.add(elided(RichText::new(files).small()).selectable(false));
        let whole_ms = reload.compile_ms + reload.pipeline_ms + reload.first_frame_ms;
        let gpu = device_ms.map_or_else(String::new, |ms| format!(", GPU {ms:.*}", usize::from(ms < 10.0)));
        ui.add(elided(RichText::new(format!("{whole_ms:.0} ms{gpu}")).small().color(QUIET)).selectable(false));
    }

    /// A click compares the picture with the version, or ends what [`Self::ends_something`]; a double click shows it alone; the menu copies what it changed, or writes it to the
    /// files.
    fn respond(&self, response: &Response, is_strip: bool, asked: &mut Option<u64>, commands: &mut Vec<Command>) {
        let Self { state, version, .. } = self;
        let (is_chosen, can_show) = (self.is_chosen(), self.can_show());
        if response.double_clicked() && can_show {
            commands
                .extend([COMPARE.with(CompareFields::nothing()), VERSIONS.with(VersionsRequest::Show(version.number))]);
        } else if response.clicked() && can_show {
            let with = if is_chosen { CompareFields::nothing() } else { CompareFields::version(version.number) };
            commands.push(COMPARE.with(with));
        } else if response.clicked() && state.compare.is_on() {
            commands.push(COMPARE.with(CompareFields::nothing()));
        } else if response.clicked() && self.ends_something() {
            commands.push(VERSIONS.with(VersionsRequest::ShowNewest));
        }
        response.context_menu(|ui| {
            let lines = state.versions.difference(version);
            if ui.add_enabled(!lines.is_empty(), egui::Button::new("Copy the difference")).clicked() {
                let text: Vec<&str> = lines.iter().map(|line| line.text.as_str()).collect();
                ui.ctx().copy_text(text.join("\n"));
                ui.close();
            }
            let show = egui::Button::new("Show alone");
            let hint = "Show this version in the whole window, without a change of your files. Then click on another one to compare the two";
            if ui.add_enabled(can_show, show).on_hover_text(hint).clicked() {
                commands.push(VERSIONS.with(VersionsRequest::Show(version.number)));
                ui.close();
            }
            let can_write = !state.files_of_version(version.number).is_empty();
            if ui.add_enabled(can_write, egui::Button::new("Write to the files…")).clicked() {
                *asked = Some(version.number);
                ui.close();
            }
        });
        let hint = match (can_show, state.shows_version(version)) {
            (true, _) if is_chosen => "Click to stop comparing, double click to show it alone",
            (true, _) => "Click to compare the picture with this version, double click to show it alone",
            (false, true) if state.compare.is_on() => "The picture on screen. Click to stop comparing",
            (false, true) if state.edits.restored.is_some() => {
                "The picture on screen. Click to go back to the newest version"
            }
            (false, true) => "The picture on screen",
            (false, false) => "A loop did not end in this version, so it is not shown again",
        };
        let about = [self.title(), self.times()];
        // Beside the list, so that it covers no other version.
        let sides = match is_strip {
            true => [RectAlign::TOP_START, RectAlign::TOP_END, RectAlign::BOTTOM_START],
            false => [RectAlign::RIGHT_START, RectAlign::LEFT_START, RectAlign::LEFT_END],
        };
        let mut tooltip = Tooltip::for_enabled(response);
        tooltip.popup = tooltip.popup.align(sides[0]).align_alternatives(&sides);
        tooltip.show(|ui| hover(ui, &about, hint, state.versions.difference(version)));
    }
}

/// The hover text: title and times of a version, what a click does, and the difference from the version before.
fn hover(ui: &mut Ui, [title, times]: &[String; 2], hint: &str, lines: &[Line]) {
    ui.set_max_width(560.0);
    ui.label(RichText::new(title).strong());
    ui.label(times);
    ui.label(RichText::new(hint).small().color(QUIET));
    for Line { kind, text } in lines.iter().take(MOST_LINES) {
        let color = match kind {
            Kind::Place => ACCENT,
            Kind::Removed => ERROR,
            Kind::Added => GOOD,
            Kind::Same => TEXT,
        };
        ui.add(Label::new(monospace(text).color(color)).truncate());
    }
    if lines.len() > MOST_LINES {
        ui.label(RichText::new(format!("and {} more lines", lines.len() - MOST_LINES)).small().color(QUIET));
    }
}

/// Asks whether to write a version over the files of the tree.
fn ask(ui: &mut Ui, state: &State, number: u64, asked: &mut Option<u64>, commands: &mut Vec<Command>) {
    let files = state.files_of_version(number);
    let names: Vec<&str> = files.iter().filter_map(|(path, _)| path.file_name()?.to_str()).collect();
    let question = format!("Overwrite the files on disk with version {number} of {}?", names.join(", "));
    ui.add(Label::new(RichText::new(question).color(WARNING)).wrap());
    ui.horizontal(|ui| {
        if ui.add_enabled(!files.is_empty(), egui::Button::new("Write")).clicked() {
            commands.push(VERSIONS.with(VersionsRequest::Write(number)));
            *asked = None;
        }
        if ui.button("Cancel").clicked() {
            *asked = None;
        }
    });
}
