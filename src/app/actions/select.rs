//! Selection, visibility of nodes, and the camera that the user looks through.

use std::sync::Arc;

use crate::app::state::State;
use crate::app::state::selection::{LightId, Selected};
use crate::app::state::workspace::PanelRequest;
use crate::scene::environment::MODEL;
use crate::scene::{CameraController, CameraView, Model, pick};
use crate::settings::{EnvironmentSettings, LightSource};

/// Selects what a pixel of the picture on screen shows, or nothing, also if that is selected already, unless a panel shows the values of the
/// pixel: then the click is for these.
pub(in crate::app) fn select_at(state: &mut State, [x, y]: [u32; 2]) {
    let Some(frame_state) = state.shown().filter(|frame_state| frame_state.pipelines.draws_model) else { return };
    let Some(scene) = frame_state.scene.clone() else { return };
    let hit = pick(scene.model(), &frame_state.camera, frame_state.size, (x, y), |instance| scene.sides(instance));
    let hit = hit.map(|hit| hit.instance);
    let sight = &state.workspace.sight;
    let is_same = (sight.source || sight.inspector) && hit.map(Selected::Instance) == Some(state.selected);
    state.select(if is_same { state.selected } else { state.selected.clicked(hit) });
    state.workspace.request(PanelRequest::FollowSelection);
}

/// Whether each instance of the scene on screen is selected; empty if none is.
pub(in crate::app) fn selected_instances(state: &mut State) -> Arc<[bool]> {
    let scene = state.shown().and_then(|frame_state| frame_state.scene.clone());
    let (Some(scene), true) = (scene, state.selected != Selected::Nothing) else {
        state.selected_cache = None;
        return Arc::default();
    };
    if let Some((selected, of, instances)) = &state.selected_cache
        && *selected == state.selected
        && of.has_same_draws(&scene)
    {
        return instances.clone();
    }
    let is_in = state.selected.is_in(scene.model());
    let instances = if is_in { state.selected.instances(&scene) } else { Vec::new() };
    let instances: Arc<[bool]> = if instances.contains(&true) { instances.into() } else { Arc::default() };
    state.selected_cache = Some((state.selected, scene, instances.clone()));
    instances
}

/// The name of what is selected, for the settings that hide and isolate. Says what to do if there is none.
fn selected_key(state: &mut State) -> Option<String> {
    let model = state.session.model().cloned()?;
    let key = state.selected.key(&model);
    if key.is_none() {
        state.say("Select a node or a primitive first: click it in the picture or in the Scene panel");
    }
    key
}

/// Hides what is selected.
pub(in crate::app) fn hide_selected(state: &mut State) {
    let Some(key) = selected_key(state) else { return };
    let scene = &mut state.session.settings.scene;
    scene.isolated.retain(|name| *name != key);
    if !scene.hidden.contains(&key) {
        scene.hidden.push(key);
    }
    state.select(Selected::Nothing);
}

/// Isolates what is selected, or shows everything if it is isolated already.
pub(in crate::app) fn isolate_selected(state: &mut State) {
    if !state.session.settings.scene.isolated.is_empty() {
        state.session.settings.scene.isolated.clear();
        return;
    }
    let Some(key) = selected_key(state) else { return };
    let scene = &mut state.session.settings.scene;
    scene.hidden.retain(|name| *name != key);
    scene.isolated = vec![key];
}

/// Shows everything again.
pub(in crate::app) fn show_all(state: &mut State) {
    let scene = &mut state.session.settings.scene;
    scene.hidden.clear();
    scene.isolated.clear();
}

/// Looks through a camera of the model.
pub(in crate::app) fn look_through(state: &mut State, camera: usize) {
    let Some(model) = state.session.model().filter(|model| camera < model.cameras.len()) else { return };
    let name = model.camera_key(camera);
    let settings = &mut state.session.settings.camera;
    settings.frame_model();
    settings.name = name;
}

/// Switches the rectangular light on and selects it.
pub(in crate::app) fn place_rectangle(state: &mut State) {
    let lights = &mut state.session.settings.lights;
    lights.rect.enabled = true;
    if lights.source == LightSource::None {
        lights.source = LightSource::Orbit;
    }
    state.select(Selected::Light(LightId::Rectangle));
}

/// Switches on the lights of a new model's file, or the orbiting ones if it has none, as long as the user has not chosen a source of
/// lights. A file that has lights was made to be seen in them, and other viewers show them too.
pub(in crate::app) fn follow_lights(state: &mut State, model: &Model) {
    let lights = &mut state.session.settings.lights;
    // The user has chosen others since.
    state.follows_lights &= lights.source == state.followed_source;
    if !state.follows_lights {
        return;
    }
    let count = model.lights.len();
    let source = if count > 0 { LightSource::Model } else { LightSource::default() };
    (lights.source, state.followed_source) = (source, source);
    if count > 0 {
        let lights = if count == 1 { "light".to_owned() } else { format!("{count} lights") };
        state.say(format!("Using the {lights} of the model's file instead of the orbiting lights (Lights > Source)"));
    }
}

/// Chooses the environment of a new model's file, or the default one if it has none, as long as the user has not chosen one.
pub(in crate::app) fn follow_environment(state: &mut State, model: &Model) {
    let name = &mut state.session.settings.environment.name;
    state.follows_environment &= *name == state.followed_environment;
    if !state.follows_environment {
        return;
    }
    *name = if model.environment.is_some() { MODEL.to_owned() } else { EnvironmentSettings::default().name };
    state.followed_environment.clone_from(name);
    if model.environment.is_some() {
        state.say("Using the environment of the model's file instead of the studio (Environment > Map)");
    }
}

/// Moves the camera so that it looks at the surface at a pixel, and orbits around it. Returns whether there is one.
pub(in crate::app) fn focus(state: &mut State, size: (u32, u32), at: (u32, u32), view: &CameraView) -> bool {
    let Some(scene) = state.session.scene() else { return false };
    let hit = pick(scene.model(), view, size, at, |instance| scene.sides(instance));
    let Some(hit) = hit else { return false };
    CameraController::focus(&mut state.session.settings.camera, view, hit.point);
    true
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::scene::environment::ModelEnvironment;
    use crate::settings::Settings;
    use crate::shader::Source;

    #[test]
    fn the_environment_follows_the_model_until_the_user_chooses_one() {
        let mut state = State::new(Settings::default(), Source::embedded());
        let faces = [(); 6].map(|()| vec![255; 4]);
        let environment = ModelEnvironment::new(String::new(), 1, (Quat::IDENTITY, 1.0), faces);
        let lit = Model { environment: Some(Arc::new(environment)), ..Model::default() };
        let shown = |state: &mut State, model: &Model| {
            follow_environment(state, model);
            state.session.settings.environment.name.clone()
        };
        assert_eq!(shown(&mut state, &lit), "studio", "an option has chosen it");
        state.follows_environment = true;
        assert_eq!(shown(&mut state, &lit), "model");
        assert_eq!(shown(&mut state, &Model::default()), "studio");
        assert_eq!(shown(&mut state, &lit), "model");
        state.session.settings.environment.name = "sky".into();
        assert_eq!(shown(&mut state, &lit), "sky");
        assert_eq!(shown(&mut state, &Model::default()), "sky");
    }
}
