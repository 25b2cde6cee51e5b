//! The declarations that a name can mean.

use super::name::{NameAt, name_at};
use super::types::before_dot;
use super::view::{Found, View};
use crate::shader::TreePath;

/// The declarations that the name at a byte of the current file means: several of an overloaded function.
pub fn meant(view: &View, byte: usize) -> Vec<Found<'_>> {
    name_at(view.file().text(), byte).map(|name| meant_by(view, &view.current, &name)).unwrap_or_default()
}

/// The same for a name in any file.
pub fn meant_by<'a>(view: &'a View, path: &'a TreePath, name: &NameAt) -> Vec<Found<'a>> {
    let is_declared =
        || view.files.get(path).is_some_and(|file| file.symbols.all.iter().any(|of| of.bytes == name.bytes));
    if !name.is_member || is_declared() {
        return view.plain(path, &name.text, &name.bytes);
    }
    let Some(owner) = before_dot(view, path, name.bytes.start) else { return Vec::new() };
    let members = view.members(&view.visible(path), &owner.name);
    members.into_iter().filter(|found| found.symbol.name == name.text).collect()
}
