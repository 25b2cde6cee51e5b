//! Commands of the panel Source: the file, the pixel, and which of what happened there is shown.

use std::sync::Arc;

use serde::Deserialize;
use serde_json::json;

use super::spec::{Outcome, Spec, Until};
use crate::app::actions::edits::save_typed;
use crate::app::engine::Engine;
use crate::app::source_line::SourceLine;
use crate::app::state::State;
use crate::app::state::arrangement::Panel;
use crate::app::state::guests::Guest;
use crate::app::state::trace::choice::Choice;
use crate::app::state::workspace::PanelRequest;
use crate::message::did_you_mean;
use crate::shader::TreePath;
use crate::write_back::TreeFile;

/// Fields of `source`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Source {
    file: Option<String>,
    stage: Option<String>,
    at: Option<[u32; 2]>,
    fragment: Option<usize>,
    call: Option<String>,
    time: Option<usize>,
}

pub(in crate::app) static SOURCE: Spec<Source> = Spec::new("source", source).takes(
    r#""file"?: "brdf/ndf.glsl", "stage"?: "tonemap.frag", "at"?: [x,y], "fragment"?: n, "call"?: "shade > add_light [light 2]", "time"?: n"#,
    "Opens the panel Source at a file of the tree, pins a pixel, and traces what the file's statements do there, in a stage of the picture; \
     a fragment is counted from 0, the time of a statement that ran more than once from 1. Result: as `specula trace --json`, with `stages` of the picture, `files` of the stage, `calls`, and \
     `changed`: values that the last edit has changed",
)
.of_window();

/// A text that was typed into a file of the tree.
#[derive(Clone, Debug)]
pub(in crate::app) struct Typed {
    pub(in crate::app) file: TreeFile,
    /// The text with which the typing began.
    pub(in crate::app) base: Arc<str>,
    pub(in crate::app) text: Arc<str>,
}

/// Writes a typed text into its file.
pub(in crate::app) static SAVE_FILE: Spec<Typed> =
    Spec::act("save-file", |state, engine, Typed { file, base, text }| save_typed(state, engine, file, base, text));

/// Shows a file in the panel Source.
pub(in crate::app) static SHOW_FILE: Spec<TreePath> = Spec::act("show-file", |state, _, file: TreePath| {
    // Another stage may have the file.
    if state.traces.newest().is_some_and(|newest| !newest.files.iter().any(|of| *of == *file.as_str())) {
        state.traces.stage = None;
    }
    // Lines of another file name other loops.
    if state.traces.file_shown() != Some(&file) {
        state.traces.choice.round = None;
    }
    state.traces.file = Some(file);
    state.workspace.request_in_sight(PanelRequest::Open(Panel::SOURCE));
})
.of_window();

/// A line of a file, from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::app) struct SourcePlace {
    pub(in crate::app) file: TreePath,
    pub(in crate::app) line: u32,
}

/// Shows a line in the panel Source.
pub(in crate::app) static SHOW_LINE: Spec<SourcePlace> = Spec::act("show-line", |state, engine, place| {
    let SourcePlace { file, line } = place;
    state.traces.seeks = Some((file.clone(), line));
    // Also if the file is shown as that of a trace: the next one may be of another file.
    let _ = SHOW_FILE.with(file).run(state, engine);
});

/// Chooses the stage whose statements the panel Source shows, with its own file.
pub(in crate::app) static CHOOSE_STAGE: Spec<String> = Spec::act("choose-stage", |state, _, stage| {
    (state.traces.stage, state.traces.file, state.traces.choice.round) = (Some(stage), None, None);
});

/// Chooses the fragment, the call and the time whose values the panel Source shows.
pub(in crate::app) static CHOOSE_TRACE: Spec<Choice> =
    Spec::act("choose-trace", |state, _, choice: Choice| state.traces.choose(choice));

/// The path of the stage of the picture that a user names.
///
/// # Errors
/// The picture has none of this name.
pub(super) fn stage_of(state: &State, name: &str) -> Result<String, String> {
    let shown = state.shown().ok_or("there is no picture yet")?;
    let (shaders, all) = (&shown.shaders, shown.pipelines.stages());
    let found = shaders.stage_named(name).filter(|stage| all.contains(*stage)).map(str::to_owned);
    found.ok_or_else(|| {
        let hint = did_you_mean(name, all.iter().map(|stage| shaders.name_of(stage)));
        format!("the picture has no stage {name}.{hint}")
    })
}

fn source(state: &mut State, _: &mut Engine, Source { file, stage, at, fragment, call, time }: Source) -> Outcome {
    let file = file.map(|file| file_of(state, &file)).transpose()?;
    if let Some([x, y]) = at {
        let (width, height) = state.shown().ok_or("there is no picture yet")?.size;
        if x >= width || y >= height {
            return Err(format!("[{x}, {y}] is outside of the picture, which has {width}x{height} pixels"));
        }
        state.inspection.pin = at;
    }
    let stage = stage.map(|stage| stage_of(state, &stage)).transpose()?;
    (state.traces.stage, state.traces.file) = match (stage, file) {
        (None, None) => (state.traces.stage.take(), state.traces.file.take()),
        chosen => chosen,
    };
    state.traces.choice = Choice { fragment, call, round: None, time: time.filter(|time| *time > 0) };
    state.traces.expect();
    state.workspace.request_in_sight(PanelRequest::Open(Panel::SOURCE));
    Ok(Until::Found(Box::new(|state| state.traces.answer())))
}

/// Fields of `trace`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct Trace {
    file: String,
    stage: Option<String>,
    at: Option<[u32; 2]>,
}

pub(in crate::app) static PINNED: Spec<()> = Spec::fallible("pinned", |state, _, ()| {
    let tree = state.source.root();
    Ok(Until::Now(json!({ "pixel": state.inspection.pin, "generation": state.shown_generation(), "tree": tree })))
})
.line("The pinned pixel, or null, and the folder of the shader tree. The event `pinned` tells of changes. Result: pixel, generation, tree");

pub(in crate::app) static TRACE: Spec<Trace> = Spec::new("trace", trace).takes(
    r#""file": "brdf/ndf.glsl", "stage"?: "tonemap.frag", "at"?: [x,y]"#,
    "Traces what a file's statements do at a pixel, or at the pinned one; the panels stay as they are. Result: as `specula trace --json`, with `file`",
);

fn trace(state: &mut State, _: &mut Engine, Trace { file, stage, at }: Trace) -> Outcome {
    let file = file_of(state, &file)?;
    let at = at.or(state.inspection.pin).ok_or("no pixel is pinned; name one with `at`")?;
    let number = state.guests.ask(Guest { at, file, stage });
    Ok(Until::Found(Box::new(move |state| state.guests.answer(number))))
}

/// The file of the tree that a path, or the end of one, names.
fn file_of(state: &State, file: &str) -> Result<TreePath, String> {
    let shaders = state.session.shaders.as_ref().ok_or("there are no shaders yet")?;
    let found = SourceLine::file(shaders, file).map(|(path, _)| path.clone());
    found.ok_or_else(|| {
        let hint = did_you_mean(file, shaders.texts.keys().map(TreePath::as_str));
        format!("no stage has a file {file}.{hint}")
    })
}
