//! The command `compare`.

use serde_json::{Value, json};

use super::requests::{path_text, short};
use super::{Next, Until};
use crate::app::command::{Command, CompareWith};
use crate::app::viewer::Viewer;
use crate::control::Compare;
use crate::message::did_you_mean;

impl Viewer {
    /// Begins, changes or ends a comparison.
    pub(super) fn compare_as(&mut self, asked: Compare) -> Result<Next, String> {
        let newest = self.shown_generation();
        let showable =
            |number: u64| self.versions.get(number).is_some_and(|version| self.versions.can_show(version, newest));
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
                    let before = self.versions.iter().rev().find(|version| self.versions.can_show(version, newest));
                    CompareWith::Version(
                        before.ok_or("there is no earlier version: no edit has been shown yet")?.number,
                    )
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
                Some(CompareWith::Version(
                    number.ok_or("this version is no longer kept; `versions` lists those that are")?,
                ))
            }
            Some(other) => {
                return Err(format!("cannot compare with {other}; it can be nothing, picture, previous or a number"));
            }
        };
        if let Some(with) = with {
            let ends = with == CompareWith::Nothing;
            self.execute(Command::Compare(with));
            if !ends && !self.compare.is_on() {
                return Err("there is no complete picture to keep".to_owned());
            }
        }
        if let Some(file) = file {
            self.execute(Command::Compare(CompareWith::File(file)));
        }
        if let Some(tree) = tree {
            self.open_second_tree(&tree)?;
        }
        self.compare.wipe = wipe.unwrap_or(self.compare.wipe);
        Ok(match self.compare.is_opening() {
            true => Next::Wait(Until::Compared),
            false => Next::Done(self.compare_json()),
        })
    }

    /// The comparison that is on.
    pub(super) fn compare_json(&self) -> Value {
        let compare = &self.compare;
        let file = compare.file().map(|file| path_text(file));
        json!({ "is_on": compare.is_on(), "version": compare.version(), "file": file, "tree": compare.tree_name(),
            "wipe": short(compare.wipe), "note": compare.note() })
    }
}
