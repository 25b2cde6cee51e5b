//! Folding, dragged numbers, clicks, colors and hover texts of the panel, without a device.

use std::sync::Arc;

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::tests::{TEXT, Window, events, labels, window};
use crate::app::state::costs::{Question, WantedCosts};
use crate::app::state::shaders::edits::Draft;
use crate::app::state::trace::sample;
use crate::app::widgets::theme::ERROR;
use crate::headless::{FunctionCost, StageCosts};
use crate::pipeline::Figure;
use crate::shader::costs::{Calls, NamedFunction};
use crate::shader::library::{Change, Library, Update};
use crate::shader::rewrite::Edit;
use crate::shader::trace::sample::{event, trace};
use crate::shader::trace::{Act, Neighborhood};
use crate::shader::{Compiler, Source};
use crate::statistics::{Difference, Verdict};

fn has(harness: &Harness<'_, Window>, text: &str) -> bool {
    labels(harness).iter().any(|label| label.contains(text))
}

#[test]
fn a_folded_function_shows_its_first_line_and_what_it_returns() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    assert!(has(&harness, "3:     float a"));
    harness.get_by_role_and_label(Role::Button, "Fold f").click();
    harness.run_steps(3);
    assert!(!has(&harness, "3:     float a") && !has(&harness, "7: }"), "{:?}", labels(&harness));
    for text in ["2: float f(float x) {", "x = 1", "return 2"] {
        harness.get_by_label(text);
    }
    assert!(!has(&harness, "a = 2"));
    // The search opens what it finds.
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::F);
    harness.run_steps(2);
    harness.get_by_label("Find in the file").type_text("a > 3");
    harness.run_steps(4);
    assert!(has(&harness, "4:     if (a > 3.0)"));
    harness.get_by_role_and_label(Role::Button, "Fold f");
}

#[test]
fn functions_that_the_pixel_does_not_reach_are_folded_together() {
    let text = format!("{TEXT}float g(float x) {{\n    return x * 7.0;\n}}\n");
    let mut harness = window(&text, events(2.0), &[2, 3, 4, 5, 6, 8, 9]);
    assert!(has(&harness, "return x * 7.0"));
    harness.get_by_role_and_label(Role::Button, "Fold").click();
    harness.run_steps(2);
    harness.get_by_label("Functions that the pixel does not reach").click();
    harness.run_steps(3);
    assert!(!has(&harness, "return x * 7.0") && has(&harness, "3:     float a"));
    harness.get_by_role_and_label(Role::Button, "Open g");
    harness.get_by_role_and_label(Role::Button, "Fold f");
    assert!(harness.state().asked.is_empty());
}

#[test]
fn a_dragged_number_is_drafted_and_not_written() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    let from = harness.get_by_role_and_label(Role::Button, "Drag 2.0").rect().center();
    harness.drag_at(from);
    harness.run_steps(2);
    for step in 1..=5 {
        harness.hover_at(from + vec2(20.0 * step as f32, 0.0));
        harness.run_steps(1);
    }
    harness.drop_at(from + vec2(100.0, 0.0));
    harness.run_steps(2);
    let asked: Vec<String> = harness.state().asked.iter().map(|command| format!("{command:?}")).collect();
    let last = asked.last().expect("a draft");
    assert!(asked.iter().all(|command| command.starts_with("draft ")), "{asked:?}");
    assert!(last.contains("new: \"3.0\"") && last.contains("line: 3") && last.contains("2.0"), "{last}");
}

#[test]
fn numbers_of_another_line_wait_until_the_dragged_ones_are_written() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    let before = "    float a = x * 2.0;".to_owned();
    let edit =
        Edit { path: "a.glsl".into(), name: "2.0".into(), line: 3, bytes: 18..21, before, new: "2.5".to_owned() };
    let draft = Draft { edits: vec![edit], path: "a.glsl".into(), line: 3, base: TEXT.into() };
    harness.state_mut().state.edits.draft = Some(draft);
    harness.run_steps(2);
    harness.get_by_label_contains("a.glsl:3  2.0 -> 2.5");
    let of_other = harness.query_all_by_label("Drag 3.0").next().expect("a number of line 4").rect();
    let center = of_other.center();
    harness.drag_at(center);
    harness.hover_at(center + vec2(60.0, 0.0));
    harness.run_steps(2);
    harness.drop_at(center + vec2(60.0, 0.0));
    harness.run_steps(2);
    assert!(harness.state().asked.is_empty(), "{:?}", harness.state().asked);
    harness.get_by_role_and_label(Role::Button, "Cancel").click();
    harness.run_steps(2);
    assert_eq!(format!("{:?}", harness.state().asked), "[draft []]");
}

