//! The state of the server: the open files, the trees that are compiled, and the pinned pixel.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, at, never};
use lsp_server::{Notification, Request, RequestId, Response};
use lsp_types::{PublishDiagnosticsParams, Uri};

use super::compiling::{Compiling, mended};
use super::diagnostics::{ByFile, shown};
use super::documents::Documents;
use super::event::Event;
use super::following::Following;
use super::pixel_trace::{OpenTree, PixelTrace};
use super::refreshes::Refreshes;
use super::traced::{Asked, Pinned, Traced};
use super::transport::Outgoing;
use super::trees::{Trees, open_in, root_of, tree_path};
use super::uri::uri_of;
use super::values::{Pin, Values};
use crate::shader::{Compiler, Diagnostic, TreePath, Watcher};

/// A tree with an open file.
struct CompiledTree {
    compiling: Compiling,
    /// Reports changes on disk until it is dropped.
    watcher: Option<Watcher>,
    /// The diagnostics that the client has.
    shown: ByFile,
}

/// The options of the server.
pub struct Config {
    /// Opens trees for the values at a pixel.
    pub open: OpenTree,
    /// Width and height of the picture in which pixels are pinned.
    pub size: (u32, u32),
    /// The socket of the window that is asked; without it, any of the user.
    pub socket: Option<PathBuf>,
    /// Opens a window.
    pub open_window: OpenWindow,
}

/// Opens a window on the tree in a folder, and returns once it has a picture.
pub type OpenWindow = Arc<dyn Fn(&Path) -> Result<(), String> + Send + Sync>;

/// All of it.
pub struct State {
    /// The open files.
    pub documents: Documents,
    /// Texts on disk.
    pub trees: Trees,
    /// The pinned pixel.
    pub values: Values,
    /// Folders of the editor.
    pub folders: Vec<PathBuf>,
    /// Whether the client takes a request to ask for hints again.
    pub can_refresh: bool,
    /// See [`Config`].
    pub size: (u32, u32),
    /// See [`Config`].
    pub socket: Option<PathBuf>,
    /// See [`Config`].
    pub open_window: OpenWindow,
    /// To the client.
    pub out: Outgoing,
    /// To the server's thread.
    pub events: Sender<Event>,
    compiler: Arc<Compiler>,
    compiled: BTreeMap<PathBuf, CompiledTree>,
    open: Option<OpenTree>,
    tracing: Option<PixelTrace>,
    refreshes: Refreshes,
    /// The windows that run.
    pub following: Following,
    requests: i32,
}

impl State {
    /// Nothing is open yet.
    pub fn new(config: Config, compiler: Arc<Compiler>, out: Outgoing, events: Sender<Event>) -> Self {
        Self {
            documents: Documents::default(),
            trees: Trees::default(),
            values: Values::default(),
            folders: Vec::new(),
            can_refresh: false,
            size: config.size,
            socket: config.socket,
            open_window: config.open_window,
            out,
            events,
            compiler,
            compiled: BTreeMap::new(),
            open: Some(config.open),
            tracing: None,
            refreshes: Refreshes::default(),
            following: Following::default(),
            requests: 0,
        }
    }

    /// The tree that a file belongs to, also if its folder is no tree any more.
    pub fn root(&self, path: &Path) -> Option<PathBuf> {
        root_of(path).or_else(|| self.compiled.keys().rev().find(|root| path.starts_with(root)).cloned())
    }

    /// Compiles the tree of a file, whose text may have changed.
    pub fn compile(&mut self, path: &Path) {
        let Some(root) = self.root(path) else { return };
        let changed = tree_path(&root, path).into_iter().collect();
        self.compile_tree(&root, changed);
    }

