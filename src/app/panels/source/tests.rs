//! The panel over a trace, without a device.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::SourceState;
use crate::app::command::source::{CHOOSE_TRACE, SAVE_FILE, SHOW_FILE, Typed};
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::gallery::Thumbnails;
use crate::app::panels::panel_ui::PanelUi as _;
use crate::app::readings::Readings;
use crate::app::state::State;
use crate::app::state::trace::choice::Choice;
use crate::app::state::trace::sample;
use crate::app::state::trace::saved::WrittenText;
use crate::app::widgets::theme;
use crate::recovery::TypedText;
use crate::render::BakeReport;
use crate::settings::Settings;
use crate::shader::trace::sample::{called, event, trace};
use crate::shader::trace::{Act, Event, Trace, TracedLight};
use crate::shader::{Diagnostic, ShaderSet, Source, TreePath};
use crate::write_back::TreeFile;

pub(super) const TEXT: &str = "#include \"b.glsl\"\nfloat f(float x) {\n    float a = x * 2.0;\n    if (a > 3.0)\n        a = 3.0;\n    return a;\n}\n";

/// The panel under test, and the commands that it has sent.
pub(super) struct Window {
    pub(super) state: State,
    panel: SourceState,
    pub(super) asked: Vec<Command>,
    /// The settings that it has asked for last.
    pub(super) set: Option<Settings>,
    /// How long it took to build its last frame.
    took: Duration,
}

fn shaders(generation: u64, text: &str) -> Arc<ShaderSet> {
    let files = [("a.glsl", text), ("b.glsl", "float g;\n")];
    let texts = files.map(|(path, text)| (TreePath::from(path), Arc::<str>::from(text)));
    Arc::new(ShaderSet { generation, texts: BTreeMap::from(texts), ..ShaderSet::default() })
}

/// Takes a trace of a version of `a.glsl`.
fn add(state: &mut State, generation: u64, text: &str, trace: Trace) {
    let shaders = shaders(generation, text);
    state.inspection.pin = Some([3, 4]);
    sample::add_trace(&mut state.traces, &shaders, generation, trace);
    state.session.shaders = Some(shaders);
}

pub(super) fn events(a: f32) -> Vec<Event> {
    vec![
        event(2, Act::Argument, "x", &[0.5 * a]),
        event(3, Act::Store, "a", &[a]),
        event(4, Act::Condition, "", &[0.0]),
        event(6, Act::Return, "", &[a]),
    ]
}

pub(super) fn window(text: &str, events: Vec<Event>, statements: &[u32]) -> Harness<'static, Window> {
    window_of(text, trace(events, statements))
}

fn window_of(text: &str, trace: Trace) -> Harness<'static, Window> {
    let mut state = State::new(Settings::of_window(), Source::embedded());
    add(&mut state, 1, text, trace);
    let window = Window { state, panel: SourceState::default(), asked: Vec::new(), set: None, took: Duration::ZERO };
    let mut has_theme = false;
    let show = move |ui: &mut egui::Ui, window: &mut Window| {
        if !std::mem::replace(&mut has_theme, true) {
            theme::apply(ui.ctx());
        }
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
        let mut commands = Commands::new(&window.state.session.settings);
        let begin = Instant::now();
        window.panel.ui(ui, &Context::new(&window.state, readings), &mut commands);
        window.took = begin.elapsed();
        let is_set = commands.settings != window.state.session.settings;
        window.set = is_set.then(|| commands.settings.clone()).or(window.set.take());
        window.asked.extend(commands.finish(&window.state.session.settings).0);
    };
    let mut harness = Harness::builder().with_size(egui::vec2(900.0, 300.0)).build_ui_state(show, window);
    harness.run_steps(3);
    harness
}

/// The labels that a screen reader finds.
pub(super) fn labels(harness: &Harness<'_, Window>) -> Vec<String> {
    let texts = |node: egui_kittest::Node<'_>| [node.accesskit_node().label(), node.accesskit_node().value()];
    harness.root().children_recursive().flat_map(texts).flatten().collect()
}

#[test]
fn values_stand_beside_the_code_and_change_with_a_save() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    for text in ["x = 1", "a = 2", "not taken", "return 2", "3:     float a = x * 2.0;"] {
        harness.get_by_label(text);
    }
    assert!(labels(&harness).iter().any(|label| label.contains("equal to the picture")), "{:?}", labels(&harness));
    let edited = TEXT.replace("2.0", "4.0");
    add(&mut harness.state_mut().state, 2, &edited, trace(events(4.0), &[2, 3, 4, 5, 6]));
    harness.run_steps(3);
    for text in ["x = 1 → 2", "a = 2 → 4", "not taken", "return 2 → 4"] {
        harness.get_by_label(text);
    }
    harness.get_by_label_contains("first change: line 2, 3 in all");
    assert!(harness.state().asked.is_empty(), "the panel changes nothing by itself");
}

