//! The panels as a screen reader finds them: roles, names, and the keyboard.

use std::sync::Arc;
use std::time::Instant;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::Vec3;

use super::overlay::legend::{self, Legend, LegendState};
use super::overlay::swatches::swatches;
use super::panel_ui::PanelSpec;
use super::timeline::comparison;
use super::{PANELS, Panel, camera, capture, model, output, overlay};
use crate::app::command::camera::{KEEP_CAMERA, RECALL_CAMERA, VIEW_FROM, ViewSide};
use crate::app::command::compare::{COMPARE, CompareFields};
use crate::app::command::file::CHOOSE;
use crate::app::command::models::{SCENE, SceneFields};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::gallery::Thumbnails;
use crate::app::readings::{LegendOf, Readings, Readout};
use crate::app::state::State;
use crate::app::state::adaptive::plan::Plan;
use crate::app::state::adaptive::{Change, NextFrame};
use crate::app::state::captures::Captures;
use crate::app::state::compare::Compare;
use crate::app::state::dialog::Dialog;
use crate::app::widgets::theme;
use crate::render::BakeReport;
use crate::scene::{Bounds, CameraView, Contents, Model, built_in};
use crate::settings::{Channels, Colormap, Settings, ViewRange};
use crate::shader::annotation::ParameterType;
use crate::shader::{Diagnostic, Encode, Mode, Numbers, Parameter, ShaderSet, Source};

fn harness<'a, T: 'a>(state: T, mut show: impl FnMut(&mut egui::Ui, &mut T) + 'a) -> Harness<'a, T> {
    let mut has_theme = false;
    let show = move |ui: &mut egui::Ui, state: &mut T| {
        if !std::mem::replace(&mut has_theme, true) {
            theme::apply(ui.ctx());
        }
        show(ui, state);
    };
    let mut harness = Harness::new_ui_state(show, state);
    harness.run();
    harness
}

#[test]
fn the_legend_names_the_mode_and_its_switches() {
    let mode = Mode { name: "Depth".into(), unit: "m".into(), encode: Encode::Data, components: 1, ..Mode::default() };
    let of = LegendOf {
        mode,
        limits: Some((2.9, 4.2)),
        range_sample: None,
        colormap: Colormap::None,
        exposure: 1.0,
        swatches: Vec::new(),
    };
    let state = (Settings::of_window().view, LegendState::default());
    let mut harness = harness(state, move |ui, (view, state)| {
        let readout = Readout { side: Some("kept".into()), value: "3.01758".into(), unit: "m".into(), at: (12, 34) };
        let legend = Legend { title: Some("Depth"), of: &of, value: Some(&readout) };
        legend::show(ui, &legend, view, state, 600.0);
    });
    for text in ["Depth  ·  m", "2.9", "4.2", "3.01758", "kept  ·  m  ·  at 12, 34"] {
        harness.get_by_label(text);
    }
    harness.get_by_role_and_label(Role::Button, "auto");
    harness.get_by_role_and_label(Role::Button, "R").click();
    harness.run();
    assert_eq!(harness.state().0.channels, Channels::R);
    harness.get_by_role_and_label(Role::Button, "Histogram").click();
    harness.run();
    assert!(harness.state().1.shows_histogram);
}

#[test]
fn the_legend_names_the_colors_of_numbers() {
    let numbers = Some(Numbers::Names(["front", "back"].map(str::to_owned).to_vec()));
    let number_colors = vec![Some([0x3f, 0xbc, 0x59]), Some([0xe7, 0x45, 0x30])];
    let mode = Mode { name: "Face orientation".into(), numbers, number_colors, components: 3, ..Mode::default() };
    let swatches = swatches(&mode, None, &ShaderSet::default());
    let of = LegendOf { mode, limits: None, range_sample: None, colormap: Colormap::None, exposure: 1.0, swatches };
    let state = (Settings::of_window().view, LegendState::default());
    let mut harness = harness(state, move |ui, (view, state)| {
        let legend = Legend { title: None, of: &of, value: None };
        legend::show(ui, &legend, view, state, 600.0);
    });
    assert!(["front", "back"].iter().all(|name| harness.query_by_label(name).is_some()));
    // Colors that stand for numbers have no channels. If another mode has left one, it is gray, and the buttons lead back.
    assert!(harness.query_by_label("RGB").is_none());
    harness.state_mut().0.channels = Channels::R;
    harness.run();
    assert!(harness.query_by_label("front").is_none());
    harness.get_by_role_and_label(Role::Button, "RGB").click();
    harness.run();
    assert!(harness.query_by_label("front").is_some());
}

#[test]
fn rows_are_named_and_follow_the_keyboard() {
    let mut harness = harness(Settings::of_window(), |ui, settings| {
        output::show(ui, settings, &mut false, &mut Vec::new());
    });
    for name in ["Exposure", "Range", "Channels", "Colormap", "Wireframe", "Dither"] {
        assert!(harness.query_all_by_label(name).next().is_some(), "{name}");
    }
    harness.get_by_role_and_label(Role::Slider, "Exposure").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowRight);
    harness.run();
    assert!(harness.state().view.ev < Settings::of_window().view.ev, "one step brighter");
    harness.get_by_role_and_label(Role::CheckBox, "Wireframe").click();
    harness.run();
    assert!(harness.state().view.wireframe);
    assert_eq!(harness.state().view.range, ViewRange::Auto);
}

