//! Commands about the models that are shown, and the scene of the first.

use std::path::PathBuf;

use serde::Deserialize;

use super::spec::{Outcome, Spec, Until};
use crate::app::actions::files::{load_models, wanted_models};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::scene::BUILT_IN;
use crate::settings::AddedModel;

/// Shows one of the models beside the first no longer, by its number from 0.
pub(in crate::app) static REMOVE_MODEL: Spec<usize> = Spec::new("remove-model", |state, engine, number| {
    let (first, mut added) = wanted_models(state);
    if number >= added.len() {
        return Err(format!("no model {number} is shown beside the first; there are {}", added.len()));
    }
    added.remove(number);
    Ok(show_models(state, engine, first, added))
});

/// Fields of `scene`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct SceneFields {
    number: usize,
}

impl SceneFields {
    /// The scene with this number.
    pub(in crate::app) fn of(number: usize) -> Self {
        Self { number }
    }
}

pub(in crate::app) static SCENE: Spec<SceneFields> = Spec::new("scene", show_scene)
    .takes(
        r#""number": N"#,
        "Shows another scene of the model's file, by its number from 0. Done when its final picture is on screen",
    )
    .required(&["number"]);

/// Loads another scene of the first model's file. If that fails, the one on screen stays.
fn show_scene(state: &mut State, engine: &mut Engine, SceneFields { number }: SceneFields) -> Outcome {
    let scenes = state.session.model().map_or(0, |model| model.contents.scenes.len());
    if number >= scenes {
        return Err(format!("there is no scene {number}: the model's file has {scenes}, and the first is 0"));
    }
    let ((first, _), added) = wanted_models(state);
    Ok(show_models(state, engine, (first, Some(number)), added))
}

/// Shows a scene of the first model, and these models beside it.
pub(super) fn show_models(
    state: &mut State,
    engine: &mut Engine,
    (first, scene): (Option<PathBuf>, Option<usize>),
    added: Vec<AddedModel>,
) -> Until {
    let first = first.unwrap_or_else(|| BUILT_IN[0].into());
    load_models(state, engine, (Some(first.clone()), scene), added);
    Until::Model(first)
}