#[test]
fn an_include_and_the_list_open_a_file() {
    let mut harness = window(TEXT, events(2.0), &[2]);
    harness.get_by_role_and_label(Role::Button, "Open b.glsl").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [SHOW_FILE.with("b.glsl".into())]);
    harness.state_mut().state.traces.file = Some("b.glsl".into());
    harness.run_steps(2);
    harness.get_by_label("1: float g;");
    assert!(!labels(&harness).iter().any(|label| label == "a = 2"), "values of another file");
}

#[test]
fn errors_stand_below_their_lines() {
    let mut harness = window(TEXT, events(2.0), &[2]);
    let state = &mut harness.state_mut().state;
    let file = state.source.display_path(&"a.glsl".into());
    state.session.diagnostics = vec![Diagnostic::error(file, "'q' : undeclared").on_line(3, None)];
    harness.run_steps(2);
    let message = harness.get_by_label("'q' : undeclared").rect();
    let [above, below] = ["3:     float a", "4:     if (a"].map(|line| harness.get_by_label_contains(line).rect());
    assert!(above.bottom() <= message.top() && message.bottom() <= below.top(), "{above:?} {message:?} {below:?}");
}

#[test]
fn the_search_finds_lines_of_a_long_file_of_which_few_are_shown() {
    let text: String = (1..=600).map(|line| format!("float v{line} = {line}.0;\n")).collect();
    let mut harness = window(&text, vec![event(5, Act::Store, "v5", &[5.0])], &[5]);
    let shown =
        |harness: &Harness<'_, Window>| labels(harness).iter().filter(|label| label.contains(": float v")).count();
    assert!((5..40).contains(&shown(&harness)), "{}", shown(&harness));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::F);
    harness.run_steps(2);
    harness.get_by_label("Find in the file").type_text("V432");
    harness.run_steps(3);
    harness.get_by_label("1 of 1 lines");
    harness.get_by_label("432: float v432 = 432.0;");
    assert!(shown(&harness) < 40);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("Find in the file").is_none());
}

/// Prints a figure. By hand: `cargo test --release --lib -- --ignored --nocapture a_frame_of_600_lines`.
#[test]
#[ignore = "a figure of a release build, and no check"]
fn a_frame_of_600_lines() {
    let function = |at: usize| {
        let values = (0..8).map(|line| format!("    float v{line} = x * {at}.5 + sin(float({line})); // a value\n"));
        format!("float f{at}(float x) {{\n{}    return v7;\n}}\n", values.collect::<String>())
    };
    let text: String = (0..55).map(function).collect();
    let lines: Vec<u32> = (1..=605).collect();
    // As many events as a log holds.
    let events = |first: f32| {
        let call = move |light: usize| {
            let stores = (1..=605_u32).filter(|line| !matches!(line % 11, 0 | 1));
            let path = format!("shade > add_light [light {light}] > f");
            stores.map(move |line| called(&path, line, Act::Store, &format!("v{}", line % 11), &[first + line as f32]))
        };
        (1..=30).flat_map(call).collect::<Vec<_>>()
    };
    let mut harness = window(&text, events(0.5), &lines);
    harness.run_steps(10);
    let mut scrolled = 0;
    for what in ["at rest", "the mouse moves", "it scrolls", "a trace comes"] {
        let mut frames: Vec<Duration> = Vec::new();
        for frame in 0..50 {
            match what {
                "the mouse moves" => harness.hover_at(egui::pos2(100.0 + frame as f32, 60.0 + frame as f32)),
                "it scrolls" => {
                    let (unit, phase) = (egui::MouseWheelUnit::Point, egui::TouchPhase::Move);
                    let (delta, modifiers) = (egui::vec2(0.0, -30.0), Modifiers::NONE);
                    harness.event(egui::Event::MouseWheel { unit, delta, phase, modifiers });
                    scrolled += 1;
                }
                "a trace comes" => {
                    add(&mut harness.state_mut().state, 1, &text, trace(events(frame as f32), &lines));
                }
                _ => {}
            }
            harness.step();
            frames.push(harness.state().took);
        }
        frames.sort();
        crate::message::tell(format_args!("{what}: median {:?}, most {:?}", frames[25], frames[49]));
    }
    assert_eq!(scrolled, 50);
}

