//! The gallery of what can be opened: built-in models and environments with pictures, and files that were open.

use std::path::{Path, PathBuf};

use egui::{Align2, Key, Rect, RichText, ScrollArea, Sense, Stroke, StrokeKind, TextureHandle, Ui, Window};
use egui::{TextureOptions, pos2, vec2};

use crate::app::command::file::{CHOOSE, OPEN, Open};
use crate::app::command::spec::Command;
use crate::app::state::State;
use crate::app::state::dialog::Dialog;
use crate::app::state::recent::Kind;
use crate::app::widgets::search::{self, Words};
use crate::app::widgets::theme::{ACCENT, EDGE, QUIET, body_font};
use crate::scene::{BUILT_IN, BuiltInPictures, environment};

/// Size of a picture, in points, and of the name below.
const PICTURE: egui::Vec2 = vec2(128.0, 96.0);
const NAME: f32 = 18.0;
/// Size of the window, in points.
const WINDOW: egui::Vec2 = vec2(570.0, 520.0);

/// State of the gallery between frames.
#[derive(Default)]
pub(in crate::app) struct OpenGallery {
    pub(in crate::app) is_open: bool,
    /// Whether a thread is to decode the pictures.
    pub(in crate::app) wants_pictures: bool,
    pictures: Pictures,
    search: String,
}

/// The pictures, which are decoded once the gallery is open.
#[derive(Default)]
enum Pictures {
    #[default]
    None,
    Asked,
    Decoded(Box<BuiltInPictures>),
    Uploaded(TextureHandle, Vec<String>),
}

impl OpenGallery {
    /// Takes the decoded pictures.
    pub(in crate::app) fn take(&mut self, pictures: Box<BuiltInPictures>) {
        self.pictures = Pictures::Decoded(pictures);
    }

    /// The texture with the picture of this name, and its place in it.
    fn picture(&self, name: &str) -> Option<(&TextureHandle, Rect)> {
        let Pictures::Uploaded(texture, names) = &self.pictures else { return None };
        let at = names.iter().position(|known| known == name)? as f32;
        let width = 1.0 / names.len() as f32;
        Some((texture, Rect::from_min_max(pos2(at * width, 0.0), pos2((at + 1.0) * width, 1.0))))
    }
}

/// Shows the gallery while it is open.
pub(super) fn show(egui: &egui::Context, state: &State, own: &mut OpenGallery, commands: &mut Vec<Command>) {
    if own.is_open && egui.input(|input| input.key_pressed(Key::Escape)) {
        own.is_open = false;
    }
    if own.is_open {
        provide(egui, own);
        let mut stays = true;
        let room = egui.content_rect();
        let size = WINDOW.min(room.size() - vec2(24.0, 94.0));
        let window = Window::new(RichText::new("Open").strong()).open(&mut stays).collapsible(false).resizable(false);
        let window = window.order(egui::Order::Foreground).pivot(Align2::CENTER_CENTER).default_pos(room.center());
        let before = commands.len();
        window.show(egui, |ui| {
            ui.set_width(size.x);
            contents(ui, state, own, size.y, commands);
        });
        own.is_open = stays && commands.len() == before;
    } else {
        own.search.clear();
    }
}

/// Lets a thread decode the pictures, and uploads them.
fn provide(egui: &egui::Context, own: &mut OpenGallery) {
    own.pictures = match std::mem::take(&mut own.pictures) {
        Pictures::None => {
            own.wants_pictures = true;
            Pictures::Asked
        }
        Pictures::Decoded(pictures) => {
            let BuiltInPictures { image, names } = *pictures;
            let size = [image.width() as usize, image.height() as usize];
            let image = egui::ColorImage::from_rgba_premultiplied(size, image.as_raw());
            Pictures::Uploaded(egui.load_texture("built-in pictures", image, TextureOptions::LINEAR), names)
        }
        other => other,
    };
}

fn contents(ui: &mut Ui, state: &State, own: &mut OpenGallery, height: f32, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        if ui.button("File…").on_hover_text("A model, environment, measured BRDF, look or shader (Ctrl+O)").clicked()
        {
            commands.push(CHOOSE.with(Dialog::File));
        }
        if ui.button("Shader tree…").on_hover_text("A folder written by `specula new`").clicked() {
            commands.push(CHOOSE.with(Dialog::Tree));
        }
        ui.label(RichText::new("or drop a file on the window").small().color(QUIET));
    });
    search::field(ui, &mut own.search, "models and environments", 0.0);
    let words = Words::new(&own.search);
    let own = &*own;
    let mut is_empty = true;
    // The height does not follow the search, so that the window stays in place.
    ScrollArea::vertical().max_height(height).auto_shrink(false).show(ui, |ui| {
        let model = state.session.model().map(|model| model.name.clone()).unwrap_or_default();
        let models = BUILT_IN.map(|name| (name, name.to_owned(), name == &*model, format!("specula {name}")));
        let (tiles, files) = (found(models, &words), recent(state, Kind::Model, &words));
        if !tiles.is_empty() || !files.is_empty() {
            is_empty = false;
            heading(ui, "Models");
            if let Some(name) = grid(ui, own, &tiles) {
                commands.push(OPEN.with(Open::Model(name.into())));
            }
            show_recent(ui, &files, |path| commands.push(OPEN.with(Open::Model(path))));
        }
        let now = state.session.settings.environment.name.clone();
        let environments = environment::BUILT_IN
            .map(|name| (name, format!("environment-{name}"), name == now, format!("specula --env {name}")));
        let (tiles, files) = (found(environments, &words), recent(state, Kind::Environment, &words));
        if !tiles.is_empty() || !files.is_empty() {
            is_empty = false;
            heading(ui, "Environments");
            if let Some(name) = grid(ui, own, &tiles) {
                commands.push(OPEN.with(Open::Environment(PathBuf::from(name))));
            }
            show_recent(ui, &files, |path| commands.push(OPEN.with(Open::Environment(path))));
        }
        if is_empty {
            words.no_match(ui, "model or environment");
        }
    });
}

