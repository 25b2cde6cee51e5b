//! Members of the value in front of a dot.

use lsp_types::{CompletionItem, CompletionItemKind};

use super::names::documentation;
use crate::lsp::types::before_dot;
use crate::lsp::view::View;
use crate::shader::symbols::comment_of;

/// The members of what stands in front of the dot before a byte.
pub fn items(view: &View, byte: usize) -> Vec<CompletionItem> {
    let Some(owner) = before_dot(view, &view.current, byte) else { return Vec::new() };
    if owner.dimensions > 0 {
        let length = CompletionItem::new_simple("length()".to_owned(), "int: number of elements".to_owned());
        return vec![CompletionItem { kind: Some(CompletionItemKind::METHOD), ..length }];
    }
    if let Some(count) = owner.components() {
        return swizzles(count);
    }
    let files = view.visible(&view.current);
    let members = view.members(&files, &owner.name);
    let item = |(at, found): (usize, &crate::lsp::view::Found<'_>)| CompletionItem {
        label: found.symbol.name.clone(),
        kind: Some(CompletionItemKind::FIELD),
        detail: Some(format!("{}{}", found.symbol.type_name, "[]".repeat(found.symbol.dimensions))),
        documentation: documentation(comment_of(found.file.text(), found.symbol)),
        // In the order of the declaration.
        sort_text: Some(format!("{at:04}")),
        ..CompletionItem::default()
    };
    members.iter().enumerate().map(item).collect()
}

/// Components of a vector.
fn swizzles(count: usize) -> Vec<CompletionItem> {
    let all = ["x", "y", "z", "w", "r", "g", "b", "a", "xy", "xz", "yz", "xyz", "rgb", "xyzw", "rgba"];
    let index = |c: char| "xyzw".find(c).or_else(|| "rgba".find(c)).unwrap_or(4);
    let fits = |components: &&str| count > 1 && components.chars().all(|c| index(c) < count);
    let item = |(at, components): (usize, &str)| CompletionItem {
        label: components.to_owned(),
        kind: Some(CompletionItemKind::FIELD),
        sort_text: Some(format!("{at:04}")),
        ..CompletionItem::default()
    };
    all.into_iter().filter(fits).enumerate().map(item).collect()
}
