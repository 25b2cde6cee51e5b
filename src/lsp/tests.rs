//! The shipped tree: every name in it means something, and no question about any place fails.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lsp_types::{Position, Range as Span};

use super::meaning::meant_by;
use super::name::{NameAt, is_behind_dot};
use super::source_file::SourceFile;
use super::source_text::SourceText;
use super::trees::is_glsl;
use super::types::before_dot;
use super::uri::uri_of;
use super::view::View;
use super::{actions, colors, completion, hover, navigation, outline, rename, signature};
use crate::shader::TreePath;
use crate::shader::embedded::{Example, list, read};
use crate::shader::glsl::{TokenKind, built_in, code, is_reserved};

fn file(path: &TreePath, text: &str) -> Arc<SourceFile> {
    let uri = uri_of(&Path::new("/tree").join(path.as_str())).unwrap();
    Arc::new(SourceFile::new(uri, SourceText::new(text)))
}

/// The shipped tree with the files of an example.
fn view(example: Option<Example>) -> View {
    let read = |path: TreePath| {
        let text = String::from_utf8(read(example, &path).unwrap().to_vec()).unwrap();
        (path.clone(), file(&path, &text))
    };
    let files: BTreeMap<_, _> = list(example).into_iter().filter(is_glsl).map(read).collect();
    View::new(PathBuf::from("/tree"), files, TreePath::from("user.glsl"))
}

/// The names of a file whose declaration is not found.
fn unknown(view: &View, path: &TreePath) -> Vec<String> {
    let file = &view.files[path];
    let visible = view.visible(path);
    let globals: BTreeSet<&str> = visible
        .iter()
        .flat_map(|path| view.files[*path].symbols.globals())
        .map(|symbol| symbol.name.as_str())
        .collect();
    let tokens = code(file.text());
    let words = tokens.iter().filter(|token| token.kind == TokenKind::Word);
    let is_unknown = |text: &str, bytes: &std::ops::Range<usize>| {
        if is_behind_dot(file.text(), bytes.start) && !text.starts_with("gl_") {
            let name = NameAt { text: text.to_owned(), bytes: bytes.clone(), is_member: true };
            // Of a vector, its components; of an array, its length.
            let owner = before_dot(view, path, bytes.start);
            let is_part = owner.is_some_and(|owner| owner.components().is_some() || owner.dimensions > 0);
            return !is_part && meant_by(view, path, &name).is_empty();
        }
        let is_local = || file.symbols.locals(bytes.start).any(|symbol| symbol.name == text);
        let is_own = || file.symbols.all.iter().any(|symbol| symbol.bytes == *bytes);
        !is_reserved(text) && built_in(text).is_none() && !globals.contains(text) && !is_local() && !is_own()
    };
    let line = |at: usize| file.source.line_of(at) + 1;
    let found = words.filter(|token| is_unknown(token.text, &token.bytes));
    found.map(|token| format!("{path}:{}: {}", line(token.bytes.start), token.text)).collect()
}

/// Words that mean something in their places alone: qualifiers of layouts and attributes of loops.
const OF_PLACES: [&str; 42] = [
    "set",
    "binding",
    "scalar",
    "constant_id",
    "location",
    "push_constant",
    "local_size_x",
    "local_size_y",
    "local_size_z",
    "buffer_reference",
    "buffer_reference_align",
    "std430",
    "std140",
    "rgba16f",
    "rgba32f",
    "rgba8",
    "rg16f",
    "rg32f",
    "r16f",
    "r32f",
    "r32ui",
    "unroll",
    "dont_unroll",
    "vertices",
    "triangles",
    "quads",
    "equal_spacing",
    "ccw",
    "cw",
    "max_vertices",
    "max_primitives",
    "triangle_strip",
    "line_strip",
    "points",
    "invocations",
    "early_fragment_tests",
    "fractional_odd_spacing",
    "index",
    "r8",
    "lines",
    "perprimitiveEXT",
    "taskPayloadSharedEXT",
];

#[test]
fn every_name_of_the_shipped_tree_has_its_declaration() {
    let view = view(None);
    let unknown: Vec<String> = view.files.keys().flat_map(|path| unknown(&view, path)).collect();
    let is_name = |line: &&String| !OF_PLACES.iter().any(|word| line.ends_with(&format!(" {word}")));
    let unknown: Vec<&String> = unknown.iter().filter(is_name).collect();
    assert!(unknown.is_empty(), "{} names: {unknown:#?}", unknown.len());
}

#[test]
fn no_question_about_any_place_of_the_tree_fails() {
    let mut view = view(Example::named("fur"));
    let paths: Vec<TreePath> = view.files.keys().cloned().collect();
    let mut random = 1_u32;
    let mut next = |below: usize| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 8) as usize % below.max(1)
    };
    for round in 0..300 {
        let path = paths[next(paths.len())].clone();
        let whole = view.files[&path].clone();
        let text = whole.text();
        if round % 3 == 0 {
            // Some of it is being typed.
            let cut = (0..=next(text.len() + 1)).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
            view.files.insert(path.clone(), file(&path, &text[..cut]));
        }
        view.current.clone_from(&path);
        let source = &view.file().source;
        let place = source.place(next(source.text.len() + 1));
        completion::completion(&view, place);
        hover::hover(&view, place, None);
        signature::signature_help(&view, place);
        navigation::definition(&view, place);
        actions::actions(&view, Span::new(place, place), &[], true);
        let renamed = rename::rename(&view, place, "another_name");
        assert!(renamed.is_err() || rename::prepare(&view, place).is_ok(), "{path} {place:?}");
        outline::folding(view.file());
        outline::document_symbols(view.file());
        colors::colors(view.file());
        completion::completion(&view, Position::new(u32::MAX, u32::MAX));
        view.files.insert(path, whole);
    }
}
