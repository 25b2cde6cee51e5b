//! Notifications of the client.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use lsp_server::Notification;
use lsp_types::{
    DidChangeTextDocumentParams, DidChangeWatchedFilesParams, DidChangeWorkspaceFoldersParams,
    DidCloseTextDocumentParams, DidOpenTextDocumentParams, DidSaveTextDocumentParams,
};
use serde::de::DeserializeOwned;

use super::state::State;
use super::uri::path_of;

/// Takes note of a notification. Unknown and malformed ones are ignored, as nobody waits for an answer.
pub fn notified(state: &mut State, notification: Notification) {
    let params = notification.params;
    match notification.method.as_str() {
        "textDocument/didOpen" => {
            let Some(DidOpenTextDocumentParams { text_document: opened }) = parsed(params) else { return };
            let path = path_of(&opened.uri);
            state.documents.open(opened.uri, &opened.text);
            path.into_iter().for_each(|path| state.compile(&path));
        }
        "textDocument/didChange" => {
            let Some(changed) = parsed::<DidChangeTextDocumentParams>(params) else { return };
            let uri = changed.text_document.uri;
            if state.documents.change(&uri, &changed.content_changes) {
                path_of(&uri).into_iter().for_each(|path| state.compile(&path));
            }
        }
        "textDocument/didClose" => {
            let Some(DidCloseTextDocumentParams { text_document: closed }) = parsed(params) else { return };
            // The text that was not saved is gone.
            state.documents.close(&closed.uri).into_iter().for_each(|path| state.compile(&path));
        }
        "textDocument/didSave" => {
            let Some(DidSaveTextDocumentParams { text_document: saved, .. }) = parsed(params) else { return };
            path_of(&saved.uri).into_iter().for_each(|path| state.saved(&path));
        }
        "workspace/didChangeWatchedFiles" => {
            let Some(DidChangeWatchedFilesParams { changes }) = parsed(params) else { return };
            let mut by_tree: BTreeMap<PathBuf, BTreeSet<PathBuf>> = BTreeMap::new();
            for path in changes.iter().filter_map(|change| path_of(&change.uri)) {
                if let Some(root) = state.root(&path) {
                    by_tree.entry(root).or_default().insert(path);
                }
            }
            by_tree.iter().for_each(|(root, paths)| state.changed_on_disk(root, paths));
        }
        "workspace/didChangeWorkspaceFolders" => {
            let Some(DidChangeWorkspaceFoldersParams { event }) = parsed(params) else { return };
            let removed: Vec<PathBuf> = event.removed.iter().filter_map(|folder| path_of(&folder.uri)).collect();
            state.folders.retain(|folder| !removed.contains(folder));
            state.folders.extend(event.added.iter().filter_map(|folder| path_of(&folder.uri)));
        }
        _ => {}
    }
}

fn parsed<T: DeserializeOwned>(params: serde_json::Value) -> Option<T> {
    serde_json::from_value(params).map_err(|error| tracing::warn!("a notification is not understood: {error}")).ok()
}