#[test]
fn a_call_is_chosen_where_there_are_more() {
    let both = ["main > f", "main > f [2]"].map(|calls| called(calls, 3, Act::Store, "a", &[2.0]));
    let mut harness = window(TEXT, both.to_vec(), &[3]);
    harness.get_by_label("Call").click();
    harness.run_steps(2);
    harness.get_by_label("main > f [2]").click();
    harness.run_steps(2);
    let chosen = Choice { call: Some("main > f [2]".to_owned()), ..Choice::default() };
    assert_eq!(harness.state().asked, [CHOOSE_TRACE.with(chosen)]);
}

#[test]
fn calls_stand_below_their_callers_with_their_lights() {
    let paths =
        ["shade > add_light [light 1] > d_ggx", "shade > add_light [light 2] > d_ggx", "shade > d_ggx", "other"];
    let light =
        |name: &str, intensity: [f32; 3]| TracedLight { name: name.into(), kind: "point", intensity, unit: "cd" };
    let mut trace = trace(paths.map(|calls| called(calls, 3, Act::Store, "a", &[2.0])).to_vec(), &[3]);
    trace.lights = vec![light("lamp", [12.0, 6.0, 0.0]), light("", [3.0; 3])];
    let mut harness = window_of(TEXT, trace);
    harness.get_by_label("Call").click();
    harness.run_steps(2);
    harness.get_by_label("lamp, point, 12 cd");
    harness.get_by_label("point, 3 cd");
    let rows = [
        "shade",
        "shade > add_light [light 1]",
        "shade > add_light [light 1] > d_ggx",
        "shade > add_light [light 2]",
        "shade > add_light [light 2] > d_ggx",
        "shade > d_ggx",
        "other",
    ];
    let places = rows.map(|row| harness.get_by_label(row).rect().left_top());
    assert!(places.is_sorted_by(|a, b| a.y < b.y), "{places:?}");
    let columns = places.map(|place| place.x);
    assert!(columns[0] < columns[1] && columns[1] < columns[2] && columns[1] == columns[5] && columns[0] == columns[6]);
    // A call without statements of the file leads to some.
    harness.get_by_label("shade > add_light [light 2]").click();
    harness.run_steps(2);
    let chosen = Choice { call: Some("shade > add_light [light 2]".to_owned()), ..Choice::default() };
    assert_eq!(harness.state().asked, [CHOOSE_TRACE.with(chosen.clone())]);
    harness.state_mut().state.traces.choice = chosen;
    harness.run_steps(2);
    harness.get_by_label("a = 2");
}

/// Opens a tree whose shaders are in use.
fn open(harness: &mut Harness<'_, Window>, root: &Path) {
    let state = &mut harness.state_mut().state;
    (state.source, state.shader.in_use) = (Source::disk(root.to_owned()), Some(root.to_owned()));
}

#[test]
fn a_file_is_typed_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    crate::shader::embedded::write_to(&folder.path().join("tree"), None).unwrap();
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let root = folder.path().join("tree");
    open(&mut harness, &root);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let field = harness.get_by_label("Text of the file");
    assert_eq!(field.accesskit_node().value().unwrap(), TEXT);
    field.type_text("// new");
    harness.run_steps(1);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    harness.get_by_label("not saved");
    // The values go with their lines.
    harness.get_by_label("a = 2");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    let (file, base) = (TreeFile { root, path: "a.glsl".into() }, Arc::<str>::from(TEXT));
    let text: Arc<str> = format!("// new\n{TEXT}").into();
    assert_eq!(harness.state().asked, [SAVE_FILE.with(Typed { file: file.clone(), base, text: text.clone() })]);
    // Another program has added a line, which the merged text has.
    let merged: Arc<str> = format!("{text}// theirs\n").into();
    let written = WrittenText { file, typed: text, text: Some(merged.clone()) };
    harness.state_mut().state.traces.written = Some(written);
    harness.run_steps(2);
    assert!(harness.query_by_label("not saved").is_none());
    assert_eq!(harness.get_by_label("Text of the file").accesskit_node().value().unwrap(), *merged);
    harness.get_by_role_and_label(Role::Button, "Done").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Text of the file").is_none());
}