#[test]
fn the_hover_text_of_a_value_shows_it_around_the_pixel() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    harness.get_by_label("a = 2").hover();
    harness.run_steps(40);
    assert!(has(&harness, "Tracing the pixels around it"), "{:?}", labels(&harness));
    let newest = harness.state().state.traces.lacks_around().expect("nothing was asked for yet");
    let traces = &mut harness.state_mut().state.traces;
    traces.around.ask(&newest, 9);
    let around = Neighborhood::new((3, 4), (64, 48), "a.glsl", |at| {
        let value = event(3, Act::Store, "a", &[at.0 as f32]);
        Ok::<_, ()>((at.1 > 0).then(|| trace(vec![value], &[3])))
    });
    // The mouse leaves, and comes back.
    assert!(traces.around.leave() && !traces.around.leave() && traces.lacks_around().is_some());
    traces.around.take(9, Err("of a hover that has ended".to_owned()));
    traces.around.ask(&newest, 9);
    traces.around.take(8, Err("of an older request".to_owned()));
    traces.around.take(9, Ok(around.unwrap()));
    assert!(traces.lacks_around().is_none());
    harness.run_steps(3);
    assert!(has(&harness, "8x8 pixels around it, black 0 to white 7; not computed at 8"), "{:?}", labels(&harness));
}

#[test]
fn the_hover_text_of_a_value_has_what_the_author_wrote_about_it() {
    let text = TEXT.replace("float a = x * 2.0;", "float a = x * 2.0; // twice the size");
    let mut harness = window(&text, events(2.0), &[2, 3, 4, 5, 6]);
    harness.get_by_label("a = 2").hover();
    harness.run_steps(40);
    for part in ["float a", "twice the size", "40000000", "a.glsl:3"] {
        assert!(has(&harness, part), "no {part} in {:?}", labels(&harness));
    }
}

#[test]
fn a_click_on_a_value_shows_it_over_the_model() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    harness.get_by_label("a = 2").click();
    harness.run_steps(2);
    assert!(harness.state().set.is_none(), "no pass of these shaders shows the file");
    let files = [
        ("fullscreen.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n"),
        ("pbr.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n"),
        (
            "tonemap.frag",
            "//@pass tonemap to=display\n#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n",
        ),
        (
            "pbr.frag",
            "//@pass model draw=model to=picture\n#version 460\n#include \"a.glsl\"\nlayout(location = 0) out vec4 color;\n\
            void main() { color = vec4(f(1.0)); }\n",
        ),
        ("a.glsl", TEXT),
        ("b.glsl", "float g;\n"),
    ];
    let compiler = Arc::new(Compiler::new().unwrap());
    let update = Library::new(Source::memory(files), compiler, &["fullscreen.vert", "pbr.vert"]).update(&Change::All);
    let Update::Ready(shaders, _) = update else { panic!("{update:?}") };
    let state = &mut harness.state_mut().state;
    sample::add_trace(&mut state.traces, &shaders, shaders.generation, trace(events(2.0), &[2, 3, 4, 5, 6]));
    state.session.shaders = Some(shaders);
    harness.run_steps(3);
    for (value, at) in [("a = 2", "a.glsl:3:a"), ("return 2", "a.glsl:6:return"), ("x = 1", "a.glsl:2:x")] {
        harness.get_by_label(value).click();
        harness.run_steps(2);
        let set = harness.state_mut().set.take().unwrap_or_else(|| panic!("{value}: nothing was set"));
        assert_eq!((set.mode.as_str(), set.expression.at.as_str()), ("expression", at));
    }
    // A decision is no value.
    harness.get_by_label("not taken").click();
    harness.run_steps(2);
    assert!(harness.state().set.is_none());
    // Beside a line that is typed, too, where the text lies below.
    let state = &mut harness.state_mut().state;
    (state.source, state.shader.in_use) = (Source::disk("tree"), Some("tree".into()));
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Edit").click();
    harness.run_steps(3);
    harness.get_by_label("a = 2").click();
    harness.run_steps(2);
    let set = harness.state_mut().set.take().expect("nothing was set beside the typed text");
    assert_eq!(set.expression.at, "a.glsl:3:a");
}

