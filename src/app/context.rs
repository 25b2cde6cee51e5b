//! The read-only view of the window that panels get.

use std::sync::Arc;

use super::readings::Readings;
use super::state::State;
use crate::frame::Scene;
use crate::scene::Model;
use crate::shader::ShaderSet;

/// The state that panels see in a frame. They read it, and change things only by [`Commands`](super::commands::Commands).
pub(super) struct Context<'a> {
    pub(super) state: &'a State,
    pub(super) readings: Readings<'a>,
    /// The last good shaders; empty before the first.
    pub(super) shaders: Arc<ShaderSet>,
    /// The model with the settings' variant, materials and transform.
    pub(super) scene: Option<Scene>,
}

impl<'a> Context<'a> {
    pub(super) fn new(state: &'a State, readings: Readings<'a>) -> Self {
        let shaders = state.session.shaders.clone().unwrap_or_default();
        Self { state, readings, shaders, scene: state.session.scene() }
    }

    /// The model at the place that the settings give it; an empty one without a model.
    pub(super) fn model(&self) -> Arc<Model> {
        self.scene.as_ref().map(|scene| scene.model().clone()).unwrap_or_default()
    }
}
