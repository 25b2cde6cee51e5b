//! By how much the version that is compared with, or the one before, is slower or faster than the newest: a line of the panel Timeline.

use egui::{Label, RichText, Ui};

use crate::app::state::State;
use crate::app::widgets::theme::{GOOD, QUIET, WARNING};
use crate::statistics::Verdict;

/// The meaning of the line.
const HINT: &str = "GPU time of the frame in both versions, drawn in turn while the window rests until the difference is significant: the \
    trimmed mean of the differences with Student's t, 99 % over all looks at them. Less than 0.5 % counts as no difference";

/// Shows the line, if there is a result.
pub(super) fn show(ui: &mut Ui, state: &State) {
    let generation = state.shown_generation();
    let chosen = state.compare.version().or_else(|| state.versions.before(generation).map(|version| version.number));
    let Some(version) = chosen.and_then(|number| state.versions.get(number)) else { return };
    let shaders = state.session.shaders.as_ref();
    let Some(difference) = shaders.and_then(|of| state.costs.of_version(of, version.number)) else { return };
    let (older_ms, newest_ms) = (difference.base_ms + difference.change_ms, difference.base_ms);
    let text = format!(
        "{} ({}): {}. {older_ms:.2} ms, now {newest_ms:.2} ms",
        version.number,
        version.since.format("%H:%M"),
        difference.text()
    );
    // Difference of the newest version.
    let color = match difference.verdict {
        Verdict::Slower => GOOD,
        Verdict::Faster => WARNING,
        Verdict::Same => QUIET,
    };
    ui.add(Label::new(RichText::new(text).small().color(color)).wrap()).on_hover_text(HINT);
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use egui_kittest::Harness;
    use egui_kittest::kittest::NodeT as _;

    use super::*;
    use crate::app::state::compare::With;
    use crate::app::state::costs::Question;
    use crate::app::state::trace::sample::subject;
    use crate::events::ReloadEvent;
    use crate::settings::Settings;
    use crate::shader::{ShaderSet, Source, TreePath};
    use crate::statistics::Difference;

    /// The texts of the line over a version that takes `change_ms` longer than the newest one, of which a frame takes 2 ms.
    fn line(change_ms: f64, verdict: Verdict) -> Vec<String> {
        let mut state = State::new(Settings::of_window(), Source::embedded());
        let shaders = [1, 2].map(|generation| {
            let texts = BTreeMap::from([(TreePath::from("a.glsl"), Arc::<str>::from(format!("// {generation}\n")))]);
            Arc::new(ShaderSet { generation, texts, ..ShaderSet::default() })
        });
        shaders.iter().for_each(|of| state.versions.add(of, ReloadEvent::default(), false));
        state.session.shaders = Some(shaders[1].clone());
        let difference = Difference { base_ms: 2.0, change_ms, margin_ms: 0.01, confidence: 0.99, pairs: 9, verdict };
        state.costs.ask(subject(&shaders[1]).picture, Question::Version(1), 5);
        assert_eq!(state.costs.take_version(5, Ok(difference)), Some(1));
        state.compare.set(Some(With::Version(1)));
        let since = state.versions.get(1).map(|version| version.since.format("%H:%M").to_string()).unwrap();
        let harness = Harness::builder().build_ui(|ui| show(ui, &state));
        let all = harness.root().children_recursive().filter_map(|node| node.accesskit_node().value());
        // A label has its text once more as a part.
        let mut texts: Vec<String> = all.map(|text| text.replace(&since, "18:07")).collect();
        texts.dedup();
        texts
    }

    #[test]
    fn the_older_version_has_its_time_beside_the_newest() {
        for (change_ms, verdict, text) in [
            (0.082, Verdict::Slower, "1 (18:07): 4.1 % ± 0.5 slower. 2.08 ms, now 2.00 ms"),
            (-0.5, Verdict::Faster, "1 (18:07): 25.0 % ± 0.5 faster. 1.50 ms, now 2.00 ms"),
            (0.004, Verdict::Same, "1 (18:07): no difference in time (+0.2 % ± 0.5). 2.00 ms, now 2.00 ms"),
        ] {
            assert_eq!(line(change_ms, verdict), [text]);
        }
    }
}
