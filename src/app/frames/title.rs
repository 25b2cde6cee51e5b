//! The title over the picture.

use crate::app::state::State;
use crate::shader::Mode;

/// The title of the window: model, shader tree and mode.
pub(in crate::app) fn of_window(state: &State) -> String {
    let model = state.session.model().filter(|_| !state.shader.is_single_file).map(|model| &*model.name);
    let mode = state.session.mode().map(|mode| mode.name.as_str());
    let parts = [model, Some(state.shader.tree.as_str()), mode, Some("Specula")];
    parts.into_iter().flatten().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" - ")
}

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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::scene::built_in;
    use crate::settings::Settings;
    use crate::shader::{ShaderSet, Source};

    #[test]
    fn the_window_is_named_after_its_work() {
        let mut state = State::new(Settings::of_window(), Source::embedded());
        assert_eq!(of_window(&state), "Specula");
        state.session.set_model(&Arc::new(built_in("shader-ball").unwrap().unwrap()));
        state.shader.tree = "shaders".into();
        let mode = Mode { name: "Final".into(), slug: "final".into(), ..Mode::default() };
        state.session.shaders = Some(Arc::new(ShaderSet { modes: vec![mode], ..ShaderSet::default() }));
        assert_eq!(of_window(&state), "shader-ball - shaders - Final - Specula");
        // A toy has no model.
        (state.shader.tree, state.shader.is_single_file) = ("tunnel.glsl".into(), true);
        assert_eq!(of_window(&state), "tunnel.glsl - Final - Specula");
    }
}