#[test]
fn a_turntable_has_the_format_that_was_chosen() {
    let state = (capture::CaptureState::default(), Vec::<Command>::new());
    let mut harness = harness(state, |ui, (state, commands)| {
        capture::show(ui, state, &Captures::default(), ((640, 480), 2), commands);
    });
    for (name, stem) in [("Write turntable", "specula-turntable-"), ("Write timeline", "specula-timeline-")] {
        for format in ["MP4", "GIF", "WebP"] {
            harness.get_by_role_and_label(Role::Button, format).click();
            harness.run();
            harness.get_by_role_and_label(Role::Button, name).click();
            harness.run();
            let command = harness.state_mut().1.pop().unwrap_or_else(|| panic!("{name} asks for nothing"));
            let text = format!("{command:?}");
            let file = text.split('"').nth(1).unwrap_or_default();
            assert!(file.starts_with(stem) && file.ends_with(&format!(".{}", format.to_lowercase())), "{text}");
        }
    }
}

#[test]
fn cameras_are_kept_and_found_by_their_number() {
    let state = (Settings::default(), Vec::<Command>::new());
    let mut harness = harness(state, |ui, (settings, commands)| {
        camera::show(ui, settings, None, &Model::default(), commands);
    });
    harness.get_by_role_and_label(Role::Button, "3").click();
    harness.run();
    assert_eq!(harness.state().1, [KEEP_CAMERA.with(3)]);
    let settings = &mut harness.state_mut().0;
    settings.bookmarks.insert("3".into(), settings.camera.clone());
    harness.run();
    harness.get_by_role_and_label(Role::Button, "3").click();
    harness.run();
    assert_eq!(harness.state().1.last(), Some(&RECALL_CAMERA.with(3)));
}

#[test]
fn the_scenes_of_a_file_are_a_choice_if_there_are_several() {
    let of = |names: &[&str]| {
        let contents =
            Contents { scenes: names.iter().map(|name| (*name).to_owned()).collect(), ..Contents::default() };
        let model = Model { contents: contents.into(), ..Model::default() };
        harness(Vec::<Command>::new(), move |ui, commands| model::scenes(ui, &model, commands))
    };
    assert!(of(&["alone"]).query_by_role(Role::ComboBox).is_none());
    let mut several = of(&["hall", "", "hall", "garden"]);
    several.get_by_role(Role::ComboBox).click();
    several.run();
    for name in ["#1", "#2"] {
        several.get_by_role_and_label(Role::Button, name);
    }
    several.get_by_role_and_label(Role::Button, "garden").click();
    several.run();
    assert_eq!(*several.state(), [SCENE.with(SceneFields::of(3))]);
}

#[test]
fn the_camera_is_placed_by_numbers_and_from_the_sides() {
    let bounds = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
    let view = CameraView::new(Vec3::new(1.0, 2.0, 4.0), Vec3::ZERO, 0.7, 1.5, &bounds);
    let state = (Settings::default(), Vec::<Command>::new());
    let mut harness = harness(state, move |ui, (settings, commands)| {
        camera::show(ui, settings, Some(&view), &Model::default(), commands);
    });
    assert_eq!(harness.state().0.camera.eye, None, "the panel changes nothing by itself");
    harness.get_by_label("Position y").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowUp);
    harness.run();
    let camera = harness.state().0.camera.clone();
    let eye = camera.eye.expect("a position");
    assert!(eye[1] > 2.0 && [eye[0], eye[2]] == [1.0, 4.0] && camera.target == Some([0.0; 3]), "{camera:?}");
    harness.get_by_role_and_label(Role::Button, "View from the top (Numpad 7)").click();
    harness.run();
    assert_eq!(harness.state().1, [VIEW_FROM.with(ViewSide::Top)]);
}

