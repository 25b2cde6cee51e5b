//! Options of a `//@pass` that contradict each other, or do not apply to its kind of stage.

use crate::shader::annotation::pass::{Dispatch, Instances, MOST_COPIES, PassFormat, PassNote, PassSize, Target};
use crate::shader::compile::StageKind;

/// The word of the annotation that is wrong, and a message.
pub(super) fn contradiction(note: &PassNote, kind: StageKind) -> Option<(&'static str, &'static str)> {
    let is_compute = kind == StageKind::Compute;
    if note.to != Target::Image && is_compute {
        return Some((
            "to=",
            "a compute pass writes an image of its own; read that in a fragment pass with to=picture",
        ));
    }
    let given = [
        ("size=", note.size != PassSize::Divided(1)),
        ("format=", note.format != PassFormat::default()),
        ("also=", !note.also.is_empty()),
        ("mips", note.mips),
        ("keep", note.keep),
    ];
    if let Some((word, _)) = given.iter().find(|(_, given)| *given && note.to != Target::Image) {
        let message =
            "the picture has its own size and format, so size=, format=, also=, mips and keep do not go with to=";
        return Some((*word, message));
    }
    if is_compute && !note.also.is_empty() {
        return Some(("also=", "a compute pass writes one image; also= is for .frag files"));
    }
    let draw = "draw=";
    if (note.model.is_some() || note.background) && is_compute {
        return Some((draw, "a compute pass cannot draw the model; draw=model is for .frag files"));
    }
    if note.model.is_some() && note.background {
        return Some((draw, "a pass draws the model or the background, not both"));
    }
    if note.draws_model() && matches!(note.model, Some(Instances::Count(count)) if count > MOST_COPIES) {
        return Some(("instances=", "a pass draws the model at most 1024 times; only draw=quads goes beyond"));
    }
    if note.cull.is_some() && note.model.is_none() {
        return Some(("cull=", "only a pass that draws the model has cull=; write draw=model"));
    }
    if note.blend && !note.is_drawn_with_model() {
        let message =
            "only a pass that draws the model or the background to the picture has blend; write draw=model to=picture";
        return Some(("blend", message));
    }
    (!is_compute && note.dispatch != Dispatch::Size)
        .then_some(("dispatch=", "only a compute pass (.comp) has dispatch="))
}
