//! Requests of the client.

use std::collections::BTreeSet;
use std::path::PathBuf;

use lsp_server::{ErrorCode, Request, RequestId};
use lsp_types::{
    CodeActionParams, ColorPresentationParams, CompletionParams, DocumentColorParams, DocumentSymbolParams,
    ExecuteCommandParams, FoldingRangeParams, GotoDefinitionParams, HoverParams, InlayHintParams, ReferenceParams,
    RenameParams, SignatureHelpParams, TextDocumentPositionParams, Uri, WorkspaceSymbolParams,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::event::Event;
use super::state::State;
use super::values::Pin;
use super::view::View;
use super::{actions, colors, completion, hints, hover, navigation, outline, rename, signature, uri, window};
use crate::shader::is_specula_tree;

/// The answer to a request: now, or later by another thread.
pub enum Answer {
    /// The result.
    Now(Value),
    /// The result follows.
    Later,
}

/// Why there is no result.
pub type Refused = (ErrorCode, String);

/// Pins a pixel.
const PIN: &str = "specula.pinPixel";
/// Ends that.
const UNPIN: &str = "specula.unpinPixel";

/// Opens a window on the tree of a file.
const OPEN_WINDOW: &str = "specula.openWindow";

/// The capabilities of the server.
pub fn capabilities() -> Value {
    json!({
        "positionEncoding": "utf-16",
        "textDocumentSync": { "openClose": true, "change": 2, "save": { "includeText": false } },
        "completionProvider": { "triggerCharacters": [".", "@", "\"", "=", "#", "/", " "] },
        "hoverProvider": true,
        "signatureHelpProvider": { "triggerCharacters": ["(", ","] },
        "definitionProvider": true,
        "referencesProvider": true,
        "documentSymbolProvider": true,
        "workspaceSymbolProvider": true,
        "renameProvider": { "prepareProvider": true },
        "foldingRangeProvider": true,
        "colorProvider": true,
        "codeActionProvider": { "codeActionKinds": ["quickfix", "refactor.extract", "source.specula"] },
        "inlayHintProvider": true,
        "executeCommandProvider": { "commands": [PIN, UNPIN, OPEN_WINDOW, actions::SHOW] },
        "workspace": { "workspaceFolders": { "supported": true, "changeNotifications": true } },
    })
}

/// Answers a request.
///
/// # Errors
/// The method or its parameters are unknown, or it cannot be done.
pub fn answer(state: &mut State, request: &Request) -> Result<Answer, Refused> {
    let params = &request.params;
    match request.method.as_str() {
        "textDocument/completion" => {
            let at = parsed::<CompletionParams>(params)?.text_document_position;
            viewed(state, &at.text_document.uri, |view| completion::completion(view, at.position))
        }
        "textDocument/hover" => {
            let at = parsed::<HoverParams>(params)?.text_document_position_params;
            let values = values_at(state, &at);
            viewed(state, &at.text_document.uri, |view| hover::hover(view, at.position, values))
        }
        "textDocument/signatureHelp" => {
            let at = parsed::<SignatureHelpParams>(params)?.text_document_position_params;
            viewed(state, &at.text_document.uri, |view| signature::signature_help(view, at.position))
        }
        "textDocument/definition" => {
            let at = parsed::<GotoDefinitionParams>(params)?.text_document_position_params;
            viewed(state, &at.text_document.uri, |view| navigation::definition(view, at.position))
        }
        "textDocument/references" => {
            let of = parsed::<ReferenceParams>(params)?;
            let (at, all) = (of.text_document_position, of.context.include_declaration);
            viewed(state, &at.text_document.uri, |view| navigation::references(view, at.position, all))
        }
        "textDocument/documentSymbol" => {
            let uri = parsed::<DocumentSymbolParams>(params)?.text_document.uri;
            viewed(state, &uri, |view| outline::document_symbols(view.file()))
        }
        "textDocument/foldingRange" => {
            let uri = parsed::<FoldingRangeParams>(params)?.text_document.uri;
            viewed(state, &uri, |view| outline::folding(view.file()))
        }
        "textDocument/documentColor" => {
            let uri = parsed::<DocumentColorParams>(params)?.text_document.uri;
            viewed(state, &uri, |view| colors::colors(view.file()))
        }
        "textDocument/colorPresentation" => {
            let of = parsed::<ColorPresentationParams>(params)?;
            viewed(state, &of.text_document.uri, |view| colors::presentation(view.file(), of.color, of.range))
        }
        "workspace/symbol" => now(workspace_symbols(state, &parsed::<WorkspaceSymbolParams>(params)?.query)),
        "textDocument/codeAction" => {
            let of = parsed::<CodeActionParams>(params)?;
            let path = uri::path_of(&of.text_document.uri);
            let diagnostics = path.map(|path| state.diagnostics_of(&path).to_vec()).unwrap_or_default();
            let has_window = !window::sockets(state.socket.as_deref()).is_empty();
            viewed(state, &of.text_document.uri, |view| actions::actions(view, of.range, &diagnostics, has_window))
        }
        "textDocument/prepareRename" => {
            let at = parsed::<TextDocumentPositionParams>(params)?;
            let view = view(state, &at.text_document.uri)?;
            refused(rename::prepare(&view, at.position))
        }
        "textDocument/rename" => {
            let of = parsed::<RenameParams>(params)?;
            let at = of.text_document_position;
            let view = view(state, &at.text_document.uri)?;
            refused(rename::rename(&view, at.position, &of.new_name))
        }
        "textDocument/inlayHint" => inlay_hints(state, &parsed(params)?),
        "workspace/executeCommand" => execute(state, &request.id, &parsed(params)?),
        unknown => Err((ErrorCode::MethodNotFound, format!("there is no method `{unknown}`"))),
    }
}

fn parsed<T: DeserializeOwned>(params: &Value) -> Result<T, Refused> {
    serde_json::from_value(params.clone()).map_err(|error| (ErrorCode::InvalidParams, error.to_string()))
}

fn now(value: impl Serialize) -> Result<Answer, Refused> {
    serde_json::to_value(value).map(Answer::Now).map_err(|error| (ErrorCode::InternalError, error.to_string()))
}

fn refused(result: Result<impl Serialize, String>) -> Result<Answer, Refused> {
    now(result.map_err(|why| (ErrorCode::RequestFailed, why))?)
}

fn view(state: &mut State, uri: &Uri) -> Result<View, Refused> {
    let view = state.trees.view(&state.documents, uri);
    view.ok_or_else(|| {
        (ErrorCode::InvalidParams, format!("{} is neither open nor a file of a shader tree", uri.as_str()))
    })
}

fn viewed<T: Serialize>(state: &mut State, uri: &Uri, ask: impl FnOnce(&View) -> T) -> Result<Answer, Refused> {
    now(ask(&view(state, uri)?))
}

/// The declarations in the trees of the open files and of the editor's folders.
fn workspace_symbols(state: &mut State, query: &str) -> Vec<lsp_types::WorkspaceSymbol> {
    let open = state.documents.with_paths().filter_map(|(path, _)| state.root(path));
    let folders = state.folders.iter().flat_map(|folder| [folder.clone(), folder.join("shaders")]);
    let roots: BTreeSet<PathBuf> = open.chain(folders.filter(|folder| is_specula_tree(folder))).collect();
    let mut out = Vec::new();
    for root in roots {
        let view = state.trees.of_tree(&state.documents, &root, None);
        out.extend(view.into_iter().flat_map(|view| outline::workspace_symbols(&view, query)));
    }
    out
}

/// The values of a line at the pinned pixel.
fn values_at(state: &State, at: &TextDocumentPositionParams) -> Option<String> {
    let document = state.documents.get(&at.text_document.uri)?;
    let path = document.path.as_ref()?;
    let root = state.root(path)?;
    let traced = state.values.of(&root, &super::trees::tree_path(&root, path)?)?;
    hints::values_of(traced, &document.file.source, at.position.line as usize)
}

fn inlay_hints(state: &mut State, of: &InlayHintParams) -> Result<Answer, Refused> {
    let file = state.documents.get(&of.text_document.uri).map(|document| document.file.clone());
    let path = uri::path_of(&of.text_document.uri);
    let place = path.and_then(|path| {
        let root = state.root(&path)?;
        Some((super::trees::tree_path(&root, &path)?, root))
    });
    let (Some(file), Some((path, root))) = (file, place) else { return now(Value::Array(Vec::new())) };
    state.join_windows();
    let asked = state.values.question(&root, &path);
    state.ask(asked);
    match state.values.of(&root, &path) {
        Some(traced) => now(hints::hints(traced, &file.source, of.range)),
        None => now(Value::Array(Vec::new())),
    }
}

fn execute(state: &mut State, request: &RequestId, of: &ExecuteCommandParams) -> Result<Answer, Refused> {
    let wrong = |what: &str| Err((ErrorCode::InvalidParams, format!("{}: expected {what}", of.command)));
    match of.command.as_str() {
        PIN => {
            let number =
                |at: usize| of.arguments.get(at).and_then(Value::as_u64).and_then(|number| u32::try_from(number).ok());
            let (Some(x), Some(y)) = (number(0), number(1)) else {
                return wrong("a pixel as two whole numbers, x and y");
            };
            let (width, height) = state.size;
            if x >= width || y >= height {
                let message = format!("the pixel {x},{y} is outside of the picture ({width}x{height})");
                return Err((ErrorCode::InvalidParams, message));
            }
            let root = root_of(state, of.arguments.get(2))?;
            state.values.pin(Some(Pin { root: root.clone(), at: (x, y), window: None }));
            let asked = state.values.again(state.open_files(&root), BTreeSet::new(), Some(request.clone()));
            state.ask(asked);
            Ok(Answer::Later)
        }
        UNPIN => {
            state.values.pin(None);
            state.following.is_muted = true;
            state.refresh_hints();
            now(Value::Null)
        }
        OPEN_WINDOW => {
            let root = root_of(state, of.arguments.first())?;
            let (open, events, request) = (state.open_window.clone(), state.events.clone(), request.clone());
            // It answers once the window is there.
            let work = move || drop(events.send(Event::Answered(request, open(&root))));
            let started = std::thread::Builder::new().name("specula-lsp-open".to_owned()).spawn(work);
            started.map_err(|error| (ErrorCode::InternalError, error.to_string()))?;
            Ok(Answer::Later)
        }
        actions::SHOW => {
            let text = |at: usize| of.arguments.get(at).and_then(Value::as_str);
            let line = of.arguments.get(1).and_then(Value::as_u64);
            let file = of.arguments.first().and_then(|uri| serde_json::from_value::<Uri>(uri.clone()).ok());
            let (Some(path), Some(line), Some(expression)) = (file.and_then(|uri| uri::path_of(&uri)), line, text(2))
            else {
                return wrong("a file, a line and an expression");
            };
            let expression = format!("{}:{line}:{expression}", path.display());
            let sockets = window::sockets(state.socket.as_deref());
            let (events, request) = (state.events.clone(), request.clone());
            // A window answers when its picture is on screen.
            let work = move || drop(events.send(Event::Answered(request, window::show(&sockets, &expression))));
            let started = std::thread::Builder::new().name("specula-lsp-show".to_owned()).spawn(work);
            started.map_err(|error| (ErrorCode::InternalError, error.to_string()))?;
            Ok(Answer::Later)
        }
        unknown => Err((ErrorCode::InvalidParams, format!("there is no command `{unknown}`"))),
    }
}

/// The folder of the tree of a file that a request names, or of the file that was opened last.
fn root_of(state: &State, named: Option<&Value>) -> Result<PathBuf, Refused> {
    let named = named.and_then(|uri| serde_json::from_value::<Uri>(uri.clone()).ok());
    let path = named.and_then(|uri| uri::path_of(&uri)).or_else(|| state.documents.last.clone());
    path.and_then(|path| state.root(&path))
        .ok_or_else(|| (ErrorCode::RequestFailed, "no file of a shader tree is open".to_owned()))
}
