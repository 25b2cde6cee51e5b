//! The words about light that is being baked: the picture has the light of before, or none, until then.

use std::time::Duration;

use crate::app::context::Context;
use crate::app::state::waits::Waits;

/// The bars and the picture say what the picture waits for after this long.
const LONG: Duration = Duration::from_millis(250);
/// Time between two texts with other numbers. A frame takes time from a bake on a software device.
const STEP: Duration = Duration::from_millis(250);

/// The work that has delayed the picture for longer than [`LONG`], and since when.
pub(super) fn long_wait(egui: &egui::Context, context: &Context<'_>) -> Option<(Waits, Duration)> {
    let (waits, time) = context.state.picture.waits_for()?;
    let left = LONG.checked_sub(time);
    let next = left.or(matches!(waits, Waits::Light { .. }).then_some(STEP));
    next.into_iter().for_each(|next| egui.request_repaint_after(next));
    left.is_none().then_some((waits, time))
}

/// `light of the edit is being baked, 1.2 s, 43 %`. `progress`: the fraction that is done, if it is known.
pub(super) fn text(of_edit: bool, time: Duration, progress: Option<f32>) -> String {
    let whose = if of_edit { "light of the edit" } else { "light" };
    let done = progress.map(|done| format!(", {:.0} %", 100.0 * done)).unwrap_or_default();
    format!("{whose} is being baked, {:.1} s{done}", time.as_secs_f32())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_says_whose_light_and_how_far() {
        let time = Duration::from_millis(1240);
        assert_eq!(text(true, time, Some(0.426)), "light of the edit is being baked, 1.2 s, 43 %");
        assert_eq!(text(false, time, None), "light is being baked, 1.2 s");
    }
}