#[test]
fn a_comparison_begins_with_a_picture_or_a_second_tree() {
    let state = (Compare::default(), Vec::new());
    let mut harness = harness(state, |ui, (compare, commands)| comparison::show(ui, compare, None, commands));
    harness.get_by_role_and_label(Role::Button, "Keep this picture").click();
    harness.run();
    for name in ["A picture…", "A shader tree…"] {
        harness.get_by_role_and_label(Role::Button, "Compare with…").click();
        harness.run();
        harness.get_by_role_and_label(Role::Button, name).click();
        harness.run();
    }
    let (_, commands) = harness.state();
    let expected =
        [COMPARE.with(CompareFields::picture()), CHOOSE.with(Dialog::Picture), CHOOSE.with(Dialog::SecondTree)];
    assert_eq!(commands.as_slice(), expected);
}

#[test]
fn the_buttons_of_a_comparison_fit_a_narrow_column() {
    let column = egui::vec2(180.0, 300.0);
    let mut harness = harness((Compare::default(), 0.0), move |ui, (compare, reach)| {
        let column = egui::Rect::from_min_size(ui.min_rect().min, column);
        ui.scope_builder(egui::UiBuilder::new().max_rect(column), |ui| {
            comparison::show(ui, compare, None, &mut Vec::new());
            *reach = ui.min_rect().width();
        });
    });
    harness.run();
    assert!(harness.state().1 <= column.x, "{}", harness.state().1);
    for name in ["Keep this picture", "Compare with…"] {
        let height = harness.get_by_role_and_label(Role::Button, name).rect().height();
        assert!(height < 26.0, "`{name}` is in one line: {height}");
    }
}

/// Label that a panel shows without a model, and with one.
const LABELS: [(Panel, [&str; 2]); 18] = [
    (Panel::MODES, ["Compiling shaders…", "Facing"]),
    (Panel("Scene"), ["No model yet", "Search nodes, materials, textures"]),
    (Panel("Model"), ["Statistics", "Statistics"]),
    (Panel::TEXTURE, ["", "shell base color"]),
    (Panel::LEARN, ["Square the roughness", "Square the roughness"]),
    (Panel::SHADERS, ["Reload", "Version 1"]),
    (Panel::SOURCE, ["Compiling shaders…", "Click a pixel of the picture"]),
    (Panel::TIMELINE, ["Keep this picture", "Keep this picture"]),
    (Panel::TIMING, ["Pipelines", "Pipelines"]),
    (Panel::EXPRESSION, ["Watch", "Watch"]),
    (Panel::PARAMETERS, ["", "Tint"]),
    (Panel::PASSES, ["", ""]),
    (Panel::INSPECTOR, ["no pixel", "no pixel"]),
    (Panel("Environment"), ["Visible", "Visible"]),
    (Panel("Lights"), ["Ambient light", "Ambient light"]),
    (Panel::OUTPUT, ["Copy as look file", "Copy as look file"]),
    (Panel("Camera"), ["Frame the model", "Frame the model"]),
    (Panel::CAPTURE, ["Capture picture", "Capture picture"]),
];

/// A window with a model and shaders, and nothing drawn yet.
fn with_a_model() -> State {
    let mut state = State::new(Settings::of_window(), Source::embedded());
    state.session.set_model(&Arc::new(built_in("shader-ball").unwrap().unwrap()));
    let mode = Mode { name: "Facing".into(), slug: "facing".into(), group: "Test".into(), ..Mode::default() };
    let parameter = Parameter {
        name: "tint".into(),
        label: "Tint".into(),
        offset: Some(0),
        kind: ParameterType::Float,
        range: Some((0.0, 1.0)),
        default: vec![0.5],
        color: false,
        choices: Vec::new(),
        choice_docs: Vec::new(),
        when: None,
        group: String::new(),
        doc: String::new(),
        unit: String::new(),
        file: String::new(),
        line: 0,
    };
    let shaders = ShaderSet { generation: 3, modes: vec![mode], parameters: vec![parameter], ..ShaderSet::default() };
    state.session.shaders = Some(Arc::new(shaders));
    state.shader.compiling = false;
    state
}

