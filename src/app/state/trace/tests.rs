//! Traces of two versions, as rows.

use std::collections::BTreeMap;

use super::choice::evaluations;
use super::rounds::Round;
use super::rows::Reach;
use super::sample::{add, subject};
use super::*;
use crate::shader::trace::sample::{called, event, trace};
use crate::shader::trace::{Act, Doing, Event};

const OLD: &str = "float f(float x) {\n    float a = x * 2.0;\n    if (a > 3.0)\n        a = 3.0;\n    return a;\n}\n";
const NEW: &str = "float f(float x) {\n    float b = 1.0;\n    float a = x * 4.0;\n    if (a > 3.0)\n        a = 3.0;\n    return a;\n}\n";

fn shaders(generation: u64, text: &str) -> Arc<ShaderSet> {
    let texts = BTreeMap::from([(TreePath::from("a.glsl"), Arc::<str>::from(text))]);
    Arc::new(ShaderSet { generation, texts, ..ShaderSet::default() })
}

fn old_events() -> Vec<Event> {
    vec![
        event(1, Act::Argument, "x", &[1.0]),
        event(2, Act::Store, "a", &[2.0]),
        event(3, Act::Condition, "", &[0.0]),
        event(5, Act::Return, "", &[2.0]),
    ]
}

fn new_events() -> Vec<Event> {
    vec![
        event(1, Act::Argument, "x", &[1.0]),
        event(2, Act::Store, "b", &[1.0]),
        event(3, Act::Store, "a", &[4.0]),
        event(4, Act::Condition, "", &[1.0]),
        event(5, Act::Store, "a", &[3.0]),
        event(6, Act::Return, "", &[3.0]),
    ]
}

fn texts(traces: &Traces, text: &str) -> Vec<String> {
    let rows = traces.rows(&"a.glsl".into(), text);
    rows.iter().map(|row| row.notes.iter().map(rows::Note::text).collect::<Vec<_>>().join("; ")).collect()
}

#[test]
fn a_save_shows_old_and_new_values_on_lines_that_moved() {
    let mut traces = Traces::default();
    add(&mut traces, &shaders(1, OLD), 1, old_events(), &[1, 2, 3, 4, 5]);
    assert_eq!(texts(&traces, OLD), ["x = 1", "a = 2", "not taken", "", "return 2", ""]);
    let reach: Vec<Reach> = traces.rows(&"a.glsl".into(), OLD).iter().map(|row| row.reach).collect();
    use Reach::{Missed, Reached, Unknown};
    assert_eq!(reach, [Reached, Reached, Reached, Missed, Reached, Unknown]);

    add(&mut traces, &shaders(2, NEW), 2, new_events(), &[1, 2, 3, 4, 5, 6]);
    let expected = ["x = 1", "new: b = 1", "a = 2 → 4", "not taken → taken", "a = 3", "return 2 → 3", ""];
    assert_eq!(texts(&traces, NEW), expected);
    let rows = traces.rows(&"a.glsl".into(), NEW);
    let first: Vec<u32> = rows.iter().filter(|row| row.is_first_change).map(|row| row.line).collect();
    assert_eq!(first, [2], "the first line that is new or differs");
    let changed = traces.json().unwrap()["changed"].clone();
    assert_eq!(
        changed[0],
        json!({ "line": 2, "name": "b", "act": "store", "before": null, "now": "1", "first": true })
    );
    assert_eq!(
        changed[1],
        json!({ "line": 3, "name": "a", "act": "store", "before": "2", "now": "4", "first": false })
    );
    assert_eq!(changed.as_array().unwrap().len(), 4);

    // While a later edit does not compile, the values stay beside the lines that they belong to.
    let broken = format!("// more\n{NEW}");
    assert_eq!(texts(&traces, &broken)[3], "a = 2 → 4");
}

#[test]
fn another_pixel_has_no_version_before() {
    let mut traces = Traces::default();
    add(&mut traces, &shaders(1, OLD), 1, old_events(), &[1]);
    let newest = shaders(2, NEW);
    assert!(!traces.lacks_before(&subject(&newest)), "the last trace is the version before");
    let other = Subject { at: [9, 9], ..subject(&newest) };
    assert!(traces.lacks_before(&other));
    traces.ask(other, 2, false);
    let names = || TracedPlace { stage: "a.frag".to_owned(), file: "a.glsl".to_owned(), ..TracedPlace::default() };
    assert!(traces.take(2, names(), Ok(trace(new_events(), &[1]))));
    assert!(traces.before().is_none());
    // The thread traces it, too.
    traces.take_before(1, Some((shaders(1, OLD), trace(old_events(), &[1]))));
    assert!(traces.before().is_none(), "an answer to an older request");
    traces.take_before(2, Some((shaders(1, OLD), trace(old_events(), &[1]))));
    assert_eq!(texts(&traces, NEW)[2], "a = 2 → 4");
    // A result that is not awaited any more is none.
    assert!(!traces.take(1, names(), Ok(trace(old_events(), &[1]))));
}

