//! The whole interface over a state, without a device: bars, tiles, cards over the picture, the list of keys and the palette.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Key, Rect, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, Node};

use super::*;
use crate::app::gallery::Thumbnails;
use crate::app::readings::Readings;
use crate::app::state::State;
use crate::render::BakeReport;
use crate::scene::{self, built_in};
use crate::settings::Settings;
use crate::shader::{Diagnostic, ShaderSet, Source};

/// A window, and what it has been asked for.
struct Window {
    state: State,
    panels: Panels,
    baking: Option<(f32, String)>,
    baked: BakeReport,
    picture: Rect,
    asked: Vec<Command>,
}

/// A window of 1000 x 700 points with a model and shaders.
fn window() -> Harness<'static, Window> {
    let mut state = State::new(Settings::of_window(), Source::embedded());
    state.session.set_model(&Arc::new(built_in("shader-ball").unwrap().unwrap()));
    state.session.shaders = Some(Arc::new(ShaderSet { generation: 1, ..ShaderSet::default() }));
    state.shader.compiling = false;
    let window = Window {
        state,
        panels: Panels::of_layout(Layout::of_preset(Preset::Debug)),
        baking: None,
        baked: BakeReport::default(),
        picture: Rect::NOTHING,
        asked: Vec::new(),
    };
    let mut has_theme = false;
    let show = move |ui: &mut Ui, window: &mut Window| {
        if !std::mem::replace(&mut has_theme, true) {
            theme::apply(ui.ctx());
        }
        let Window { state, panels, baking, baked, .. } = window;
        let readings = Readings {
            baking: baking.as_ref(),
            baked,
            memory: None,
            thumbnails: &Thumbnails::default(),
            texture: None,
            pipelines: 0,
            value: None,
            title: None,
            legend: None,
        };
        let mut commands = Commands::new(&state.session.settings);
        window.picture = super::show(ui, &Context::new(state, readings), panels, &mut commands).rect;
        window.asked.extend(commands.finish(&state.session.settings).0);
    };
    let mut harness = Harness::builder().with_size(vec2(1000.0, 700.0)).build_ui_state(show, window);
    harness.run_steps(4);
    harness
}

/// Where each text is, as a screen reader finds it.
fn texts(harness: &Harness<'_, Window>) -> BTreeMap<String, Rect> {
    let text = |node: Node<'_>| {
        let accessible = node.accesskit_node();
        let text = accessible.label().or_else(|| accessible.value())?;
        Some((text, node.rect()))
    };
    harness.root().children_recursive().filter_map(text).collect()
}

/// The texts of `before` that are higher or lower, or gone.
fn moved(before: &BTreeMap<String, Rect>, after: &BTreeMap<String, Rect>) -> Vec<String> {
    let is_moved =
        |(text, rect): &(&String, &Rect)| after.get(*text).is_none_or(|after| after.y_range() != rect.y_range());
    before.iter().filter(is_moved).map(|(text, _)| text.clone()).collect()
}

