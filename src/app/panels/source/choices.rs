//! Which fragment, call, round and time of the traced pixel is shown.

use egui::{Color32, ComboBox, RichText, Sense, Stroke, Ui, vec2};

use crate::app::command::source::CHOOSE_TRACE;
use crate::app::commands::Commands;
use crate::app::state::trace::Traces;
use crate::app::state::trace::choice::{Choice, ListedCall, calls, listed_calls, most_times};
use crate::app::state::trace::rounds::{Round, TracedLoop, traced_loops};
use crate::app::widgets::plural;
use crate::app::widgets::spoken::named;
use crate::app::widgets::theme::{CODE_VALUE, QUIET, small_mono};
use crate::shader::trace::{Act, Event, Trace, TracedLight, last_call};

/// Points by which a call stands to the right of its caller, and a round of its loop.
const INDENT: f32 = 12.0;
/// Height of the list of files, points.
pub(super) const MENU: f32 = 380.0;
/// Width of the list of calls, points.
const CALLS: f32 = 170.0;
/// Width of the list of rounds, points.
const ROUNDS: f32 = 120.0;
const ALL_ROUNDS: &str = "All rounds, in order";

/// The choices that a fragment offers. A log may have thousands of events, so they are looked for once for each trace and choice.
#[derive(Default)]
pub(super) struct Offers {
    /// How many calls have statements of the file.
    calls: usize,
    /// How often the statement ran that ran most often in the chosen call and round.
    times: usize,
    loops: Vec<TracedLoop>,
}

impl Offers {
    /// Those of the newest trace. `most`: how often the statement ran that ran most often in the choice.
    pub(super) fn new(traces: &Traces, most: usize) -> Self {
        let (Some(newest), Some(fragment)) = (traces.newest(), traces.fragment()) else { return Self::default() };
        let (Ok(trace), text, now) = (&newest.trace, newest.text(), &traces.choice) else { return Self::default() };
        let runs_again = |event: &Event| event.time > 1 && event.doing.act == Act::Condition;
        let loops = match trace.fragments[fragment].events.iter().any(runs_again) {
            true => traced_loops(trace, fragment, &text, now.call_of(trace, fragment)),
            false => Vec::new(),
        };
        let times = if now.time.is_some() { most_times(now, trace, &text) } else { most };
        Self { calls: calls(trace, fragment).len(), times, loops }
    }
}

/// Shows the fragment, the call, the round and the time, where there is a choice.
pub(super) fn show(
    ui: &mut Ui,
    now: &Choice,
    (trace, offers): (&Trace, &Offers),
    fragment: usize,
    commands: &mut Commands,
) {
    let Offers { calls, times, loops } = offers;
    let has_rounds = now.round.is_some() || loops.iter().any(|of| of.rounds.len() > 1);
    let has =
        [trace.fragments.len() > 1, *calls > 1 || now.call.is_some(), has_rounds, *times > 1 || now.time.is_some()];
    if has == [false; 4] {
        return;
    }
    let mut choice = now.clone();
    if has[0] {
        choose_fragment(ui, &mut choice, trace, fragment);
    }
    if has[1] {
        choose_call(ui, &mut choice, *calls, (trace, fragment));
    }
    if has[2] {
        choose_round(ui, &mut choice, loops);
    }
    if has[3] {
        choose_time(ui, &mut choice, *times);
    }
    if choice != *now {
        commands.push(CHOOSE_TRACE.with(choice));
    }
}

fn choose_fragment(ui: &mut Ui, choice: &mut Choice, trace: &Trace, fragment: usize) {
    let name = |at: usize| trace.name_of(at);
    // Its depth, samples and primitive would leave no room for the other lists.
    let whole = name(fragment);
    let short = whole.split(", depth").next().unwrap_or_default();
    let list = ComboBox::from_id_salt("fragment").selected_text(RichText::new(short).small());
    let list = list.show_ui(ui, |ui| {
        ui.set_min_width(MENU);
        for at in 0..trace.fragments.len() {
            if ui.selectable_label(at == fragment, name(at)).clicked() {
                choice.fragment = Some(at);
            }
        }
    });
    let hint = "The surfaces that were drawn at this pixel, the nearest first; of a vertex stage, the corners of the triangle there";
    named(list.response, "Fragment").on_hover_text(format!("{whole}\n{hint}"));
}

/// `count`: calls with statements of the file.
fn choose_call(ui: &mut Ui, choice: &mut Choice, count: usize, (trace, fragment): (&Trace, usize)) {
    let all = format!("All {}, in order", plural(count, "call"));
    let now = choice.call.clone();
    let shown = now.as_deref().map_or_else(|| all.clone(), |call| format!("Only {}", last_call(call).0));
    let list = ComboBox::from_id_salt("call").selected_text(RichText::new(shown).small()).width(CALLS).height(MENU);
    let list = list.truncate().show_ui(ui, |ui| {
        ui.set_min_width(MENU);
        ui.selectable_value(&mut choice.call, None, &all);
        for call in listed_calls(trace, fragment) {
            let light = call.light.and_then(|light| trace.lights.get(light));
            if call_row(ui, &call, light, now.as_deref() == Some(&call.path)) {
                choice.call = Some(call.path);
            }
        }
    });
    let hint = match now {
        None => {
            "Each line shows its values of all these calls, one behind the other: `1, 5 ×2` is 1 in the first call and 5 in the second. \
             Choose a call to see its values alone"
                .to_owned()
        }
        Some(call) => format!("{call}\nThe values of this call alone, of the calls that led to it, and of those that it makes"),
    };
    named(list.response, "Call").on_hover_text(hint);
}

