//! The command `compare`.

use serde_json::{Value, json};

use super::requests::{path_text, short};
use super::{Next, Until};
use crate::app::actions::compare::tree::open_second_tree;
use crate::app::command::{Command, CompareWith};
use crate::app::engine::Engine;
use crate::app::execute::execute;
use crate::app::state::State;
use crate::control::Compare;
use crate::message::did_you_mean;

/// Begins, changes or ends a comparison.
pub(in crate::app) fn compare_as(state: &mut State, engine: &mut Engine, asked: Compare) -> Result<Next, String> {
    let newest = state.shown_generation();
    let showable =
        |number: u64| state.versions.get(number).is_some_and(|version| state.versions.can_show(version, newest));
    let Compare { with, file, tree, wipe } = asked;
    if [with.is_some(), file.is_some(), tree.is_some()].into_iter().filter(|given| *given).count() > 1 {
        return Err("`compare` takes one of `with`, `file` and `tree`".to_owned());
    }
    if let Some(wipe) = wipe.filter(|wipe| !(0.0..=1.0).contains(wipe)) {
        return Err(format!("`wipe` is {wipe}; it can be 0 to 1"));
    }
    let with = match with {
        None | Some(Value::Null) => None,
        Some(Value::String(with)) => Some(match with.as_str() {
            "nothing" => CompareWith::Nothing,
            "picture" => CompareWith::ThisPicture,
            "previous" => {
                let before = state.versions.iter().rev().find(|version| state.versions.can_show(version, newest));
                CompareWith::Version(before.ok_or("there is no earlier version: no edit has been shown yet")?.number)
            }
            other => {
                let hint = did_you_mean(other, ["nothing", "picture", "previous"]);
                return Err(format!(
                    "cannot compare with `{other}`.{hint} It can be nothing, picture, previous or a number"
                ));
            }
        }),
        Some(Value::Number(number)) => {
            let number = number.as_u64().filter(|number| showable(*number));
            Some(CompareWith::Version(number.ok_or("this version is no longer kept; `versions` lists those that are")?))
        }
        Some(other) => {
            return Err(format!("cannot compare with {other}; it can be nothing, picture, previous or a number"));
        }
    };
    if let Some(with) = with {
        let ends = with == CompareWith::Nothing;
        execute(state, engine, Command::Compare(with));
        if !ends && !state.compare.is_on() {
            return Err("there is no complete picture to keep".to_owned());
        }
    }
    if let Some(file) = file {
        execute(state, engine, Command::Compare(CompareWith::File(file)));
    }
    if let Some(tree) = tree {
        open_second_tree(state, engine, &tree)?;
    }
    state.compare.wipe = wipe.unwrap_or(state.compare.wipe);
    Ok(match state.compare.is_opening() {
        true => Next::Wait(Until::Compared),
        false => Next::Done(compare_json(state)),
    })
}

/// The comparison that is on.
pub(in crate::app) fn compare_json(state: &State) -> Value {
    let compare = &state.compare;
    let file = compare.file().map(|file| path_text(file));
    json!({ "is_on": compare.is_on(), "version": compare.version(), "file": file, "tree": compare.tree_name(),
        "wipe": short(compare.wipe), "note": compare.note() })
}
