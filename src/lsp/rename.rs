//! Rename: all uses of a name in all files of the tree, if the new name is free and the old one is the author's.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use lsp_types::{Position, Range as Span, TextEdit, Uri, WorkspaceEdit};

use super::meaning::meant_by;
use super::name::{NameAt, name_at};
use super::navigation::{annotated, names, uses};
use super::types::before_dot;
use super::view::{Found, View};
use crate::shader::TreePath;
use crate::shader::glsl::{built_in, is_name, is_reserved, is_word};
use crate::shader::symbols::SymbolKind;

/// The file of the contract.
const CONTRACT: &str = "interface.glsl";
/// Functions that Specula itself knows by their names.
const KNOWN: [&str; 8] = [
    "main",
    "mainImage",
    "user_surface",
    "user_light",
    "user_radiance",
    "user_vertex",
    "user_background",
    "user_display",
];

/// The name at a place, if it can be renamed.
///
/// # Errors
/// Why it cannot.
pub fn prepare(view: &View, place: Position) -> Result<Span, String> {
    let file = view.file();
    let name = name_at(file.text(), file.source.byte(place)).ok_or("there is no name here")?;
    let meant = meant_by(view, &view.current, &name);
    check_old(view, &name.text, &meant)?;
    Ok(file.source.span(name.bytes))
}

/// The edits that give a name another one everywhere.
///
/// # Errors
/// Why it cannot be done.
#[allow(clippy::mutable_key_type, reason = "the protocol's map has URIs as keys")]
pub fn rename(view: &View, place: Position, new: &str) -> Result<WorkspaceEdit, String> {
    let file = view.file();
    let name = name_at(file.text(), file.source.byte(place)).ok_or("there is no name here")?;
    let meant = meant_by(view, &view.current, &name);
    check_old(view, &name.text, &meant)?;
    check_new(new)?;
    let uses = uses(view, &meant);
    if new != name.text {
        check_free(view, &meant, &uses.iter().map(|of| &of.path).collect(), new)?;
    }
    check_told(view, &meant)?;
    let mut changes: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
    for of in uses {
        if let Some(file) = view.files.get(&of.path) {
            let edit = TextEdit::new(file.source.span(of.bytes), new.to_owned());
            changes.entry(file.uri.clone()).or_default().push(edit);
        }
    }
    Ok(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() })
}

fn check_old(view: &View, name: &str, meant: &[Found<'_>]) -> Result<(), String> {
    let Some(first) = meant.first() else {
        return Err(match built_in(name).is_some() || is_reserved(name) {
            true => format!("`{name}` is built into GLSL"),
            false => format!("`{name}` is not declared in this tree"),
        });
    };
    if view.root.join(CONTRACT).is_file() && meant.iter().any(|found| found.path.as_str() == CONTRACT) {
        return Err(format!("`{name}` is part of the contract: Specula writes {CONTRACT} and knows the name"));
    }
    if first.symbol.is_global() && (KNOWN.contains(&name) || name == "Params") {
        return Err(format!("Specula calls `{name}` by its name"));
    }
    if matches!(first.symbol.kind, SymbolKind::Mode | SymbolKind::Pass | SymbolKind::Texture) {
        return Err(format!("`{name}` is the name of an annotation, which settings and other passes use, too"));
    }
    let is_image = first.symbol.type_name.starts_with("sampler") && first.symbol.is_global();
    if let Some(pass) = annotated(view, name).next().filter(|_| is_image) {
        return Err(format!("`{name}` is the image that {} declares", pass.path));
    }
    Ok(())
}

/// Checks that no member of an unknown value may be the one that is renamed.
fn check_told(view: &View, meant: &[Found<'_>]) -> Result<(), String> {
    let Some(first) = meant.first().filter(|found| found.symbol.kind == SymbolKind::Member) else { return Ok(()) };
    let seeing: BTreeSet<&TreePath> = meant.iter().flat_map(|found| view.includers(found.path)).collect();
    for path in seeing {
        let Some(file) = view.files.get(path) else { continue };
        let members = names(file.text(), &first.symbol.name).into_iter().filter(|of| of.is_member);
        let is_untold =
            |of: &NameAt| meant_by(view, path, of).is_empty() && before_dot(view, path, of.bytes.start).is_none();
        if let Some(of) = members.into_iter().find(is_untold) {
            let line = file.source.line_of(of.bytes.start) + 1;
            return Err(format!("the type of the value before `.{}` at {path}:{line} cannot be told", of.text));
        }
    }
    Ok(())
}

fn check_new(new: &str) -> Result<(), String> {
    if !is_name(new) || !new.chars().all(is_word) {
        return Err(format!("`{new}` is no name: expected letters, digits and `_`, and no digit first"));
    }
    if is_reserved(new) {
        return Err(format!("`{new}` is reserved in GLSL"));
    }
    Ok(())
}

/// Checks that nothing else has the new name where the old one is used.
fn check_free(view: &View, meant: &[Found<'_>], used: &BTreeSet<&TreePath>, new: &str) -> Result<(), String> {
    let Some(first) = meant.first() else { return Ok(()) };
    let clash = |path: &TreePath, byte: usize| {
        let line = view.files.get(path).map_or(0, |file| file.source.line_of(byte) + 1);
        Err(format!("`{new}` is used already, at {path}:{line}"))
    };
    if first.symbol.kind == SymbolKind::Member {
        let all = first.file.symbols.members(&first.symbol.owner);
        return match all.into_iter().find(|member| member.name == new) {
            Some(member) => clash(first.path, member.bytes.start),
            None => Ok(()),
        };
    }
    // A local name: anything of its function. Another one: anything of the files that see it.
    let within = first.symbol.scope.as_ref().and_then(|_| first.file.symbols.function_at(first.symbol.bytes.start));
    let files: BTreeMap<&TreePath, _> = match within {
        Some(function) => BTreeMap::from([(first.path, function.whole.clone())]),
        None => {
            let seeing = meant.iter().flat_map(|found| view.includers(found.path)).chain(used.iter().copied());
            seeing.map(|path| (path, 0..usize::MAX)).collect()
        }
    };
    for (path, bytes) in files {
        let Some(file) = view.files.get(path) else { continue };
        let found = names(file.text(), new).into_iter().find(|of| !of.is_member && bytes.contains(&of.bytes.start));
        // Members have names of their own.
        let is_member = |at: usize| file.symbols.at(at).is_some_and(|symbol| symbol.kind == SymbolKind::Member);
        if let Some(found) = found.filter(|of| !is_member(of.bytes.start)) {
            return clash(path, found.bytes.start);
        }
    }
    if built_in(new).is_some() {
        return Err(format!("`{new}` is built into GLSL"));
    }
    Ok(())
}