/// A call in the list, indented below its caller, with the light that it is about. Returns whether it was clicked.
fn call_row(ui: &mut Ui, call: &ListedCall, light: Option<&TracedLight>, is_chosen: bool) -> bool {
    let row = ui.horizontal(|ui| {
        ui.add_space(INDENT * call.depth as f32);
        let end = if call.is_cut { ", returns early" } else { "" };
        let button = ui.selectable_label(is_chosen, small_mono(format!("{}{end}", call.name)));
        if let Some(light) = light {
            let (area, _) = ui.allocate_exact_size(vec2(9.0, 9.0), Sense::hover());
            ui.painter().circle(area.center(), 4.0, light_color(light), Stroke::new(1.0, QUIET));
            ui.label(RichText::new(light.text()).small().color(QUIET));
        }
        if !call.last.is_empty() && !call.is_cut {
            ui.label(RichText::new(&call.last).small().color(CODE_VALUE.color()));
        }
        named(button, &format!("{}{end}", call.path)).clicked()
    });
    row.inner
}

/// The color of a light on the display, as bright as it can be.
fn light_color(light: &TracedLight) -> Color32 {
    let most = light.intensity.into_iter().fold(f32::MIN_POSITIVE, f32::max);
    let [r, g, b] = light.intensity.map(|channel| ((channel / most).clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0) as u8);
    Color32::from_rgb(r, g, b)
}

/// The rounds stand below their loops.
fn choose_round(ui: &mut Ui, choice: &mut Choice, loops: &[TracedLoop]) {
    let all = || loops.iter().flat_map(|of| of.rounds.iter().map(|round| (of.line, round)));
    let is_chosen = |line: u32, number: u32| choice.round == Some(Round { line, number });
    let chosen = all().find(|(line, (number, _))| is_chosen(*line, *number));
    let text = chosen.map_or(ALL_ROUNDS, |(_, (_, label))| label.as_str());
    let list = ComboBox::from_id_salt("round").selected_text(small_mono(text)).width(ROUNDS).height(MENU);
    let mut round = choice.round;
    let list = list.truncate().show_ui(ui, |ui| {
        ui.set_min_width(ROUNDS);
        ui.selectable_value(&mut round, None, ALL_ROUNDS);
        for of in loops {
            ui.label(RichText::new(format!("{}: {}", of.line, of.code)).small().color(QUIET));
            for (number, label) in &of.rounds {
                ui.horizontal(|ui| {
                    ui.add_space(INDENT);
                    let of_round = Some(Round { line: of.line, number: *number });
                    ui.selectable_value(&mut round, of_round, small_mono(label));
                });
            }
        }
    });
    choice.round = round;
    named(list.response, "Round").on_hover_text(
        "One round of a loop: its values, and those of everything outside of the loop. Of a long loop, the first and the last rounds are there",
    );
}

fn choose_time(ui: &mut Ui, choice: &mut Choice, times: usize) {
    let mut time = choice.time.unwrap_or(0);
    let most = times.max(time);
    let text = |number: f64, _: std::ops::RangeInclusive<usize>| match number {
        0.0 => format!("All {most} times"),
        number => format!("Time {number:.0} of {most}"),
    };
    let parse = |text: &str| match text.trim().to_lowercase().starts_with("all") {
        true => Some(0.0),
        false => text.split_whitespace().find_map(|word| word.parse().ok()),
    };
    let drag = egui::DragValue::new(&mut time).range(0..=most).speed(0.1);
    let drag = ui.add(drag.custom_formatter(text).custom_parser(parse));
    named(drag, "Time").on_hover_text(
        "Of a statement that ran more than once in the chosen call, as in a loop: which time. Drag, or type a number",
    );
    choice.time = (time > 0).then_some(time);
}

#[cfg(test)]
mod tests {
    use egui_kittest::kittest::Queryable as _;

    use super::super::tests::window;
    use super::*;
    use crate::shader::trace::sample::{called, event};

    #[test]
    fn the_choice_of_calls_says_which_values_are_shown() {
        let text = "float f(float x) {\n    return x + 1.0;\n}\n";
        let of_call =
            |number: u32| called(&format!("f [call {number} of main]"), 2, Act::Return, "", &[number as f32 + 1.0]);
        let mut harness = window(text, vec![of_call(1), of_call(2)], &[2]);
        harness.get_by_label_contains("2, 3 ×2");
        harness.get_by_value("All 2 calls, in order");
        harness.state_mut().state.traces.choice.call = Some("f [call 2 of main]".to_owned());
        harness.run_steps(2);
        harness.get_by_value("Only f [call 2 of main]");
        harness.get_by_label_contains("return 3");
    }

    #[test]
    fn a_round_of_a_loop_is_chosen_by_its_variable() {
        let text = "float f(float x) {\n    for (int i = 0; i < 2; i++)\n        x += 1.0;\n    return x;\n}\n";
        let mut events = Vec::new();
        for round in [0.0, 1.0, 2.0] {
            events.push(event(2, Act::Store, "i", &[round]));
            events.push(event(2, Act::Condition, "", &[f32::from(round < 2.0)]));
            events.push(event(if round < 2.0 { 3 } else { 4 }, Act::Store, "x", &[10.0 + round]));
        }
        let mut harness = window(text, events, &[2, 3, 4]);
        harness.get_by_label("x = 10, 11 ×2");
        harness.get_by_label("Round").click();
        harness.run_steps(2);
        harness.get_by_label("2: for (int i = 0; i < 2; i++)");
        harness.get_by_label("i = 1").click();
        harness.run_steps(2);
        let chosen = Choice { round: Some(Round { line: 2, number: 2 }), ..Choice::default() };
        assert_eq!(harness.state().asked, [CHOOSE_TRACE.with(chosen.clone())]);
        harness.state_mut().state.traces.choice = chosen;
        harness.run_steps(2);
        harness.get_by_label("x = 11");
    }
}