    /// Compiles a tree with the texts of the editor.
    fn compile_tree(&mut self, root: &Path, changed: BTreeSet<TreePath>) {
        if !self.compiled.contains_key(root) {
            let compiling = match Compiling::start(root, &self.compiler, self.events.clone()) {
                Ok(compiling) => compiling,
                Err(error) => return tracing::error!("nothing is compiled: {error}"),
            };
            let (events, of) = (self.events.clone(), root.to_owned());
            let watcher = Watcher::new(Some(root), &[], move |batch| {
                let _ = events.send(Event::Changed(of.clone(), batch.paths));
            });
            let watcher = watcher.map_err(|error| tracing::warn!("changes on disk are not seen: {error}")).ok();
            self.compiled.insert(root.to_owned(), CompiledTree { compiling, watcher, shown: ByFile::new() });
        }
        let texts = open_in(&self.documents, root).map(|(path, file)| (path, file.source.text.clone())).collect();
        if let Some(tree) = self.compiled.get(root) {
            tree.compiling.compile(texts, changed);
        }
    }

    /// Takes note of files that have changed on disk.
    pub fn changed_on_disk(&mut self, root: &Path, paths: &BTreeSet<PathBuf>) {
        let changed: BTreeSet<TreePath> = paths.iter().filter_map(|path| tree_path(root, path)).collect();
        if self.compiled.contains_key(root) {
            self.compile_tree(root, changed.clone());
        }
        // A window tells when it shows the change.
        if self.values.pinned().is_some_and(|pin| pin.root == root && pin.window.is_none()) {
            let asked = self.values.again(self.open_files(root), changed, None);
            self.ask(asked);
        }
    }

    /// Takes note of a save, where changes on disk are not seen.
    pub fn saved(&mut self, path: &Path) {
        let Some(root) = self.root(path) else { return };
        if self.compiled.get(&root).is_none_or(|tree| tree.watcher.is_none()) {
            self.changed_on_disk(&root, &BTreeSet::from([path.to_owned()]));
        }
    }

    /// The open files of a tree.
    pub fn open_files(&self, root: &Path) -> BTreeSet<TreePath> {
        open_in(&self.documents, root).map(|(path, _)| path).collect()
    }

    /// Joins the windows that run, to follow the pixels that are pinned there.
    pub fn join_windows(&mut self) {
        self.following.look(self.socket.as_deref(), &self.events);
    }

    /// Follows the pixel that is pinned in a window of the tree of an open file. The picture may be another one each time. Of several windows
    /// it is the one with the last click, and a pixel that the editor has pinned or unpinned counts until the next click.
    pub fn pinned_in_window(&mut self, pinned: &Pinned) {
        let of_window = |pin: &Pin| pin.window.as_deref() == Some(&*pinned.socket);
        let is_click = self.following.is_click(pinned);
        let tree = pinned.tree.as_ref().and_then(|tree| tree.canonicalize().ok());
        let roots: BTreeSet<PathBuf> = self.documents.with_paths().filter_map(|(path, _)| self.root(path)).collect();
        let root = roots.into_iter().find(|root| tree.is_some() && root.canonicalize().ok() == tree);
        let Some((root, at)) = root.zip(pinned.pixel) else {
            if self.values.pinned().is_some_and(of_window) {
                self.values.pin(None);
                self.refresh_hints();
            }
            return;
        };
        let is_free = self.values.pinned().map_or(!self.following.is_muted, of_window);
        if !is_free && !is_click {
            return;
        }
        self.following.is_muted = false;
        // The values stay until the new ones come, if the pixel is the same.
        let pin = Pin { root: root.clone(), at, window: Some(pinned.socket.clone()) };
        if self.values.pinned() != Some(&pin) {
            self.values.pin(Some(pin));
        }
        let asked = self.values.again(self.open_files(&root), BTreeSet::new(), None);
        self.ask(asked);
    }

    /// Ends the following of a window.
    pub fn window_closed(&mut self, socket: &Path) {
        self.following.closed(socket);
        if self.values.pinned().is_some_and(|pin| pin.window.as_deref() == Some(socket)) {
            self.values.pin(None);
            self.refresh_hints();
        }
    }