/// A file of another playground is compiled with some words changed. It is shown and typed as its author wrote it.
#[test]
fn a_single_file_is_typed_as_its_author_wrote_it() {
    const OWN: &str = "void main() {\n    float a;\n}\n";
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let file = Path::new("toys/wave.frag");
    let opened = TreePath::from("opened/wave.frag");
    let state = &mut harness.state_mut().state;
    (state.source, state.shader.in_use) = (Source::open(file.to_owned()), Some(file.to_owned()));
    state.traces.file = Some(opened.clone());
    let texts = BTreeMap::from([(opened.clone(), "void Main() {\n    float a = 0.0;\n}\n".into())]);
    let author_texts = BTreeMap::from([(opened, OWN.into())]);
    state.session.shaders = Some(Arc::new(ShaderSet { generation: 2, texts, author_texts, ..ShaderSet::default() }));
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let field = harness.get_by_label("Text of the file");
    assert_eq!(field.accesskit_node().value().unwrap(), OWN);
    field.type_text("// new ");
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    let file = TreeFile { root: "toys".into(), path: "wave.frag".into() };
    let text = format!("// new {OWN}").into();
    assert_eq!(harness.state().asked, [SAVE_FILE.with(Typed { file, base: OWN.into(), text })]);
}

#[test]
fn what_was_typed_is_taken_back() {
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    open(&mut harness, Path::new("tree"));
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    let typed = |harness: &Harness<'_, Window>| {
        harness.get_by_label("Text of the file").accesskit_node().value().unwrap().clone()
    };
    harness.get_by_label("Text of the file").type_text("// new");
    harness.run_steps(2);
    let with_it = format!("// new{TEXT}");
    assert_eq!(typed(&harness), with_it);
    for (modifiers, key, text) in [
        (Modifiers::COMMAND, Key::Z, TEXT),
        (Modifiers::COMMAND | Modifiers::SHIFT, Key::Z, &with_it),
        (Modifiers::COMMAND, Key::Z, TEXT),
    ] {
        harness.key_press_modifiers(modifiers, key);
        harness.run_steps(2);
        assert_eq!(typed(&harness), text);
        assert_eq!(harness.query_by_label("not saved").is_some(), text != TEXT);
    }
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    assert!(harness.state().asked.is_empty(), "there is nothing to save");
}

#[test]
fn typed_text_stays_in_its_tree() {
    let mut harness = window(TEXT, events(2.0), &[2, 3]);
    let [a, b] = ["trees/a", "trees/b"].map(Path::new);
    open(&mut harness, a);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    harness.get_by_label("Text of the file").type_text("// of a");
    harness.run_steps(2);
    harness.get_by_label("not saved");
    let file = TreeFile { root: a.to_owned(), path: "a.glsl".into() };
    let (root, file, path, base) = (file.root, file.path.clone(), file.path, TEXT.to_owned());
    let unsaved = vec![TypedText { root, file, path, base, text: format!("// of a{TEXT}") }];
    assert_eq!(harness.state().panel.unsaved(), unsaved);
    // Another tree is opened. Until its shaders are in use, the file in sight is of neither.
    harness.state_mut().state.source = Source::disk(b.to_owned());
    harness.run_steps(2);
    assert!(harness.query_by_label("Text of the file").is_none(), "text of another tree");
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Text of the file").is_none(), "a file that cannot be written yet");
    open(&mut harness, b);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    assert_eq!(harness.get_by_label("Text of the file").accesskit_node().value().unwrap(), TEXT);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    assert!(harness.state().asked.is_empty(), "nothing was typed in this tree");
    assert_eq!(harness.state().panel.unsaved(), unsaved, "closing would still lose it");
    // The first tree has its text still, and saves it there. After a failure, it can be saved again.
    open(&mut harness, a);
    harness.run_steps(2);
    let text: Arc<str> = format!("// of a{TEXT}").into();
    assert_eq!(harness.get_by_label("Text of the file").accesskit_node().value().unwrap(), *text);
    let file = TreeFile { root: a.to_owned(), path: "a.glsl".into() };
    for saves in 1..=2 {
        harness.state_mut().state.traces.written = None;
        harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
        harness.run_steps(2);
        let save = SAVE_FILE.with(Typed { file: file.clone(), base: TEXT.into(), text: text.clone() });
        assert_eq!(harness.state().asked, vec![save; saves]);
        let written = WrittenText { file: file.clone(), typed: text.clone(), text: None };
        harness.state_mut().state.traces.written = Some(written);
        harness.run_steps(2);
    }
    harness.get_by_label("not saved");
}

/// A trace may lie in memory where the one before it was.
#[test]
fn each_trace_shows_its_own_values() {
    let mut harness = window(TEXT, events(1.0), &[2, 3, 4, 6]);
    for number in 2..20 {
        add(&mut harness.state_mut().state, 1, TEXT, trace(events(number as f32), &[2, 3, 4, 6]));
        harness.run();
        harness.get_by_label(&format!("a = {number}"));
    }
}
