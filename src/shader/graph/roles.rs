//! The passes that make up the picture: the model, its background, the mean and the tone map. They are declared as all others;
//! this module says what is asked of them.

use std::collections::BTreeSet;

use super::{PassStage, RenderPhase};
use crate::message::did_you_mean;
use crate::shader::annotation::Annotations;
use crate::shader::annotation::pass::{MODEL, PassDesc, PassTarget, TONEMAP};
use crate::shader::compile::StageKind;
use crate::shader::contract::check_fragment_outputs;
use crate::shader::diagnostic::Diagnostic;

/// The phase that an annotation alone determines.
pub(super) fn phase(desc: &PassDesc) -> RenderPhase {
    match desc.to {
        PassTarget::Peel => RenderPhase::Peel,
        PassTarget::Resolve => RenderPhase::Resolve,
        PassTarget::Mean => RenderPhase::Mean,
        PassTarget::Display => RenderPhase::Tonemap,
        PassTarget::Picture if desc.is_drawn_with_model() => RenderPhase::Model,
        PassTarget::Picture | PassTarget::Image => RenderPhase::Light,
    }
}

/// Errors of passes with a name or an option that is reserved for another kind of pass.
pub(super) fn misplaced(annotations: &Annotations) -> impl Iterator<Item = Diagnostic> {
    let passes = &annotations.passes;
    passes.iter().filter_map(|desc| {
        let (word, message) = misplacement(desc, passes)?;
        Some(desc.place.error_at(word, message))
    })
}

/// Errors about passes that a picture needs and no stage declares. `tree`: the name of the tree.
pub fn missing_passes(passes: &[PassDesc], tree: &str) -> Vec<Diagnostic> {
    let is_missing = |name: &str| passes.iter().all(|desc| desc.name != name);
    let needed = [(MODEL, "draw=model to=picture"), (TONEMAP, "to=display")];
    let missing = needed.into_iter().filter(|(name, _)| is_missing(name));
    let error = |(name, options): (&str, &str)| {
        let message = format!("no stage of the tree declares the pass `{name}`");
        let help = format!("write `//@pass {name} {options}` in the fragment stage that draws it");
        Diagnostic::error(tree, message).with_help(help)
    };
    missing.map(error).collect()
}

/// Errors of a fragment stage whose outputs are not the images of its pass.
pub(super) fn wrong_outputs(desc: &PassDesc, stage: &PassStage<'_>) -> Vec<Diagnostic> {
    if stage.kind != StageKind::Fragment {
        return Vec::new();
    }
    if desc.also.is_empty() {
        return check_fragment_outputs(&stage.reflection.outputs, stage.texts);
    }
    let outputs = &stage.reflection.outputs;
    let mut errors = Vec::new();
    for (location, (name, _)) in (0..).zip(desc.images()) {
        let found = outputs.iter().find(|output| output.location == location);
        // The first output may have any name.
        if !found.is_some_and(|output| output.type_name == "vec4" && (location == 0 || output.name == name)) {
            let message = format!("the pass draws the image `{name}`, but its stage has no output for it");
            let help = format!("write `layout(location = {location}) out vec4 {name};`");
            errors.push(desc.place.error_at(name, message).with_help(help));
        }
    }
    for output in outputs.iter().filter(|output| output.location as usize > desc.also.len()) {
        let message = format!("the pass has no image for the output at location {}", output.location);
        let error = stage.texts.error(&[output.name.as_str(), "out"], message);
        errors.push(error.with_help(format!("add `{}` to its also=", output.name)));
    }
    errors
}

/// An error about the first debug mode that accumulates, if no pass draws to the accumulation buffer.
pub(super) fn no_mean(annotations: &Annotations) -> Option<Diagnostic> {
    let mode = annotations.modes.iter().find(|mode| mode.accumulate)?;
    if annotations.passes.iter().any(|desc| desc.to == PassTarget::Mean) {
        return None;
    }
    let message = format!("the mode `{}` accumulates, but no stage declares a pass with to=mean", mode.slug);
    let error = Diagnostic::error(&mode.file, message).on_line(mode.line, None);
    Some(error.with_help("write `//@pass mean to=mean` in the fragment stage that adds a frame to the mean"))
}