#[test]
fn the_same_texts_are_one_version() {
    let mut traces = Traces::default();
    add(&mut traces, &shaders(1, OLD), 1, old_events(), &[1]);
    add(&mut traces, &shaders(2, NEW), 2, new_events(), &[1]);
    // Another expression is watched: a generation, but no version.
    add(&mut traces, &shaders(3, NEW), 3, new_events(), &[1]);
    assert_eq!(texts(&traces, NEW)[2], "a = 2 → 4");
}

#[test]
fn a_call_and_a_time_choose_values() {
    let mut traces = Traces::default();
    let text = "float f(float x) {\n    for (int i = 0; i < 2; i++)\n        x += 1.0;\n    return x;\n}\n";
    let mut events = Vec::new();
    for (calls, x) in [("main > f", 1.0), ("main > f [2]", 5.0)] {
        events.push(called(calls, 1, Act::Argument, "x", &[x]));
        for more in [1.0, 2.0] {
            events.push(called(calls, 2, Act::Condition, "", &[1.0]));
            events.push(called(calls, 3, Act::Store, "x", &[x + more]));
        }
        events.push(called(calls, 2, Act::Condition, "", &[0.0]));
        events.push(called(calls, 4, Act::Return, "", &[f32::NAN]));
    }
    add(&mut traces, &shaders(1, text), 1, events, &[1, 2, 3, 4]);
    assert_eq!(texts(&traces, text)[..3], ["x = 1, 5 ×2", "4 rounds", "x = 2, 3, …, 7 ×4"]);
    traces.choice.call = Some("main > f [2]".to_owned());
    assert_eq!(texts(&traces, text)[..3], ["x = 5", "2 rounds", "x = 6, 7 ×2"]);
    traces.choice.time = Some(2);
    assert_eq!(texts(&traces, text)[..3], ["", "1 round", "x = 7"]);
    let rows = traces.rows(&"a.glsl".into(), text);
    assert_eq!(rows[0].reach, Reach::Missed);
    traces.choice.time = None;
    assert!(traces.rows(&"a.glsl".into(), text)[3].notes[0].is_bad);
    // A call that the next trace does not have counts no more.
    traces.choice.call = Some("other".to_owned());
    assert_eq!(texts(&traces, text)[0], "x = 1, 5 ×2");
}

#[test]
fn evaluations_of_an_expression_are_in_the_order_of_their_calls() {
    let events = vec![
        called("f", 1, Act::Argument, "x", &[1.0]),
        called("f", 2, Act::Store, "a", &[2.0]),
        called("f", 2, Act::Store, "b", &[9.0]),
        called("f [2]", 1, Act::Argument, "x", &[3.0]),
        called("f [2]", 2, Act::Store, "a", &[4.0]),
        called("f [2]", 3, Act::Condition, "", &[1.0]),
        called("f [2]", 4, Act::Return, "", &[5.0]),
    ];
    let trace = trace(events, &[1, 2, 3, 4]);
    let of = |line, name| {
        let found = evaluations(&trace, 0, ("a.glsl", line), name);
        found.iter().map(|(_, event)| format!("{} {}", event.calls, event.value.unwrap().text())).collect::<Vec<_>>()
    };
    assert_eq!(of(2, "a"), ["f 2", "f [2] 4"]);
    assert_eq!(of(1, "x"), ["f 1", "f [2] 3"]);
    assert_eq!(of(4, "return"), ["f [2] 5"]);
    assert!(of(3, "").is_empty() && of(9, "a").is_empty());
}

