//! A client of the protocol for tests.

use std::collections::VecDeque;
use std::io::{BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;

use serde_json::{Value, json};

use crate::support::process::{PATIENCE, specula};
use crate::support::{Tree, line_of};

/// A running server, and what it has told and nobody has looked at. Dropping it kills it.
pub struct Client {
    child: Child,
    stdin: Option<ChildStdin>,
    messages: Receiver<Value>,
    told: VecDeque<Value>,
    requests: i64,
}

impl Client {
    /// Starts a server with options, without a handshake.
    pub fn spawn(folder: &Path, options: &[&str]) -> Self {
        Self::spawn_as(specula(folder), options)
    }

    fn spawn_as(mut command: Command, options: &[&str]) -> Self {
        let command =
            command.arg("lsp").args(options).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::inherit());
        let mut child = command.spawn().unwrap();
        let (sender, messages) = channel();
        let mut stdout = BufReader::new(child.stdout.take().unwrap());
        std::thread::spawn(move || {
            while let Some(message) = read(&mut stdout) {
                if sender.send(message).is_err() {
                    break;
                }
            }
        });
        Self { stdin: child.stdin.take(), child, messages, told: VecDeque::new(), requests: 0 }
    }

    /// Starts a server that is ready.
    pub fn start(folder: &Path, options: &[&str]) -> Self {
        Self::start_as(specula(folder), folder, options)
    }

    /// The same of a program with an environment of its own.
    pub fn start_as(command: Command, folder: &Path, options: &[&str]) -> Self {
        let mut client = Self::spawn_as(command, options);
        let capabilities = json!({ "workspace": { "inlayHint": { "refreshSupport": true } } });
        let params = json!({ "processId": null, "rootUri": uri(folder), "capabilities": capabilities,
            "workspaceFolders": [{ "uri": uri(folder), "name": "tree" }] });
        let result = client.ask("initialize", params);
        assert_eq!(result["serverInfo"]["name"], "specula");
        client.notify("initialized", json!({}));
        client
    }

    /// Writes bytes as they are.
    pub fn write(&mut self, bytes: &[u8]) {
        let stdin = self.stdin.as_mut().unwrap();
        stdin.write_all(bytes).and_then(|()| stdin.flush()).unwrap();
    }

    /// Sends a message.
    pub fn send(&mut self, message: &Value) {
        self.send_all(std::slice::from_ref(message));
    }

    /// Sends messages at once.
    pub fn send_all(&mut self, messages: &[Value]) {
        let framed = messages.iter().map(|message| {
            let body = message.to_string();
            format!("Content-Length: {}\r\n\r\n{body}", body.len())
        });
        self.write(framed.collect::<String>().as_bytes());
    }

    /// Sends a notification.
    pub fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Sends a request. Returns its number.
    pub fn begin(&mut self, method: &str, params: Value) -> i64 {
        let (id, request) = self.request(method, params);
        self.send(&request);
        id
    }

    /// A request that is not sent, and its number.
    pub fn request(&mut self, method: &str, params: Value) -> (i64, Value) {
        self.requests += 1;
        (self.requests, json!({ "jsonrpc": "2.0", "id": self.requests, "method": method, "params": params }))
    }

    /// How many messages with a method have come that nobody has looked at.
    pub fn count(&self, method: &str) -> usize {
        self.told.iter().filter(|message| message["method"] == method).count()
    }

    /// The next message that fits. Others are kept.
    #[track_caller]
    pub fn until(&mut self, what: &str, fits: impl Fn(&Value) -> bool) -> Value {
        if let Some(at) = self.told.iter().position(&fits) {
            return self.told.remove(at).unwrap();
        }
        let deadline = Instant::now() + PATIENCE;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let Ok(message) = self.messages.recv_timeout(left) else {
                panic!("waited in vain for {what}; told: {:#?}", self.told);
            };
            if fits(&message) {
                return message;
            }
            self.told.push_back(message);
        }
    }

    /// The answer to a request, with its result or its error.
    #[track_caller]
    pub fn answer(&mut self, id: i64) -> Value {
        self.until(&format!("the answer to request {id}"), |message| message["id"] == id && message["method"].is_null())
    }

    /// Sends a request and returns its result.
    #[track_caller]
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.begin(method, params);
        let answer = self.answer(id);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Sends a request and returns why it fails.
    #[track_caller]
    pub fn refused(&mut self, method: &str, params: Value) -> String {
        let id = self.begin(method, params);
        let answer = self.answer(id);
        answer["error"]["message"].as_str().unwrap_or_else(|| panic!("{method} did not fail: {answer}")).to_owned()
    }

    /// Opens a file with this text.
    pub fn open(&mut self, path: &Path, text: &str) {
        let document = json!({ "uri": uri(path), "languageId": "glsl", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Replaces the whole text of an open file.
    pub fn change(&mut self, path: &Path, text: &str) {
        let document = json!({ "uri": uri(path), "version": 2 });
        self.notify(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": [{ "text": text }] }),
        );
    }

    /// The next diagnostics of a file that fit.
    #[track_caller]
    pub fn diagnostics(&mut self, path: &Path, fits: impl Fn(&[Value]) -> bool) -> Vec<Value> {
        let uri = uri(path);
        let message = self.until(&format!("diagnostics of {}", path.display()), |message| {
            let is_of = message["method"] == "textDocument/publishDiagnostics" && message["params"]["uri"] == *uri;
            is_of && fits(message["params"]["diagnostics"].as_array().unwrap())
        });
        message["params"]["diagnostics"].as_array().unwrap().clone()
    }

    /// Forgets all diagnostics so far.
    pub fn forget(&mut self) {
        self.told.clear();
    }

    /// Ends the input. The server has to end by itself; returns its exit code.
    pub fn end(mut self) -> Option<i32> {
        drop(self.stdin.take());
        self.code()
    }

    /// Says goodbye as an editor does.
    pub fn quit(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null), Value::Null);
        self.notify("exit", Value::Null);
        assert_eq!(self.code(), Some(0));
    }

    /// Waits until the server has ended.
    #[track_caller]
    pub fn code(&mut self) -> Option<i32> {
        let deadline = Instant::now() + PATIENCE;
        // The channel closes when the server does.
        while self.messages.recv_timeout(deadline.saturating_duration_since(Instant::now())).is_ok() {}
        while Instant::now() < deadline {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.code();
            }
            std::thread::yield_now();
        }
        panic!("the server did not end");
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn read(from: &mut impl std::io::BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if from.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim() {
            "" => break,
            line => length = line.strip_prefix("Content-Length: ").map_or(length, |number| number.parse().unwrap()),
        }
    }
    let mut body = vec![0; length];
    from.read_exact(&mut body).ok()?;
    serde_json::from_slice(&body).ok()
}

