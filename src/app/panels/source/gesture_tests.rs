//! Folding, dragged numbers and hover texts of the panel, without a device.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::tests::{TEXT, Window, events, labels, window};
use crate::app::state::shaders::edits::Draft;
use crate::shader::rewrite::Edit;
use crate::shader::trace::sample::{event, trace};
use crate::shader::trace::{Act, Neighborhood};

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
