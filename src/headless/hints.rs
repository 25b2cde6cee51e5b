//! Hints about a picture that a command prints besides its pixels.

use std::sync::Arc;

use super::{Headless, HeadlessError};
use crate::render::Capture;
use crate::shader::graph::Input;
use crate::shader::{GraphPass, TreePath, embedded};

impl Headless {
    /// The names for people ([`crate::shader::ShaderSet::name_of`]) of the passes whose image or buffer continues from frame to frame.
    ///
    /// # Errors
    /// As [`Headless::frame_state`].
    pub fn continuing_passes(&self) -> Result<Vec<String>, HeadlessError> {
        let state = self.frame_state()?;
        let (request, shaders) = (&state.pipelines, &state.shaders);
        let passes = &request.passes;
        let inputs: Vec<&Input> = passes.iter().flat_map(|pass| pass.inputs.values()).collect();
        let continues = |pass: &&Arc<GraphPass>| {
            inputs.iter().any(|input| matches!(input, Input::Before(name) if pass.desc.draws(name)))
                || pass.inputs.values().any(|input| matches!(input, Input::Buffer(..)))
        };
        let own = passes.iter().filter(|pass| !pass.desc.is_built_in());
        Ok(own.filter(continues).map(|pass| shaders.name_of_pass(pass).to_owned()).collect())
    }

    /// Why a picture shows nothing of the model, although there is one. A background that is drawn covers all pixels, so the answer is `None` then.
    ///
    /// # Errors
    /// As [`Headless::frame_state`].
    pub fn unseen_model(&self, picture: &Capture) -> Result<Option<&'static str>, HeadlessError> {
        let state = self.frame_state()?;
        let is_empty = picture.raw.iter().all(|pixel| pixel[3] == 0.0);
        let (true, true, Some(scene)) = (is_empty, state.pipelines.draws_model, &state.scene) else { return Ok(None) };
        let model = scene.model();
        if model.visible(&self.session.settings.scene).is_some_and(|visible| !visible.contains(&true)) {
            return Ok(Some("all of its parts are hidden"));
        }
        if (0..model.instances.len()).all(|instance| !scene.is_visible(instance)) {
            return Ok(Some("at this time, the file hides all of its parts (KHR_node_visibility)"));
        }
        let at = state.camera.clip_from_world() * model.bounds.center().extend(1.0);
        let is_in_view = at.w > 0.0 && at.x.abs().max(at.y.abs()) <= at.w;
        Ok(Some(match is_in_view {
            true => "it is invisible, or the shaders move its vertices away or make them NaN (`user_vertex`)",
            false => "the camera looks past it; without --eye and --target it is framed",
        }))
    }

    /// The file with the author's own background, if the settings show none although there is an environment. It is the first file
    /// that only the background's stage uses and that differs from the shipped one.
    pub fn hidden_background(&self) -> Option<String> {
        let (settings, shaders) = (&self.session.settings, self.session.shaders.as_ref()?);
        let is_hidden = settings.environment.is_lit() && !settings.environment.is_shown(&settings.view);
        let pass = shaders.graph.passes.iter().find(|pass| pass.desc.background).filter(|_| is_hidden)?;
        let stage = shaders.stages.get(&pass.desc.stage)?;
        let is_wanted = pass.is_wanted(&settings.passes) && self.frame_state().ok()?.pipelines.draws_model;
        let others = shaders.stages.values().filter(|other| other.path != stage.path);
        let shared: Vec<_> = others.flat_map(|other| &other.dependencies).collect();
        let is_own = |path: &&TreePath| {
            let text = shaders.texts.get(*path);
            text.is_some_and(|text| embedded::read(None, path) != Some(text.as_bytes())) && !shared.contains(path)
        };
        let file = stage.dependencies.iter().find(is_own).filter(|_| is_wanted)?;
        Some(self.reloader.library().source().display_path(file))
    }
}