/// The URI of a path without odd characters.
pub fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

/// A place in a text, as the protocol counts: of the first `what`, and some characters behind its begin.
pub fn place(text: &str, what: &str, plus: usize) -> Value {
    let at = text.find(what).unwrap_or_else(|| panic!("no `{what}`")) + plus;
    let start = text[..at].rfind('\n').map_or(0, |at| at + 1);
    json!({ "line": text[..at].matches('\n').count(), "character": text[start..at].encode_utf16().count() })
}

/// The parameters of a question about a place.
pub fn at(path: &Path, text: &str, what: &str, plus: usize) -> Value {
    json!({ "textDocument": { "uri": uri(path) }, "position": place(text, what, plus) })
}

/// A server over a tree of `specula new`, in which a file is open as it is on disk.
pub struct Opened {
    pub tree: Tree,
    pub client: Client,
    pub path: PathBuf,
    pub text: String,
}

impl Opened {
    pub fn new(file: &str) -> Self {
        Self::with(file, &[])
    }

    pub fn with(file: &str, options: &[&str]) -> Self {
        let tree = Tree::new();
        let mut client = Client::start(&tree.root(), options);
        let (path, text) = (tree.path(file), tree.read(file));
        client.open(&path, &text);
        Self { tree, client, path, text }
    }

    /// Changes the text in the editor.
    pub fn edit(&mut self, from: &str, to: &str) {
        assert!(self.text.contains(from), "no `{from}`");
        self.text = self.text.replacen(from, to, 1);
        self.client.change(&self.path, &self.text);
    }

    /// A question about a place of the open file.
    #[track_caller]
    pub fn ask(&mut self, method: &str, what: &str, plus: usize) -> Value {
        let params = at(&self.path, &self.text, what, plus);
        self.client.ask(&format!("textDocument/{method}"), params)
    }

    /// The labels of what can stand at a place.
    #[track_caller]
    pub fn labels(&mut self, what: &str, plus: usize) -> Vec<String> {
        let items = self.ask("completion", what, plus);
        items.as_array().unwrap().iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// The line of a text, from 0.
    pub fn line(&self, what: &str) -> u32 {
        line_of(&self.text, what) - 1
    }
}
