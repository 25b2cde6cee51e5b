//! `specula serve` on a tree of its own, under validation, without a display.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::Tree;
use super::process::{PATIENCE, Running, specula};

/// The options of the picture.
pub const PICTURE: [&str; 6] = ["--shaders", "shaders", "--env", "none", "--size", "96x64"];

/// A session.
pub struct Served {
    /// The program.
    pub running: Running,
    /// Its shader tree.
    pub tree: Tree,
}

impl Served {
    /// Starts a session with [`PICTURE`] and more options, or others in their place.
    pub fn start(tree: Tree, more: &[&str]) -> Self {
        Self::with_fault(tree, more, "")
    }

    /// [`Self::start`] with a fault in the form of `SPECULA_FAULT`.
    pub fn with_fault(tree: Tree, more: &[&str], fault: &str) -> Self {
        // Options that are given take the place of those of the picture.
        let picture = PICTURE.chunks(2).filter(|option| !more.contains(&option[0])).flatten().copied();
        let mut command = Self::command(&tree, &picture.chain(more.iter().copied()).collect::<Vec<_>>());
        Self { running: Running::start(command.env("SPECULA_FAULT", fault)), tree }
    }

    /// The program in the folder of a tree. Whatever it leaves behind is in the folders `runtime` and `state` there.
    pub fn command(tree: &Tree, options: &[&str]) -> Command {
        std::fs::create_dir_all(tree.beside("runtime")).unwrap();
        let mut command = specula(&tree.beside(""));
        for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(name);
        }
        command.env("XDG_RUNTIME_DIR", tree.beside("runtime")).env("XDG_STATE_HOME", tree.beside("state"));
        command.args(["serve", "--validate"]).args(options).stdin(Stdio::piped());
        command
    }

    /// The bytes of the picture, as a file with this name. `fields` are more fields of the command.
    #[track_caller]
    pub fn picture(&mut self, name: &str, fields: &Value) -> Vec<u8> {
        let mut command = json!({"command": "picture", "file": name});
        command.as_object_mut().unwrap().extend(fields.as_object().unwrap().clone());
        let result = self.running.done(command);
        let file = self.tree.beside(name);
        assert_eq!(result["file"].as_str(), file.to_str());
        assert!(result["ms"].as_f64().unwrap() > 0.0, "{result}");
        let bytes = std::fs::read(&file).unwrap();
        std::fs::remove_file(file).unwrap();
        bytes
    }

    /// Waits for a second in which the program uses less than a tenth of the processor. A program that draws without a pause has none.
    #[track_caller]
    pub fn rests(&self) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let before = self.running.ticks();
            std::thread::sleep(Duration::from_secs(1));
            if self.running.ticks() - before < 10 {
                return;
            }
            assert!(Instant::now() < deadline, "it never rests. {}", self.running.story());
        }
    }

    /// Ends the session, and fails if anything was wrong.
    #[track_caller]
    pub fn quit(mut self) {
        self.running.say(r#"{"command": "quit"}"#);
        let status = self.running.end();
        assert_eq!(status.code(), Some(0), "{}", self.running.story());
        assert_eq!(self.left(), [] as [PathBuf; 0]);
    }

    /// The files that sessions have left in their folders: sockets, records, and what windows remember.
    pub fn left(&self) -> Vec<PathBuf> {
        let mut folders = vec![self.tree.beside("runtime"), self.tree.beside("state")];
        let mut files = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).into_iter().flatten() {
                let path = entry.unwrap().path();
                if path.is_dir() { folders.push(path) } else { files.push(path) }
            }
        }
        files
    }
}
