//! Definitions and references, over all files of a tree.

use std::collections::BTreeSet;

use lsp_types::{Location, Position, Range as Span};

use super::meaning::{meant, meant_by};
use super::name::{NameAt, is_behind_dot, name_at};
use super::source_file::SourceFile;
use super::view::{Found, View};
use crate::shader::TreePath;
use crate::shader::glsl::{TokenKind, tokens};
use crate::shader::symbols::SymbolKind;

/// A use of a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// The file.
    pub path: TreePath,
    /// The bytes of the name in it.
    pub bytes: std::ops::Range<usize>,
}

/// Where a name is declared, or the file that an include means.
pub fn definition(view: &View, place: Position) -> Vec<Location> {
    let file = view.file();
    let byte = file.source.byte(place);
    let includes = &file.symbols.includes;
    if let Some((name, _)) = includes.iter().find(|(_, bytes)| bytes.start <= byte && byte <= bytes.end) {
        let included = view.included(&view.current, name).and_then(|path| view.files.get(path));
        return included.map(|file| Location::new(file.uri.clone(), Span::default())).into_iter().collect();
    }
    let meant = meant(view, byte);
    // A function without a body is where it is announced only.
    let has_body = |found: &&Found<'_>| found.symbol.has_body;
    let is_announced = meant.iter().any(|found| found.symbol.has_body);
    let shown =
        meant.iter().filter(|found| !is_announced || has_body(found) || found.symbol.kind != SymbolKind::Function);
    let mut out: Vec<Location> = shown.map(|found| found.file.location(found.symbol)).collect();
    if let Some(name) = name_at(file.text(), byte)
        && meant.iter().all(|found| found.symbol.type_name.starts_with("sampler"))
    {
        out.extend(annotated(view, &name.text).map(|found| found.file.location(found.symbol)));
    }
    out
}

/// The annotations that declare a pass or a texture of this name.
pub fn annotated<'a>(view: &'a View, name: &'a str) -> impl Iterator<Item = Found<'a>> {
    view.files.iter().flat_map(move |(path, file)| {
        let is_it = move |symbol: &&crate::shader::symbols::Symbol| {
            matches!(symbol.kind, SymbolKind::Pass | SymbolKind::Texture) && symbol.name == name
        };
        file.symbols.all.iter().filter(is_it).map(move |symbol| Found { path, file, symbol })
    })
}

/// All uses of what the name at a place means, with or without its declarations.
pub fn references(view: &View, place: Position, with_declarations: bool) -> Vec<Location> {
    let meant = meant(view, view.file().source.byte(place));
    let uses = uses(view, &meant);
    let declared = |of: &Use| meant.iter().any(|found| *found.path == of.path && found.symbol.bytes == of.bytes);
    let shown = uses.iter().filter(|of| with_declarations || !declared(of));
    shown
        .filter_map(|of| {
            let file = view.files.get(&of.path)?;
            Some(Location::new(file.uri.clone(), file.source.span(of.bytes.clone())))
        })
        .collect()
}

/// All uses of declarations, with these. All have the same name.
pub fn uses(view: &View, meant: &[Found<'_>]) -> Vec<Use> {
    let Some(first) = meant.first() else { return Vec::new() };
    let name = &first.symbol.name;
    // A local name is used in its function alone.
    let is_local = first.symbol.scope.is_some();
    let mut out = Vec::new();
    for (path, file) in &view.files {
        if (is_local && path != first.path) || !file.text().contains(name.as_str()) || file.is_too_long() {
            continue;
        }
        let names = names(file.text(), name);
        let is_meant = |found: Vec<Found<'_>>| found.iter().any(|found| meant.iter().any(|known| known.is(found)));
        let used: Vec<NameAt> = match first.symbol.is_global() {
            // Where the file sees them, all that nothing nearer hides.
            true if names.is_empty() || !is_meant(view.globals(&view.visible(path), name)) => continue,
            true => names.into_iter().filter(|of| !of.is_member && !is_hidden(file, of)).collect(),
            false => names.into_iter().filter(|of| is_meant(meant_by(view, path, of))).collect(),
        };
        out.extend(used.into_iter().map(|of| Use { path: path.clone(), bytes: of.bytes }));
    }
    let mut seen = BTreeSet::new();
    out.retain(|of: &Use| seen.insert((of.path.clone(), of.bytes.start)));
    out
}

/// Whether a name means something nearer than a global declaration.
fn is_hidden(file: &SourceFile, name: &NameAt) -> bool {
    let own = file.symbols.all.iter().find(|symbol| symbol.bytes == name.bytes);
    match own {
        Some(symbol) => !symbol.is_global(),
        None => file.symbols.locals(name.bytes.start).any(|symbol| symbol.name == name.text),
    }
}

/// All places of a name in a text: in code, in directives, and behind `when=` in annotations.
pub fn names(text: &str, name: &str) -> Vec<NameAt> {
    let mut out = Vec::new();
    for token in tokens(text) {
        match token.kind {
            TokenKind::Comment if token.text.starts_with("//@") => {
                let key = format!("when={name}");
                let ends = |at: usize| !token.text[at + key.len()..].starts_with(crate::shader::glsl::is_word);
                let found = token.text.match_indices(&key).map(|(at, _)| at).filter(|at| ends(*at));
                let start = |at: usize| token.bytes.start + at + "when=".len();
                out.extend(found.map(|at| NameAt {
                    text: name.to_owned(),
                    bytes: start(at)..start(at) + name.len(),
                    is_member: false,
                }));
            }
            TokenKind::Comment => {}
            _ => {
                if token.kind == TokenKind::Word && token.text == name {
                    out.push(NameAt {
                        text: name.to_owned(),
                        bytes: token.bytes.clone(),
                        is_member: is_behind_dot(text, token.bytes.start),
                    });
                }
            }
        }
    }
    out
}