#[test]
fn a_round_of_a_loop_is_chosen() {
    let mut traces = Traces::default();
    let text = "float f(float x) {\n    for (int i = 0; i < 2; i++)\n        x += 1.0;\n    return x;\n}\n";
    let events = |step: f32| {
        let mut events = vec![event(1, Act::Argument, "x", &[1.0])];
        for round in [0.0, 1.0, 2.0] {
            events.push(event(2, Act::Store, "i", &[round]));
            events.push(event(2, Act::Condition, "", &[f32::from(round < 2.0)]));
            if round < 2.0 {
                events.push(event(3, Act::Store, "x", &[1.0 + step * (round + 1.0)]));
            }
        }
        events.push(event(4, Act::Return, "", &[1.0 + 2.0 * step]));
        events
    };
    add(&mut traces, &shaders(1, text), 1, events(1.0), &[1, 2, 3, 4]);
    assert_eq!(texts(&traces, text)[..4], ["x = 1", "i = 0, 1, 2 ×3; 2 rounds", "x = 2, 3 ×2", "return 3"]);
    traces.choice.round = Some(Round { line: 2, number: 2 });
    assert_eq!(texts(&traces, text)[..4], ["x = 1", "i = 1; 1 round", "x = 3", "return 3"]);
    let done = traces.rows(&"a.glsl".into(), text)[2].notes[0].done.clone();
    assert_eq!((done.first[0].time, traces.choice.evaluation(&done)), (2, 2));
    // The version before has the same round, where its loop stands one line higher.
    let moved = format!("// A comment.\n{}", text.replace("1.0;", "2.0;"));
    let below = |event: Event| {
        let doing = Doing { line: event.doing.line + 1, ..Doing::clone(&event.doing) };
        Event { doing: doing.into(), ..event }
    };
    add(&mut traces, &shaders(2, &moved), 2, events(2.0).into_iter().map(below).collect(), &[2, 3, 4, 5]);
    traces.choice.round = Some(Round { line: 3, number: 2 });
    let expected = ["", "x = 1", "i = 1; 1 round", "x = 3 → 5", "return 3 → 5"];
    assert_eq!(texts(&traces, &moved)[..5], expected);
    // A round that the trace does not have counts no more.
    traces.choice.round = Some(Round { line: 4, number: 2 });
    assert_eq!(texts(&traces, &moved)[2], "i = 0, 1, 2 ×3; 2 rounds");
}

/// The log has the first and the last rounds of a long loop, in the second of three calls.
#[test]
fn times_count_rounds_that_were_not_logged() {
    let mut traces = Traces::default();
    let text = "float f(float x) {\n    for (int i = 0; i < 99; i++)\n        x += 1.0;\n    return x;\n}\n";
    let x = |calls: &str, time: u32| Event { time, ..called(calls, 3, Act::Store, "x", &[time as f32]) };
    let mut events = vec![x("f", 1), x("f", 2)];
    events.extend((3..=6).chain(96..=99).map(|time| x("f [2]", time)));
    events.push(x("f [3]", 100));
    add(&mut traces, &shaders(1, text), 1, events, &[2, 3, 4]);
    let trace = traces.newest().unwrap().trace.clone().unwrap();
    let (numbers, _): (Vec<u32>, Vec<&Event>) = evaluations(&trace, 0, ("a.glsl", 3), "x").into_iter().unzip();
    assert_eq!(numbers, [1, 2, 3, 4, 5, 6, 96, 97, 98, 99, 100]);
    let chosen = |traces: &mut Traces, call: Option<&str>, time: Option<usize>| {
        traces.choice = Choice { call: call.map(str::to_owned), time, ..Choice::default() };
        let done = traces.rows(&"a.glsl".into(), text)[2].notes.first().map(|note| note.done.clone());
        let evaluation = done.map(|done| traces.choice.evaluation(&done));
        (texts(traces, text)[2].clone(), evaluation)
    };
    let all = chosen(&mut traces, None, None);
    assert_eq!(all, ("x = 1, 2, …, 100 ×100 (89 of them not logged)".to_owned(), Some(0)));
    let call = chosen(&mut traces, Some("f [2]"), None);
    assert_eq!(call, ("x = 3, 4, …, 99 ×97 (89 of them not logged)".to_owned(), Some(99)));
    assert_eq!(chosen(&mut traces, Some("f [2]"), Some(97)), ("x = 99".to_owned(), Some(99)));
    assert_eq!(chosen(&mut traces, None, Some(97)), ("x = 97".to_owned(), Some(97)));
    assert_eq!(chosen(&mut traces, None, Some(50)), (String::new(), None), "that round was not logged");
    assert_eq!(chosen(&mut traces, Some("f [3]"), Some(1)), ("x = 100".to_owned(), Some(100)));
}

