//! The edit of an action.

use std::collections::HashMap;

use lsp_types::{TextEdit, Uri, WorkspaceEdit};

/// An edit of several files.
#[allow(clippy::mutable_key_type, reason = "the protocol's map has URIs as keys")]
pub fn edit(of_files: impl IntoIterator<Item = (Uri, TextEdit)>) -> WorkspaceEdit {
    let mut changes: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
    for (uri, edit) in of_files {
        changes.entry(uri).or_default().push(edit);
    }
    WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }
}