/// Errors about debug modes with a stage that no pass draws the model with, one for each stage.
pub(super) fn undrawn_modes(annotations: &Annotations) -> impl Iterator<Item = Diagnostic> {
    let draws = |desc: &&PassDesc| desc.is_drawn_with_model() && desc.is_built_in();
    let known: Vec<&str> = annotations.passes.iter().filter(draws).map(|desc| desc.stage.as_str()).collect();
    let mut told = BTreeSet::new();
    annotations.modes.iter().filter_map(move |mode| {
        if known.contains(&mode.stage.as_str()) || !told.insert(&mode.stage) {
            return None;
        }
        let stems: Vec<&str> = known.iter().map(|path| path.trim_end_matches(".frag")).collect();
        let hint = did_you_mean(mode.stage.trim_end_matches(".frag"), stems.iter().copied());
        let message = format!("no pass draws the model with {} for the mode `{}`.{hint}", mode.stage, mode.slug);
        let error = Diagnostic::error(&mode.file, message).on_line(mode.line, None);
        Some(error.with_help(format!("stage= can be {}", stems.join(", "))))
    })
}

/// The misplaced word of an annotation, and a message.
fn misplacement<'a>(desc: &'a PassDesc, passes: &[PassDesc]) -> Option<(&'a str, String)> {
    let draws_model = desc.draws_model() && desc.to_picture();
    let name = desc.name.as_str();
    match name {
        MODEL if !draws_model => {
            return Some((name, format!("the pass `{MODEL}` draws the model: draw=model to=picture")));
        }
        TONEMAP if desc.to != PassTarget::Display => {
            return Some((name, format!("the pass `{TONEMAP}` brings the picture to the display: to=display")));
        }
        _ => {}
    }
    if desc.is_built_in() && (!desc.on || desc.when.is_some()) {
        let message = format!("the pass `{name}` is a step of every picture, so off and when= do not go with it");
        return Some((if desc.on { "when=" } else { "off" }, message));
    }
    if desc.to == PassTarget::Display && name != TONEMAP {
        let message =
            format!("only the pass `{TONEMAP}` has to=display; a pass after it has to=picture after={TONEMAP}");
        return Some(("to=", message));
    }
    for (to, message) in [
        (PassTarget::Mean, "there is another pass with to=mean; one pass makes the mean of all frames"),
        (PassTarget::Peel, "there is another pass with to=peel; one pass finds the layers of blended surfaces"),
        (PassTarget::Resolve, "there is another pass with to=resolve; one pass makes a color from a pixel's samples"),
    ] {
        let is_other = |other: &PassDesc| other.to == to && other.name < desc.name;
        if desc.to == to && passes.iter().any(is_other) {
            return Some(("to=", message.into()));
        }
    }
    let covers = matches!(desc.to, PassTarget::Resolve | PassTarget::Mean | PassTarget::Display | PassTarget::Peel);
    if covers && desc.model.is_some() {
        let message = format!("the pass `{name}` covers the picture, so draw= and instances= do not go with it");
        return Some(("to=", message));
    }
    if desc.background && !desc.to_picture() {
        let message = "the background lies behind the model in the picture: draw=background to=picture";
        return Some(("draw=", message.into()));
    }
    match desc.instead.as_deref() {
        Some(MODEL) if !draws_model || name == MODEL => {
            let message = format!("a pass with instead={MODEL} draws the model as well: draw=model to=picture");
            Some(("instead=", message))
        }
        Some(MODEL) | None => None,
        Some(other) => {
            let message = format!("expected instead={MODEL}, found `{other}`: only the model has such passes");
            Some(("instead=", message))
        }
    }
}