    /// Asks for the values at the pinned pixel.
    pub fn ask(&mut self, asked: Option<Asked>) {
        let Some(asked) = asked else { return };
        if let Some(open) = self.open.take() {
            match PixelTrace::start(open, self.events.clone()) {
                Ok(tracing) => self.tracing = Some(tracing),
                Err(error) => tracing::error!("no pixel is traced: {error}"),
            }
        }
        match &self.tracing {
            Some(tracing) => tracing.ask(asked),
            None => {
                let result = Err("this system grants no thread to trace it".to_owned());
                self.traced(&Traced { asked, result });
            }
        }
    }

    /// Takes the values at a pixel, and answers who asked.
    pub fn traced(&mut self, traced: &Traced) {
        let is_current = self.values.take(traced);
        let (x, y) = traced.asked.at;
        for request in &traced.asked.requests {
            self.out.send(match &traced.result {
                Ok((files, proof)) => {
                    let files: Vec<&str> = files.iter().map(|file| file.path.as_str()).collect();
                    let result = serde_json::json!({ "pixel": [x, y], "proof": proof, "files": files });
                    Response::new_ok(request.clone(), result)
                }
                Err(why) => failed(request.clone(), format!("pixel {x},{y}: {why}")),
            });
        }
        if is_current {
            self.refresh_hints();
        }
    }

    /// Asks the client to ask for hints again, now or after a while: see [`Self::send_refresh`].
    pub fn refresh_hints(&mut self) {
        if self.can_refresh {
            self.refreshes.ask();
        }
    }

    /// Sends the request to ask for hints again, if one is due.
    pub fn send_refresh(&mut self) {
        if self.refreshes.take(Instant::now()) {
            self.request("workspace/inlayHint/refresh", serde_json::Value::Null);
        }
    }

    /// Gets a message when [`Self::send_refresh`] has something to send.
    pub fn refresh_timer(&self) -> Receiver<Instant> {
        self.refreshes.due(Instant::now()).map_or_else(never, at)
    }

    /// Sends a request whose answer does not matter.
    pub fn request(&mut self, method: &str, params: serde_json::Value) {
        self.requests = self.requests.wrapping_add(1);
        self.out.send(Request::new(RequestId::from(self.requests), method.to_owned(), params));
    }

    /// Shows the diagnostics of a tree, in place of those before.
    pub fn diagnosed(&mut self, root: &Path, files: ByFile) {
        let Some(tree) = self.compiled.get_mut(root) else { return };
        let before = std::mem::replace(&mut tree.shown, files.clone());
        for path in mended(&before, &files) {
            self.publish(&path, &[]);
        }
        for (path, diagnostics) in &files {
            self.publish(path, diagnostics);
        }
        // A file that was opened or renamed has none before it was compiled.
        let open: Vec<PathBuf> = self.documents.with_paths().map(|(path, _)| path.clone()).collect();
        for path in open
            .iter()
            .filter(|path| path.starts_with(root) && !files.contains_key(*path) && !before.contains_key(*path))
        {
            self.publish(path, &[]);
        }
    }

    /// The diagnostics of a file that the client has.
    pub fn diagnostics_of(&self, path: &Path) -> &[Diagnostic] {
        let tree = self.compiled.values().find(|tree| tree.shown.contains_key(path));
        tree.and_then(|tree| tree.shown.get(path)).map(Vec::as_slice).unwrap_or_default()
    }

    fn publish(&self, path: &Path, diagnostics: &[Diagnostic]) {
        let Some(uri) = self.uri(path) else { return };
        let diagnostics = diagnostics.iter().map(shown).collect();
        let params = PublishDiagnosticsParams { uri, diagnostics, version: None };
        self.out.send(Notification::new("textDocument/publishDiagnostics".to_owned(), params));
    }

    /// The name of a file for the client: its own, if it has the file open.
    fn uri(&self, path: &Path) -> Option<Uri> {
        let open = self.documents.with_paths().find(|(open, _)| *open == path);
        open.map_or_else(|| uri_of(path), |(_, file)| Some(file.uri.clone()))
    }
}

/// The answer that a request has failed.
pub fn failed(request: RequestId, why: String) -> Response {
    Response::new_err(request, lsp_server::ErrorCode::RequestFailed as i32, why)
}