#[test]
fn the_cost_of_a_function_stands_beside_its_first_line() {
    let mut harness = window(TEXT, events(2.0), &[2, 3, 4, 5, 6]);
    let difference = Difference {
        base_ms: 2.0,
        change_ms: -0.5,
        margin_ms: 0.04,
        confidence: 0.99,
        pairs: 24,
        verdict: Verdict::Faster,
    };
    let registers = Figure { name: "registers".into(), meaning: String::new(), value: 40.0, before: Some(64.0) };
    let cost = |difference| FunctionCost {
        function: NamedFunction { signature: "f(float)".into(), file: "a.glsl".into(), line: 2 },
        calls: Calls { calls: 30, invocations: 10 },
        difference,
        figures: vec![registers.clone()],
    };
    let mut measured = |number: u64, difference| {
        let state = &mut harness.state_mut().state;
        let picture = sample::subject(state.session.shaders.as_ref().unwrap()).picture;
        let functions = vec![cost(difference)];
        let costs = StageCosts {
            stage: "a.frag".into(),
            stage_ms: 1.5,
            frame_ms: 2.0,
            invocations: 10,
            functions,
            left_out: Vec::new(),
        };
        state.costs.ask(picture, Question::Functions(WantedCosts::default()), number);
        assert!(state.costs.take_functions(number, Ok(Arc::new(costs))));
        harness.run_steps(2);
        labels(&harness).into_iter().filter(|label| label.starts_with("costs ")).collect::<Vec<_>>()
    };
    let same = Difference { verdict: Verdict::Same, change_ms: -0.01, ..difference };
    assert_eq!(measured(1, same), ["costs < 0.050 ms"]);
    assert_eq!(measured(2, difference), ["costs 0.500 ms ± 0.040 · 25.0 % of the frame"]);
    let [line, cost] = ["2: float f(float x) {", "costs 0.500 ms"].map(|of| harness.get_by_label_contains(of).rect());
    assert!(line.y_range().contains(cost.center().y) && cost.left() > line.left() + 100.0, "{line} {cost}");
    harness.get_by_label_contains("costs 0.500 ms").hover();
    harness.run_steps(40);
    for part in ["without f(float): 24 pairs", "3.00 calls", "registers: 64 with it, 40 without"] {
        assert!(has(&harness, part), "no {part} in {:?}", labels(&harness));
    }
}

#[test]
fn values_that_are_no_numbers_are_red() {
    for (number, text, is_red) in
        [(f32::NAN, "a = NaN", true), (f32::NEG_INFINITY, "a = -Inf", true), (2.0, "a = 2", false)]
    {
        let harness = window(TEXT, vec![event(3, Act::Store, "a", &[number])], &[3]);
        harness.get_by_label(text);
        let colors = harness.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
            egui::Shape::Text(of) if of.galley.text() == text => {
                of.galley.job.sections.last().map(|of| of.format.color)
            }
            _ => None,
        });
        let colors: Vec<egui::Color32> = colors.collect();
        assert!(!colors.is_empty(), "{text} is not seen");
        assert!(colors.iter().all(|color| (*color == ERROR.color()) == is_red), "{text}: {colors:?}");
    }
}

/// The rectangles in which texts that begin so are seen.
fn seen(harness: &Harness<'_, Window>, start: &str) -> Vec<egui::Rect> {
    let text = |clipped: &egui::epaint::ClippedShape| match &clipped.shape {
        egui::Shape::Text(text) if text.galley.text().starts_with(start) => {
            Some(text.galley.rect.translate(text.pos.to_vec2()).intersect(clipped.clip_rect))
        }
        _ => None,
    };
    harness.output().shapes.iter().filter_map(text).collect()
}

#[test]
fn values_never_cover_code() {
    let long = format!("float f(float x) {{ // {}", "a head that is longer than the panel ".repeat(5));
    let store = format!("    float a = x * 2.0;{} // end", " ".repeat(60));
    let text = TEXT.replace("float f(float x) {", &long).replace("    float a = x * 2.0;", &store);
    let mut all = events(2.0);
    all.extend((0..9).map(|at| event(2, Act::Argument, &format!("argument_{at}"), &[at as f32, 0.123_456, 7.0])));
    let harness = window(&text, all, &[2, 3, 4, 5, 6]);
    for (code, values) in
        [("float f(float x)", "x = 1"), ("    float a = x * 2.0;", "a = 2"), ("    if (a", "not taken")]
    {
        let (code, values) = (seen(&harness, code), seen(&harness, values));
        let [code, value] = [&code, &values].map(|all| *all.first().expect("it is seen"));
        assert!(code.width() > 60.0 && code.right() < value.left(), "{code} {value}");
    }
    let arguments: Vec<egui::Rect> = (0..9).flat_map(|at| seen(&harness, &format!("argument_{at}"))).collect();
    assert!(arguments.len() < 9 && arguments.iter().all(|argument| argument.right() < 900.0), "{arguments:?}");
    // The whole line is told where it is cut.
    assert_eq!(seen(&harness, "…").len(), 1, "the long head alone is cut");
}

#[test]
fn a_name_leads_to_its_definition_while_ctrl_is_held() {
    let text = format!("{TEXT}float g(float x) {{\n    return f(x);\n}}\n");
    let mut harness = window(&text, events(2.0), &[2, 3, 4, 5, 6, 8, 9]);
    let line = harness.get_by_label("9:     return f(x);").rect();
    assert!(harness.query_by_label("Go to f").is_none());
    harness.hover_at(line.left_center() + vec2(80.0, 0.0));
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::COMMAND));
    harness.run_steps(2);
    harness.get_by_label("Go to f").click();
    harness.run_steps(2);
    let asked = format!("{:?}", harness.state().asked);
    assert!(asked.contains("show-line") && asked.contains("a.glsl") && asked.contains("line: 2"), "{asked}");
}
