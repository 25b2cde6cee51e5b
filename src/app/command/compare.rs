//! Commands that compare the picture with another one.

use std::path::PathBuf;

use serde::Deserialize;
use serde_json::{Value, json};

use super::about::Group;
use super::shortcut::Shortcut;
use super::spec::{Outcome, Spec, Until};
use crate::app::actions::compare::file::open_picture;
use crate::app::actions::compare::tree::open_second_tree;
use crate::app::actions::compare::{compare_with, this_picture};
use crate::app::control::{path_text, short};
use crate::app::engine::Engine;
use crate::app::engine::compared::Compared;
use crate::app::state::State;
use crate::app::state::compare::With;
use crate::message::did_you_mean;

/// Fields of `compare`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(in crate::app) struct CompareFields {
    with: Option<Value>,
    file: Option<PathBuf>,
    tree: Option<PathBuf>,
    wipe: Option<f32>,
}

impl CompareFields {
    pub(in crate::app) fn nothing() -> Self {
        Self { with: Some("nothing".into()), ..Self::default() }
    }

    /// The picture as it is now, with all its settings.
    pub(in crate::app) fn picture() -> Self {
        Self { with: Some("picture".into()), ..Self::default() }
    }

    /// A version of the shaders.
    pub(in crate::app) fn version(number: u64) -> Self {
        Self { with: Some(number.into()), ..Self::default() }
    }

    pub(in crate::app) fn file(path: PathBuf) -> Self {
        Self { file: Some(path), ..Self::default() }
    }

    /// The part of the picture that shows the other one.
    pub(in crate::app) fn wipe(part: f32) -> Self {
        Self { wipe: Some(part), ..Self::default() }
    }

    /// Another shader tree.
    pub(in crate::app) fn tree(path: PathBuf) -> Self {
        Self { tree: Some(path), ..Self::default() }
    }
}

pub(in crate::app) static COMPARE: Spec<CompareFields> = Spec::new("compare", compare).takes(
    r#""with"?: "nothing" | "picture" | "previous" | number, "file"?: "a.png", "tree"?: "folder", "wipe"?: 0..1"#,
    "Compares the picture with an earlier one, a picture from a file (PNG, JPEG, HDR, EXR) or that of another shader tree. Result: version, file, tree, wipe, note; an event `compared` has FLIP",
);

pub(in crate::app) static TOGGLE_COMPARE: Spec<()> = Spec::fallible("toggle-compare", |state, engine, ()| {
    compare(state, engine, if state.compare.is_on() { CompareFields::nothing() } else { CompareFields::picture() })
})
.shortcuts(Group::Picture, &[Shortcut::key('k').ctrl()], "keep this picture and compare with it; press again to stop");

/// Shows or hides the map of the differences.
pub(in crate::app) static TOGGLE_DIFFERENCE: Spec<()> =
    Spec::plain("toggle-difference", |state, _, ()| state.compare.shows_map ^= true)
        .enabled(|state| state.compare.is_on())
        .of_window();

/// Begins, changes or ends a comparison.
fn compare(state: &mut State, engine: &mut Engine, asked: CompareFields) -> Outcome {
    let CompareFields { with, file, tree, wipe } = asked;
    if [with.is_some(), file.is_some(), tree.is_some()].into_iter().filter(|given| *given).count() > 1 {
        return Err("`compare` takes one of `with`, `file` and `tree`".to_owned());
    }
    if let Some(wipe) = wipe.filter(|wipe| !(0.0..=1.0).contains(wipe)) {
        return Err(format!("`wipe` is {wipe}; it can be 0 to 1"));
    }
    if let Some(with) = with {
        let with = other_picture(state, engine, &with)?;
        compare_with(state, engine, with);
    }
    if let Some(file) = file {
        open_picture(state, engine, &file);
    }
    if let Some(tree) = tree {
        open_second_tree(state, engine, &tree);
    }
    state.compare.wipe = wipe.unwrap_or(state.compare.wipe);
    Ok(match state.compare.is_opening() {
        true => Until::Compared(compare_json),
        false => Until::Now(compare_json(state)),
    })
}

/// The picture that the field `with` names.
fn other_picture(state: &State, engine: &Engine, with: &Value) -> Result<Option<(With, Compared)>, String> {
    let newest = state.shown_generation();
    let versions = || state.versions.iter().filter(|version| state.versions.can_show(version, newest));
    Ok(match with {
        Value::String(with) => match with.as_str() {
            "nothing" => None,
            "picture" => Some(this_picture(state, engine).ok_or("there is no complete picture to keep")?),
            "previous" => {
                let before = versions().last().ok_or("there is no earlier version: no edit has been shown yet")?;
                Some((With::Version(before.number), Compared::Nothing))
            }
            other => {
                let hint = did_you_mean(other, ["nothing", "picture", "previous"]);
                return Err(format!(
                    "cannot compare with `{other}`.{hint} It can be nothing, picture, previous or a number"
                ));
            }
        },
        Value::Number(number) => {
            let version = versions().find(|version| number.as_u64() == Some(version.number));
            let version = version.ok_or("this version is no longer kept; `versions` lists those that are")?;
            Some((With::Version(version.number), Compared::Nothing))
        }
        other => return Err(format!("cannot compare with {other}; it can be nothing, picture, previous or a number")),
    })
}

/// The comparison that is on.
fn compare_json(state: &State) -> Value {
    let compare = &state.compare;
    let file = compare.file().map(|file| path_text(file));
    json!({ "is_on": compare.is_on(), "version": compare.version(), "file": file, "tree": compare.tree_name(),
        "wipe": short(compare.wipe), "note": compare.note() })
}
