//! Traces of a pixel for tests.

use std::sync::Arc;

use super::Traces;
use super::subject::Subject;
use crate::app::state::picture_subject::PictureSubject;
use crate::settings::Settings;
use crate::shader::ShaderSet;
use crate::shader::trace::sample::trace;
use crate::shader::trace::{Event, Trace};
use crate::threads::TracedPlace;

/// The pixel at 3, 4 of a picture with these shaders.
pub(in crate::app) fn subject(shaders: &Arc<ShaderSet>) -> Subject {
    Subject {
        picture: PictureSubject {
            size: (64, 48),
            settings: Arc::new(Settings::default()),
            shaders: shaders.clone(),
            revisions: Default::default(),
            model: Default::default(),
            light: Default::default(),
            clock: Default::default(),
        },
        at: [3, 4],
        stage: None,
        file: None,
    }
}

/// Takes a trace of a version of `a.glsl`, with these events.
pub(in crate::app) fn add(
    traces: &mut Traces,
    shaders: &Arc<ShaderSet>,
    number: u64,
    events: Vec<Event>,
    statements: &[u32],
) {
    add_trace(traces, shaders, number, trace(events, statements));
}

/// Takes a trace of a version of `a.glsl`.
pub(in crate::app) fn add_trace(traces: &mut Traces, shaders: &Arc<ShaderSet>, number: u64, trace: Trace) {
    traces.ask(subject(shaders), number, false);
    let names = TracedPlace {
        stage: "a.frag".to_owned(),
        stages: Vec::new(),
        files: vec!["a.glsl".to_owned()],
        file: "a.glsl".to_owned(),
    };
    assert!(traces.take(number, names, Ok(trace)));
}
