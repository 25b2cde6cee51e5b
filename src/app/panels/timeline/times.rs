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