/// The names of the commands that were asked for since the last call.
fn asked(harness: &mut Harness<'_, Window>) -> Vec<&'static str> {
    harness.state_mut().asked.drain(..).map(|command| command.about.id).collect()
}

#[test]
fn an_error_moves_nothing_and_goes_with_its_repair() {
    let mut harness = window();
    let (before, picture) = (texts(&harness), harness.state().picture);
    assert!(before.contains_key("watching"), "{before:?}");
    let error = |message: &str| Diagnostic::error("brdf/ndf.glsl", message);
    for errors in [vec![error("no alfa")], vec![error("no alfa"), error("no beta")]] {
        let count = if errors.len() == 1 { "1 error" } else { "2 errors" };
        harness.state_mut().state.session.diagnostics = errors;
        harness.run_steps(4);
        let after = texts(&harness);
        assert!(after.contains_key(count), "no {count} in {after:?}");
        let card = after.get("no alfa").unwrap_or_else(|| panic!("no message in {after:?}"));
        assert!(picture.contains_rect(*card), "the message at {card:?} is not over the picture {picture:?}");
        // The panel Shaders counts the problems in the names of its pages.
        assert_eq!(moved(&before, &after), ["Problems", "Version 1", "watching"]);
        assert_eq!(harness.state().picture, picture);
    }
    harness.state_mut().state.session.diagnostics.clear();
    harness.run_steps(4);
    assert_eq!(moved(&before, &texts(&harness)), [""; 0]);
    assert!(asked(&mut harness).is_empty());
}

#[test]
fn a_bake_and_its_end_move_nothing() {
    let mut harness = window();
    harness.state_mut().panels.layout.open(Panel("Environment"));
    harness.state_mut().baking = Some((0.4, "prefilter".into()));
    harness.run_steps(4);
    let baking = texts(&harness);
    harness.state_mut().baking = None;
    harness.run_steps(4);
    let after = texts(&harness);
    let changed: Vec<Rect> = moved(&baking, &after).iter().map(|text| baking[text]).collect();
    let rows = changed.iter().fold(Rect::NOTHING, |all, rect| all.union(*rect));
    assert!(!changed.is_empty() && rows.height() < 24.0, "{:?}", moved(&baking, &after));
}

#[test]
fn warnings_of_a_model_lie_over_the_picture_until_they_are_hidden() {
    let mut harness = window();
    let mut model = built_in("shader-ball").unwrap().unwrap();
    model.warnings = vec!["image 0 is damaged".into()].into();
    let state = &mut harness.state_mut().state;
    state.session.set_model(&Arc::new(model));
    state.model.shows_warnings = true;
    harness.run_steps(4);
    let after = texts(&harness);
    let (text, rect) = after.iter().find(|(text, _)| text.contains("image 0 is damaged")).unwrap();
    assert!(harness.state().picture.contains_rect(*rect), "{text} at {rect:?}");
    harness.get_by_label("Hide").click();
    harness.run_steps(2);
    assert_eq!(asked(&mut harness), ["hide-warnings"]);
}

#[test]
fn the_hint_of_the_first_start_offers_what_to_do_and_is_dismissed() {
    let mut harness = window();
    let state = &mut harness.state_mut().state;
    state.shader.tree = "the built-in shaders".into();
    state.hint = crate::app::state::hint::Hint::of_first_start();
    harness.run_steps(4);
    for (button, commands) in
        [("Choose…", &["new-tree"][..]), ("Learn…", &["learn", "dismiss-hint"]), ("Got it", &["dismiss-hint"])]
    {
        harness.get_by_label(button).click();
        harness.run_steps(2);
        assert_eq!(asked(&mut harness), commands, "{button}");
    }
    // An error is more important.
    harness.state_mut().state.session.diagnostics = vec![Diagnostic::error("brdf/ndf.glsl", "no alfa")];
    harness.run_steps(4);
    assert!(harness.query_by_label("Got it").is_none());
}

#[test]
fn the_list_of_keys_takes_letters_and_escape() {
    let mut harness = window();
    harness.state_mut().panels.show_keys = true;
    harness.run_steps(4);
    for text in ["Ctrl+Z", "list the keys"] {
        assert!(texts(&harness).contains_key(text), "no {text}");
    }
    harness.event(egui::Event::Text("ctrl undo".into()));
    harness.run_steps(4);
    let found = texts(&harness);
    assert!(found.contains_key("Ctrl+Z") && !found.contains_key("list the keys"), "{found:?}");
    // Escape is first meant for what lies above the list.
    harness.state_mut().panels.palette.open();
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(harness.state().panels.show_keys && !harness.state().panels.palette.is_open());
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(!harness.state().panels.show_keys && !texts(&harness).contains_key("Ctrl+Z"));
    assert!(asked(&mut harness).is_empty());
    // The list closes a palette that is open before it.
    let panels = &mut harness.state_mut().panels;
    panels.palette.open();
    panels.carry_out(&PanelRequest::ToggleKeys);
    assert!(panels.show_keys && !panels.palette.is_open());
}

/// Opens the palette, types, and presses Enter. Returns the commands.
fn chosen(harness: &mut Harness<'_, Window>, words: &str) -> Vec<&'static str> {
    harness.state_mut().panels.palette.open();
    harness.event(egui::Event::Text(words.into()));
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    asked(harness)
}

#[test]
fn the_palette_gives_commands_and_closes() {
    let mut harness = window();
    for (words, command) in [
        ("hide panels", "toggle-panels"),
        ("layout look", "layout"),
        ("panel lights", "panel"),
        ("undo", "undo"),
        ("expsoure -2 EV", "change"),
        ("dither off", "change"),
        ("environment sky", "open"),
    ] {
        let commands = chosen(&mut harness, words);
        assert_eq!(commands, [command], "{words}");
        assert!(!harness.state().panels.palette.is_open(), "{words}");
    }
    assert!(chosen(&mut harness, "no such entry").is_empty() && harness.state().panels.palette.is_open());
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(!harness.state().panels.palette.is_open());
}

/// A number without a value is asked for in a second step, which takes no value out of range. Escape closes the palette.
#[test]
fn the_palette_asks_for_a_number() {
    let mut harness = window();
    assert!(chosen(&mut harness, "field of view").is_empty());
    harness.event(egui::Event::Text("700".into()));
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert!(asked(&mut harness).is_empty(), "a value out of range was taken");
    harness.key_press(Key::Backspace);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert_eq!(asked(&mut harness), ["change"]);
    assert!(chosen(&mut harness, "field of view").is_empty());
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(!harness.state().panels.palette.is_open(), "Escape closes the palette, whose list would take all keys");
}

#[test]
fn the_panel_scene_says_that_a_large_model_is_being_listed() {
    let mut harness = window();
    let mut model = built_in("shader-ball").unwrap().unwrap();
    let first = model.nodes.iter().map(|node| node.index + 1).max().unwrap();
    let node = |index| scene::Node { index, name: format!("part {index}"), ..scene::Node::default() };
    let nodes = model.nodes.iter().cloned().chain((first..).map(node)).take(100_000);
    model.nodes = nodes.collect::<Vec<_>>().into();
    let state = harness.state_mut();
    state.state.session.set_model(&Arc::new(model));
    state.panels.layout.open(Panel("Scene"));
    harness.run_steps(1);
    let listing = "Listing 100,000 nodes…";
    assert!(texts(&harness).contains_key(listing), "{:?}", texts(&harness));
    while texts(&harness).contains_key(listing) {
        harness.run_steps(1);
    }
    harness.run_steps(2);
    let after = texts(&harness);
    assert!(after.keys().any(|text| text.contains("Nodes 100000")), "{after:?}");
    assert!(asked(&mut harness).is_empty());
}
