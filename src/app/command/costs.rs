//! The command that measures what functions of the shaders cost.

use serde::Deserialize;

use super::source::stage_of;
use super::spec::{Outcome, Spec, Until};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::costs::WantedCosts;
use crate::app::state::workspace::PanelRequest;

/// Fields of `cost`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Cost {
    stage: Option<String>,
    function: Option<String>,
}

pub(in crate::app) static COST: Spec<Cost> = Spec::new("cost", cost)
    .takes(
        r#""stage"?: "tonemap.frag", "function"?: "d_ggx""#,
        "Measures what the functions of a stage of the picture cost, while it rests, and shows that in the panel Source. Result: as `specula bench cost --json`",
    )
    .label("Measure what functions cost", "cost time ms profile function shader")
    .arguments(|_| Cost::default());

fn cost(state: &mut State, _: &mut Engine, Cost { stage, function }: Cost) -> Outcome {
    let stage = stage.map(|stage| stage_of(state, &stage)).transpose()?;
    let number = state.costs.want(WantedCosts { stage, functions: function.into_iter().collect() });
    state.workspace.request_in_sight(PanelRequest::Open(Panel::SOURCE));
    Ok(Until::Found(Box::new(move |state| state.costs.answer(number))))
}
