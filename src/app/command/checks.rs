//! Commands about what the checks of the picture have found.

use super::spec::{Outcome, Spec, Until};
use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::workspace::PanelRequest;
use crate::shader::TreePath;

pub(in crate::app) static CHECKS: Spec<()> = Spec::fallible("checks", checks).line(
    "What the checks of the picture have found, as `view.checks` says: assertions that fail, printed values, and undefined operations. Result: as \
     `specula check MODEL --json`",
);

pub(in crate::app) static SHOW_FAILURE: Spec<()> = Spec::fallible("show-failure", |state, _, ()| {
    let first =
        state.checks.newest().and_then(|result| result.as_ref().ok()).and_then(|picture| picture.faults().next());
    let file = first.map(|first| TreePath::from(first.file.as_str())).ok_or("no check of the picture has failed")?;
    (state.checks.seeks, state.traces.stage, state.traces.file) = (true, None, Some(file));
    state.workspace.request_in_sight(PanelRequest::Open(Panel::SOURCE));
    Ok(Until::DONE)
})
.label("First failed check", "assertion undefined operation line")
.of_window();

fn checks(state: &mut State, _: &mut Engine, (): ()) -> Outcome {
    state.checks.expect();
    Ok(Until::Found(Box::new(|state| state.checks.answer())))
}