fn heading(ui: &mut Ui, title: &str) {
    ui.add_space(6.0);
    ui.label(RichText::new(title).small().color(QUIET));
}

/// A picture with its name: the name, the name of the picture, whether it is on screen, and how the command line opens it.
type Tile<'a> = (&'a str, String, bool, String);

/// The tiles that have the words of the search in their names.
fn found<'a>(tiles: impl IntoIterator<Item = Tile<'a>>, words: &Words) -> Vec<Tile<'a>> {
    tiles.into_iter().filter(|(name, ..)| words.are_in(name)).collect()
}

/// Shows pictures with their names. Returns the name of the clicked one.
fn grid<'a>(ui: &mut Ui, own: &OpenGallery, tiles: &[Tile<'a>]) -> Option<&'a str> {
    let mut clicked = None;
    ui.spacing_mut().item_spacing = vec2(8.0, 6.0);
    let columns = ((ui.available_width() + 8.0) / (PICTURE.x + 8.0)).floor().max(1.0) as usize;
    for row in tiles.chunks(columns) {
        ui.horizontal(|ui| {
            for (name, picture, is_shown, option) in row {
                let (rect, response) = ui.allocate_exact_size(PICTURE + vec2(0.0, NAME), Sense::click());
                let area = Rect::from_min_size(rect.min, PICTURE);
                ui.painter().rect_filled(area, 4.0, EDGE);
                if let Some((texture, place)) = own.picture(picture) {
                    egui::Image::new((texture.id(), PICTURE)).uv(place).corner_radius(4.0).paint_at(ui, area);
                }
                let is_marked = *is_shown || response.hovered();
                if is_marked {
                    let stroke = Stroke::new(1.5, if *is_shown { ACCENT } else { QUIET });
                    ui.painter().rect_stroke(area, 4.0, stroke, StrokeKind::Inside);
                }
                let color = if *is_shown { ACCENT.color() } else { ui.visuals().text_color() };
                let at = pos2(area.left() + 2.0, area.bottom() + NAME / 2.0);
                ui.painter().text(at, Align2::LEFT_CENTER, name, body_font(), color);
                crate::app::widgets::spoken::button(&response, name);
                if response.on_hover_text(option).clicked() {
                    clicked = Some(*name);
                }
            }
        });
    }
    clicked
}

/// The files of a kind that were open and have the words of the search in their paths.
fn recent(state: &State, kind: Kind, words: &Words) -> Vec<PathBuf> {
    let is_built_in = |path: &Path| path.components().count() == 1 && !path.exists();
    let is_found = |path: &&PathBuf| !is_built_in(path) && words.are_in(&path.to_string_lossy());
    state.recent.of(kind).iter().filter(is_found).cloned().collect()
}

/// Shows files by their names, and opens the clicked one.
fn show_recent(ui: &mut Ui, files: &[PathBuf], mut open: impl FnMut(PathBuf)) {
    ui.horizontal_wrapped(|ui| {
        for path in files {
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            if ui.button(RichText::new(name).small()).on_hover_text(path.display().to_string()).clicked() {
                open(path.clone());
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::PICTURE_SIZE;

    #[test]
    fn a_search_finds_tiles_by_name() {
        let tiles = || ["shader-ball", "teapot"].map(|name| (name, name.to_owned(), false, String::new()));
        let names = |search: &str| found(tiles(), &Words::new(search)).iter().map(|tile| tile.0).collect::<Vec<_>>();
        assert_eq!(names("BALL shader"), ["shader-ball"]);
        assert_eq!((names("").len(), names("cup").len()), (2, 0));
    }

    #[test]
    fn each_picture_has_its_place_in_the_texture() {
        let egui = egui::Context::default();
        let image = egui::ColorImage::filled([PICTURE_SIZE.0 as usize * 4, 1], egui::Color32::RED);
        let texture = egui.load_texture("test", image, TextureOptions::LINEAR);
        let names = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        let gallery =
            OpenGallery { is_open: true, pictures: Pictures::Uploaded(texture, names), ..OpenGallery::default() };
        let place = |name: &str| gallery.picture(name).map(|(_, place)| (place.left(), place.right()));
        assert_eq!((place("a"), place("c"), place("e")), (Some((0.0, 0.25)), Some((0.5, 0.75)), None));
    }
}
