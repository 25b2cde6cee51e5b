//! Finds the functions that an edit has changed, by comparing two versions of a stage's files.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use foldhash::HashSet;

use super::scan::{File, Function, Parts};
use crate::shader::source::TreePath;

/// The files of a stage by path. `None` stands for an include that was not found.
pub type Files = BTreeMap<TreePath, Option<Arc<File>>>;

/// The names of functions that were edited, added or removed. `None` if the edit affects other functions too, because
/// it changes a declaration, a signature that they call, or the order of definitions.
pub fn changed_functions(old: &Files, new: &Files) -> Option<BTreeSet<Box<str>>> {
    let (mut changed, mut moved) = (BTreeSet::new(), BTreeSet::new());
    for (path, old) in old {
        match (old, new.get(path)?) {
            (None, None) => {}
            (Some(old), Some(new)) if Arc::ptr_eq(old, new) => {}
            (Some(old), Some(new)) => compare(old.parts()?, new.parts()?, &mut changed, &mut moved)?,
            _ => return None,
        }
    }
    // A function that was added or removed may change the meaning of every call of its name: it may hide another function, or be
    // a better overload.
    if !moved.is_empty() {
        for file in new.values().flatten() {
            let parts = file.parts()?;
            let unchanged = parts.functions.iter().filter(|f| !changed.contains(&f.name) && !moved.contains(&f.name));
            let mut words = unchanged.map(|function| &function.words).chain([&parts.rest_words]);
            if words.any(|words| moved.iter().any(|name| words.contains(name))) {
                return None;
            }
        }
    }
    changed.extend(moved);
    Some(changed)
}

/// Adds the names of functions whose code differs to `changed`, and the names of functions that only one version has to
/// `moved`. `None` if other code differs, or the order of functions.
fn compare(old: &Parts, new: &Parts, changed: &mut BTreeSet<Box<str>>, moved: &mut BTreeSet<Box<str>>) -> Option<()> {
    if old.rest != new.rest {
        return None;
    }
    let (old_places, new_places) = (places(old)?, places(new)?);
    let is_in_both = |f: &&Function| old_places.contains(&place(f)) && new_places.contains(&place(f));
    let common = || old.functions.iter().filter(is_in_both).zip(new.functions.iter().filter(is_in_both));
    if common().any(|(old, new)| place(old) != place(new)) {
        return None;
    }
    changed.extend(common().filter(|(old, new)| old.body != new.body).map(|(old, _)| old.name.clone()));
    let all = old.functions.iter().chain(&new.functions);
    moved.extend(all.filter(|f| !is_in_both(f)).map(|function| function.name.clone()));
    Some(())
}

/// Identifies a function in its file: its place and its head.
fn place(function: &Function) -> (usize, &str) {
    (function.place, &function.head)
}

/// The places of a file's functions. `None` if two functions have the same place and head.
fn places(parts: &Parts) -> Option<HashSet<(usize, &str)>> {
    let places: HashSet<_> = parts.functions.iter().map(place).collect();
    (places.len() == parts.functions.len()).then_some(places)
}
