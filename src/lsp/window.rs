//! Asks a running window through its socket.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// The sockets of windows that run now: the one that was named, or all of the user.
pub fn sockets(named: Option<&Path>) -> Vec<PathBuf> {
    let found = match named {
        Some(path) => vec![path.to_owned()],
        None => {
            let folder = std::env::var_os("XDG_RUNTIME_DIR").map(|folder| PathBuf::from(folder).join("specula"));
            let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
            let paths = entries.map(|entry| entry.path());
            let mut paths: Vec<PathBuf> =
                paths.filter(|path| path.extension().is_some_and(|end| end == "sock")).collect();
            paths.sort();
            paths
        }
    };
    found.into_iter().filter(|path| is_open(path)).collect()
}

/// Asks the first window that can to show an expression over the model.
///
/// # Errors
/// No window runs, or what the last one answered.
pub fn show(sockets: &[PathBuf], expression: &str) -> Result<(), String> {
    let mut last = Err("no window listens: start one with `specula view --socket NAME`".to_owned());
    for socket in sockets {
        let values = json!({ "expression.at": expression, "mode": "expression" });
        last = ask(socket, &json!({ "id": "lsp", "command": "set", "values": values }));
        if last.is_ok() {
            break;
        }
    }
    last
}

#[cfg(unix)]
fn is_open(path: &Path) -> bool {
    std::os::unix::net::UnixStream::connect(path).is_ok()
}

/// Sends a command, and waits for its answer.
#[cfg(unix)]
fn ask(socket: &Path, command: &Value) -> Result<(), String> {
    use std::io::{BufRead as _, BufReader, Write as _};
    use std::time::Duration;
    let failed = |error: std::io::Error| format!("the window at {} does not answer: {error}", socket.display());
    let mut stream = std::os::unix::net::UnixStream::connect(socket).map_err(failed)?;
    // A window with large shaders may compile for long.
    stream.set_read_timeout(Some(Duration::from_secs(120))).map_err(failed)?;
    writeln!(stream, "{command}").map_err(failed)?;
    for line in BufReader::new(stream).lines() {
        let answer: Value = serde_json::from_str(&line.map_err(failed)?).unwrap_or_default();
        if answer["id"] != "lsp" {
            continue;
        }
        match answer["event"].as_str() {
            Some("done") => return Ok(()),
            Some("error") => return Err(answer["message"].as_str().unwrap_or("it failed").to_owned()),
            _ => {}
        }
    }
    Err(format!("the window at {} has closed", socket.display()))
}

#[cfg(not(unix))]
fn is_open(_: &Path) -> bool {
    false
}

#[cfg(not(unix))]
fn ask(_: &Path, _: &Value) -> Result<(), String> {
    Err("this system has no sockets for windows".to_owned())
}