/// Runs the interface for some frames. Returns what the panels ask for.
fn frames(size: egui::Vec2, state: &State, mut show: impl FnMut(&mut egui::Ui, &Context<'_>, &mut Commands)) -> Shown {
    let (thumbnails, baked) = (Thumbnails::default(), BakeReport::default());
    let mut asked = Vec::new();
    let mut has_theme = false;
    let mut harness = Harness::builder().with_size(size).build_ui(|ui| {
        if !std::mem::replace(&mut has_theme, true) {
            theme::apply(ui.ctx());
        }
        let readings = Readings {
            baking: None,
            baked: &baked,
            memory: None,
            thumbnails: &thumbnails,
            texture: None,
            pipelines: 0,
            value: None,
            title: None,
            legend: None,
        };
        let mut commands = Commands::new(&state.session.settings);
        show(ui, &Context::new(state, readings), &mut commands);
        asked.extend(commands.finish(&state.session.settings).0);
    });
    harness.run_steps(3);
    let texts = |node: egui_kittest::Node<'_>| [node.accesskit_node().label(), node.accesskit_node().value()];
    let labels: Vec<String> = harness.root().children_recursive().flat_map(texts).flatten().collect();
    drop(harness);
    Shown { labels, asked }
}

/// The labels that a screen reader finds, and the commands.
struct Shown {
    labels: Vec<String>,
    asked: Vec<Command>,
}

/// A picture with the overlay over it.
fn over_the_picture(state: State) -> Harness<'static, State> {
    let mut own = overlay::Overlay::default();
    harness(state, move |ui, state| {
        let (thumbnails, baked) = (Thumbnails::default(), BakeReport::default());
        let readings = Readings {
            baking: None,
            baked: &baked,
            memory: None,
            thumbnails: &thumbnails,
            texture: None,
            pipelines: 0,
            value: None,
            title: None,
            legend: None,
        };
        let (egui, picture, mut commands) = (ui.ctx().clone(), ui.max_rect(), Commands::new(&state.session.settings));
        overlay::show(&egui, &Context::new(state, readings), &mut own, true, picture, &mut commands);
    })
}

#[test]
fn errors_are_hidden_until_they_change() {
    let mut state = with_a_model();
    state.session.diagnostics = vec![Diagnostic::error("a.glsl", "the first error")];
    let mut harness = over_the_picture(state);
    harness.get_by_label("the first error");
    harness.get_by_role_and_label(Role::Button, "Hide").click();
    harness.run();
    assert!(harness.query_by_label("the first error").is_none());
    harness.state_mut().session.diagnostics.push(Diagnostic::error("a.glsl", "the second error"));
    harness.run();
    harness.get_by_label("the second error");
    assert_eq!(harness.state().session.diagnostics.len(), 2, "hiding forgets nothing");
}

#[test]
fn the_mark_of_a_preview_lies_beside_other_cards() {
    const MARK: &str = "Preview of lower resolution";
    let mut state = with_a_model();
    state.session.diagnostics = vec![Diagnostic::error("a.glsl", "the first error")];
    let now = Instant::now();
    let plan = NextFrame {
        change: Change::Moved,
        has_parts: false,
        is_held: false,
        accumulates: false,
        improves: false,
        is_awaited: false,
        now,
    };
    assert_eq!(state.previews.plan(&plan), Plan::Preview);
    let harness = over_the_picture(state);
    let [mark, hide] = [harness.get_by_label(MARK), harness.get_by_label("Hide")].map(|node| node.rect());
    assert!(mark.max.y < hide.min.y, "{mark} lies over the card of {hide}");
}

const SIZES: [egui::Vec2; 2] = [egui::vec2(190.0, 420.0), egui::vec2(900.0, 240.0)];

#[test]
fn every_panel_is_shown_without_a_device_and_changes_nothing_by_itself() {
    let states = [State::new(Settings::of_window(), Source::embedded()), with_a_model()];
    let mut lacking = Vec::new();
    for &&PanelSpec { panel, make, .. } in PANELS {
        let expected =
            LABELS.into_iter().find(|(of, _)| *of == panel).map(|(_, expected)| expected).unwrap_or_default();
        for ((state, expected), size) in states.iter().zip(expected).flat_map(|of| SIZES.map(|size| (of, size))) {
            let mut shown_panel = make();
            let shown = frames(size, state, |ui, context, commands| shown_panel.ui(ui, context, commands));
            assert!(shown.asked.is_empty(), "{panel:?} at {size:?}: {:?}", shown.asked);
            if !expected.is_empty() && !shown.labels.iter().any(|label| label.contains(expected)) {
                lacking.push(format!("{panel:?} at {size:?} lacks `{expected}`: {:?}", shown.labels));
            }
        }
    }
    assert!(lacking.is_empty(), "{}", lacking.join("\n"));
}
