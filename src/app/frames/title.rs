//! The title over the picture.

use crate::app::state::State;
use crate::shader::Mode;

/// The title over the picture. `frames` is the number of accumulated frames.
pub(in crate::app) fn title(state: &State, frames: u32) -> Option<String> {
    let shown = state.shown()?;
    let request = &shown.pipelines;
    let paths = request.accumulates.then(|| frames.saturating_mul(request.paths_per_frame()));
    let preview = state.workspace.sight.preview.as_ref();
    let selected = preview.and_then(|slug| shown.shaders.modes.iter().find(|mode| mode.slug == *slug));
    let title = of_modes(shown.mode()?, selected.or_else(|| state.session.mode()), paths)?;
    Some(request.limit().map_or_else(|| title.clone(), |limit| format!("{title}. Note: {limit}")))
}

/// The mode on screen and the selected mode that is being built. The final picture has no title.
/// `paths` is the number of paths per pixel so far in an accumulating mode.
fn of_modes(shown: &Mode, set: Option<&Mode>, paths: Option<u32>) -> Option<String> {
    match (set.filter(|set| set.slug != shown.slug), paths) {
        (Some(next), _) => Some(format!("{}  ➡  {} …", shown.name, next.name)),
        (None, Some(1)) => Some(format!("{}   1 path per pixel", shown.name)),
        (None, Some(paths)) => Some(format!("{}   {paths} paths per pixel", shown.name)),
        (None, None) => Some(shown.name.clone()).filter(|_| shown.slug != "final"),
    }
}
