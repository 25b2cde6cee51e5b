//! The choice among the calls and times of a traced pixel, without a device.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

use super::tests::{TEXT, window, window_of};
use crate::app::command::source::CHOOSE_TRACE;
use crate::app::state::trace::choice::Choice;
use crate::shader::trace::sample::{called, event, trace};
use crate::shader::trace::{Act, TracedLight};

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

/// A call whose lines are far below comes into sight when it is chosen.
#[test]
fn a_chosen_call_comes_into_sight() {
    let text: String = (1..=400).map(|line| format!("float v{line} = {line}.0;\n")).collect();
    let far = [called("near", 3, Act::Store, "v3", &[3.0]), called("far", 300, Act::Store, "v300", &[300.0])];
    let mut harness = window(&text, far.to_vec(), &[3, 300]);
    assert!(harness.query_by_label("300: float v300 = 300.0;").is_none());
    harness.get_by_label("Call").click();
    harness.run_steps(2);
    harness.get_by_label("far").click();
    harness.run_steps(2);
    let chosen = Choice { call: Some("far".to_owned()), ..Choice::default() };
    assert_eq!(harness.state_mut().asked, [CHOOSE_TRACE.with(chosen.clone())]);
    // As the command does.
    harness.state_mut().state.traces.choose(chosen);
    harness.run_steps(3);
    harness.get_by_label("300: float v300 = 300.0;");
    harness.get_by_label("v300 = 300");
}

/// Of a statement that ran more than once, a number in the box chooses the time.
#[test]
fn a_click_on_the_box_of_the_time_takes_a_number() {
    let times = [1.0, 2.0, 3.0].map(|a| event(3, Act::Store, "a", &[a]));
    let mut harness = window(TEXT, times.to_vec(), &[3]);
    harness.get_by_label("a = 1, 2, 3 ×3");
    harness.get_by_label("Time").click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text("2".to_owned()));
    harness.run_steps(1);
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    let chosen = Choice { time: Some(2), ..Choice::default() };
    assert_eq!(harness.state().asked.last(), Some(&CHOOSE_TRACE.with(chosen.clone())));
    harness.state_mut().state.traces.choose(chosen);
    harness.run_steps(2);
    harness.get_by_label("a = 2");
}

/// As a light below the horizon: its call is made, and ends before it has evaluated anything.
#[test]
fn a_call_that_returns_early_says_so() {
    let [one, two] = ["shade > add_light [light 1]", "shade > add_light [light 2]"];
    let events = vec![
        called(one, 3, Act::Store, "a", &[2.0]),
        called(one, 5, Act::Store, "a", &[4.0]),
        called(two, 3, Act::Store, "a", &[2.0]),
        called(two, 4, Act::Leave, "", &[]),
    ];
    let mut harness = window(TEXT, events, &[3, 4, 5]);
    harness.get_by_label("return");
    harness.get_by_label("Call").click();
    harness.run_steps(2);
    harness.get_by_label(one);
    // Beside the line, and beside the call.
    assert_eq!(harness.query_all_by_label("a = 4").count(), 2);
    harness.get_by_label("shade > add_light [light 2], returns early").click();
    harness.run_steps(2);
    let chosen = Choice { call: Some(two.to_owned()), ..Choice::default() };
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