#[test]
fn lines_without_statements_are_dim_between_lines_that_are_missed() {
    let mut traces = Traces::default();
    let text = "a;\nif (x) {\n    b;\n    // why\n    c;\n}\nd;\n";
    add(
        &mut traces,
        &shaders(1, text),
        1,
        vec![
            event(1, Act::Store, "a", &[1.0]),
            event(2, Act::Condition, "", &[0.0]),
            event(7, Act::Store, "d", &[1.0]),
        ],
        &[1, 2, 3, 5, 7],
    );
    let reach: Vec<Reach> = traces.rows(&"a.glsl".into(), text).iter().map(|row| row.reach).collect();
    use Reach::{Missed, Reached, Unknown};
    assert_eq!(reach, [Reached, Reached, Missed, Missed, Missed, Unknown, Reached]);
}

#[test]
fn a_command_is_answered_with_the_trace_of_the_picture() {
    let mut traces = Traces::default();
    traces.expect();
    assert_eq!(traces.answer(), None);
    traces.progress = Progress::NoPixel;
    assert!(traces.answer().unwrap().unwrap_err().contains("no pixel is pinned"));
    traces.expect();
    (0..MOST_UNSEEN).for_each(|_| traces.unseen());
    assert_eq!(traces.answer(), None, "the panel is about to open");
    traces.unseen();
    assert!(traces.answer().unwrap().unwrap_err().contains("not in sight"));
    add(&mut traces, &shaders(1, OLD), 1, old_events(), &[1]);
    assert_eq!(traces.answer().unwrap().unwrap()["pixel"], json!([3, 4]));
    traces.ask(subject(&shaders(2, NEW)), 2, false);
    assert_eq!(traces.answer(), None);
    traces.fail("the trace failed");
    assert_eq!(traces.answer(), Some(Err("the trace failed".to_owned())));
    assert!(traces.before().is_some(), "the last good trace stays for the next save");
}

#[test]
fn a_result_that_comes_while_the_picture_is_not_final_counts_once_it_is() {
    for meanwhile in [Progress::Waits, Progress::Outside, Progress::NoPixel] {
        let mut traces = Traces::default();
        let newest = shaders(2, NEW);
        traces.ask(subject(&newest), 1, false);
        traces.progress = meanwhile;
        let names = || TracedPlace {
            stage: "a.frag".to_owned(),
            stages: Vec::new(),
            files: vec!["a.glsl".to_owned()],
            file: "a.glsl".to_owned(),
        };
        assert!(traces.take(1, names(), Ok(trace(new_events(), &[1]))), "{meanwhile:?}");
        assert_eq!(traces.progress, meanwhile, "the picture is not that of the trace yet");
        assert!(!traces.take(1, names(), Ok(trace(old_events(), &[1]))), "a result is taken once");
        traces.take_before(1, Some((shaders(1, OLD), trace(old_events(), &[1]))));
        traces.resume();
        assert_eq!(texts(&traces, NEW)[2], "a = 2 → 4", "{meanwhile:?}");
        assert_eq!(traces.progress, Progress::Done);
        assert_eq!(traces.answer().unwrap().unwrap()["pixel"], json!([3, 4]));
    }
    // Out of sight, nothing is asked for any more.
    let mut traces = Traces::default();
    traces.ask(subject(&shaders(1, OLD)), 1, false);
    traces.unseen();
    assert!(!traces.take(1, Default::default(), Ok(trace(old_events(), &[1]))));
}

#[test]
fn dragged_numbers_are_no_version_before_another() {
    let mut traces = Traces::default();
    let texts = [(1, "    float a = x * 2.0;"), (2, "    float a = x * 2.5;"), (3, "    float a = x * 3.0;")];
    for (generation, line) in texts {
        if generation > 1 {
            traces.drafted.insert(generation);
        }
        let value = 0.5 * generation as f32;
        let text = OLD.replacen("    float a = x * 2.0;", line, 1);
        add(&mut traces, &shaders(generation, &text), generation, vec![event(2, Act::Store, "a", &[value])], &[2]);
    }
    let before = traces.before().expect("the version of the file").of.picture.shaders.generation;
    assert_eq!(before, 1);
}

#[test]
fn there_are_no_values_without_a_pixel() {
    let mut traces = Traces::default();
    add(&mut traces, &shaders(1, OLD), 1, old_events(), &[1, 2, 3, 5]);
    let has_values = |traces: &Traces| texts(traces, OLD).iter().any(|text| !text.is_empty());
    assert!(has_values(&traces));
    traces.progress = Progress::NoPixel;
    assert!(!has_values(&traces));
}
