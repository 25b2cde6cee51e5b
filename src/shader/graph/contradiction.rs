//! Options of a `//@pass` that contradict each other, or do not apply to its kind of stage.

use crate::shader::annotation::pass::{Dispatch, Instances, MOST_COPIES, PassDesc, PassFormat, PassSize, PassTarget};
use crate::shader::compile::StageKind;

/// The contradictory word of the annotation, and a message.
pub(super) fn contradiction(desc: &PassDesc, kind: StageKind) -> Option<(&'static str, &'static str)> {
    let is_compute = kind == StageKind::Compute;
    if desc.to != PassTarget::Image && is_compute {
        return Some((
            "to=",
            "a compute pass writes an image of its own; read that in a fragment pass with to=picture",
        ));
    }
    let given = [
        ("size=", desc.size != PassSize::Divided(1)),
        ("format=", desc.format != PassFormat::default()),
        ("also=", !desc.also.is_empty()),
        ("mips", desc.mips),
        ("keep", desc.keep),
    ];
    if let Some((word, _)) = given.iter().find(|(_, given)| *given && desc.to != PassTarget::Image) {
        let message =
            "the picture has its own size and format, so size=, format=, also=, mips and keep do not go with to=";
        return Some((*word, message));
    }
    if is_compute && !desc.also.is_empty() {
        return Some(("also=", "a compute pass writes one image; also= is for .frag files"));
    }
    let draw = "draw=";
    if (desc.model.is_some() || desc.background) && is_compute {
        return Some((draw, "a compute pass cannot draw the model; draw=model is for .frag files"));
    }
    if desc.model.is_some() && desc.background {
        return Some((draw, "a pass draws the model or the background, not both"));
    }
    if desc.draws_model() && matches!(desc.model, Some(Instances::Count(count)) if count > MOST_COPIES) {
        return Some(("instances=", "a pass draws the model at most 1024 times; only draw=quads goes beyond"));
    }
    if desc.cull.is_some() && desc.model.is_none() {
        return Some(("cull=", "only a pass that draws the model has cull=; write draw=model"));
    }
    if desc.blend && !desc.is_drawn_with_model() {
        let message =
            "only a pass that draws the model or the background to the picture has blend; write draw=model to=picture";
        return Some(("blend", message));
    }
    (!is_compute && desc.dispatch != Dispatch::Size)
        .then_some(("dispatch=", "only a compute pass (.comp) has dispatch="))
}
