//! The panel over a trace, without a device.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::SourceState;
use crate::app::command::source::SHOW_FILE;
use crate::app::command::spec::Command;
use crate::app::commands::Commands;
use crate::app::context::Context;
use crate::app::gallery::Thumbnails;
use crate::app::panels::panel_ui::PanelUi as _;
use crate::app::readings::Readings;
use crate::app::state::State;
use crate::app::state::trace::{Progress, sample};
use crate::app::widgets::theme;
use crate::render::BakeReport;
use crate::settings::Settings;
use crate::shader::trace::sample::{called, event, trace};
use crate::shader::trace::{Act, Event, Trace};
use crate::shader::{Diagnostic, ShaderSet, Source, TreePath};

pub(super) const TEXT: &str = "#include \"b.glsl\"\nfloat f(float x) {\n    float a = x * 2.0;\n    if (a > 3.0)\n        a = 3.0;\n    return a;\n}\n";

/// The panel under test, and the commands that it has sent.
pub(super) struct Window {
    pub(super) state: State,
    pub(super) panel: SourceState,
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

pub(super) fn window_of(text: &str, trace: Trace) -> Harness<'static, Window> {
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

/// While the trace of an edit is under way, the values of before do not look as if they were those of the text beside them.
#[test]
fn values_of_the_version_before_are_dim() {
    let color = |harness: &Harness<'_, Window>| {
        let of = |shape: &egui::Shape| match shape {
            egui::Shape::Text(text) if text.galley.job.text.starts_with("a = ") => {
                text.galley.job.sections.last().map(|section| section.format.color)
            }
            _ => None,
        };
        harness.output().shapes.iter().find_map(|clipped| of(&clipped.shape)).expect("no value of `a`")
    };
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 6]);
    harness.run();
    assert_eq!(color(&harness), theme::CODE_VALUE.color());
    let traces = &mut harness.state_mut().state.traces;
    traces.progress = Progress::UnderWay(2);
    harness.state_mut().state.session.shaders = Some(shaders(2, &TEXT.replace("2.0", "4.0")));
    harness.run();
    assert_eq!(color(&harness), theme::QUIET.color());
}

/// Nobody sees that a value is missing where the others end. Values that are 0 are missed least.
#[test]
fn values_without_room_are_counted() {
    let many: Vec<Event> = (0..40).map(|index| event(3, Act::Store, &format!("v{index}"), &[index as f32])).collect();
    let mut harness = window(TEXT, many, &[3]);
    harness.run();
    let shown = (1..40).filter(|index| harness.query_by_label(&format!("v{index} = {index}")).is_some()).count();
    assert!((1..38).contains(&shown), "{shown} of 39 are shown");
    let rest: Vec<String> = (shown + 1..40).chain([0]).map(|index| format!("v{index} = {index}")).collect();
    harness.get_by_label(&rest.join("\n"));
}

#[test]
fn with_an_error_the_values_are_of_the_last_version_that_compiled() {
    const WORDS: &str = "values of the last version that compiled";
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 6]);
    harness.run();
    assert!(harness.query_by_label(WORDS).is_none());
    harness.state_mut().state.session.diagnostics = vec![Diagnostic::error("a.glsl", "an error")];
    harness.run();
    harness.get_by_label(WORDS);
    assert!(
        harness.query_by_label_contains("equal to the picture").is_none(),
        "a proof stands beside a text that it is not of"
    );
    harness.state_mut().state.session.diagnostics.clear();
    harness.run();
    assert!(harness.query_by_label(WORDS).is_none());
}
