//! The extension in VS Code itself, as code-server shows it in a browser. `scripts/test-vscode` installs it, and prints the folder that
//! `SPECULA_VSCODE` names for this test.

use std::fs;
use std::io::{BufRead as _, BufReader};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::hints::{OPTIONS, PIN};
use crate::support::browser::Browser;
use crate::support::process::{PATIENCE, run, send_signal};
use crate::support::{Tree, line_of};

const CONTROL: &str = "\u{e009}";
const ENTER: &str = "\u{e007}";
const ESCAPE: &str = "\u{e00c}";
const F1: &str = "\u{e031}";
const F8: &str = "\u{e038}";

const PROGRAM: &str = env!("CARGO_BIN_EXE_specula");
const FILE: &str = "brdf/ndf.glsl";
/// Texts of the lines of the editor, with their hints. Spaces of the page are no ordinary ones.
const LINES: &str = "const lines = [...document.querySelectorAll('.view-line')].map(line => line.textContent.replaceAll('\\u00a0', ' '));";

/// A server of VS Code with the extension, whose page opens [`FILE`]. Dropping it ends it.
struct Server {
    child: Child,
    /// The address of its page.
    url: String,
}

impl Server {
    fn start(installed: &Path, tree: &Tree) -> Self {
        let data = tree.beside("vscode");
        fs::create_dir_all(data.join("User")).unwrap();
        fs::write(data.join("config.yaml"), "").unwrap();
        let settings = json!({ "specula.arguments": OPTIONS, "editor.inlayHints.enabled": "on", "editor.minimap.enabled": false,
            "workbench.startupEditor": "none", "telemetry.telemetryLevel": "off", "extensions.autoUpdate": false });
        fs::write(data.join("User/settings.json"), settings.to_string()).unwrap();
        let mut command = Command::new("node");
        command.arg(installed.join("node_modules/code-server/out/node/entry.js")).env("HOME", &data);
        for (option, folder) in [
            ("--user-data-dir", data.as_path()),
            ("--extensions-dir", &installed.join("extensions")),
            ("--config", &data.join("config.yaml")),
        ] {
            command.arg(option).arg(folder);
        }
        command.args(["--auth", "none", "--bind-addr", "127.0.0.1:0", "--disable-telemetry", "--disable-update-check"]);
        command.args(["--disable-workspace-trust", "--disable-getting-started-override"]).arg(tree.root());
        set(tree, &json!({ "specula.path": PROGRAM }));
        // In a group of its own with the processes that it starts.
        let mut child = command.stdout(Stdio::piped()).process_group(0).spawn().expect("node: see scripts/test-vscode");
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let address = lines.find_map(|line| Some(line.unwrap().split_once("listening on ")?.1.to_owned()));
        std::thread::spawn(move || lines.for_each(drop));
        let (address, root) = (address.expect("an address"), tree.root());
        let file = format!(
            "vscode-remote://{}{}/{FILE}",
            address.trim_start_matches("http:").trim_matches('/'),
            root.display()
        );
        let payload = json!([["openFile", file]]).to_string().replace('"', "%22");
        let url = format!("{address}?folder={}&payload={payload}", root.display());
        Self { child, url }
    }
}

/// Writes the settings of the folder, which VS Code follows.
fn set(tree: &Tree, settings: &Value) {
    fs::create_dir_all(tree.path(".vscode")).unwrap();
    tree.write(".vscode/settings.json", &settings.to_string());
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = Command::new("kill").args(["-KILL", "--", &format!("-{}", self.child.id())]).status();
        let _ = self.child.wait();
    }
}

/// An editor with the page of VS Code.
struct Editor {
    browser: Browser,
}

impl Editor {
    fn open(server: &Server) -> Self {
        let browser = Browser::open_url(&server.url, (1280, 800));
        browser.until("the workbench", "return document.querySelector('.monaco-workbench .part.editor') !== null;");
        Self { browser }
    }

    /// Waits for a script that has the texts of all lines as `lines`.
    #[track_caller]
    fn until_lines(&self, what: &str, script: &str) -> Value {
        self.browser.until(what, &format!("{LINES} return {script};"))
    }

    /// The text of the first line that contains `part` and fits, once there is one.
    #[track_caller]
    fn line(&self, part: &str, fits: &str) -> String {
        let script = format!("lines.find(line => line.includes({}) && {fits}) || null", json!(part));
        self.until_lines(&format!("{part}: {fits}"), &script).as_str().unwrap().to_owned()
    }

    /// Waits for a text in the elements of a selector.
    #[track_caller]
    fn sees(&self, selector: &str, part: &str) {
        let script = format!(
            "return [...document.querySelectorAll({})].some(of => of.textContent.replaceAll('\\u00a0', ' ').includes({}));",
            json!(selector),
            json!(part)
        );
        self.browser.until(&format!("{part} in {selector}"), &script);
    }

    /// Opens a list by a key, types and takes the first entry, which has to contain `first`.
    fn choose(&self, keys: &[&str], text: &str, first: &str) {
        self.browser.press_all(keys);
        self.browser.until(
            "the list",
            "const input = document.querySelector('.quick-input-widget input'); return input && document.activeElement === input;",
        );
        self.browser.type_text(text);
        if !first.is_empty() {
            self.sees(".quick-input-list .monaco-list-row[data-index='0']", first);
        }
        self.browser.press(ENTER);
    }

    fn command(&self, title: &str) {
        self.choose(&[F1], title, title);
    }

    /// Puts the cursor before a part of the text on disk.
    fn go_to(&self, text: &str, line: &str, part: &str) {
        let number = line_of(text, line);
        let column = text.lines().nth(number as usize - 1).unwrap().find(part).unwrap() + 1;
        self.choose(&[CONTROL, "g"], &format!("{number}:{column}"), "");
        self.browser.until("the editor", "return document.querySelector('.monaco-editor.focused') !== null;");
        self.sees(".statusbar-item", &format!("Ln {number}, Col {column}"));
    }

    /// Waits until the status bar counts so many errors.
    #[track_caller]
    fn counts_errors(&self, count: usize) {
        let script = format!(
            "const of = document.getElementById('status.problems'); \
            return of !== null && of.textContent.trim().split(/\\s+/)[0] === '{count}' && \
                (document.querySelectorAll('.squiggly-error').length > 0) === {};",
            count > 0
        );
        self.browser.until(&format!("{count} errors"), &script);
    }
}

/// Processes of the language server of a tree.
fn servers(tree: &Tree) -> Vec<u32> {
    let processes =
        fs::read_dir("/proc").unwrap().filter_map(|entry| entry.unwrap().file_name().to_str()?.parse().ok());
    let is_server = |process: &u32| {
        let of = PathBuf::from(format!("/proc/{process}"));
        let arguments = fs::read_to_string(of.join("cmdline")).unwrap_or_default();
        let is_ours = fs::read_link(of.join("cwd")).is_ok_and(|folder| folder == tree.root().canonicalize().unwrap());
        is_ours && arguments.split('\0').nth(1) == Some("lsp")
    };
    processes.filter(is_server).collect()
}

#[test]
fn vs_code_shows_errors_values_completion_and_a_program_that_does_not_start() {
    let Some(installed) = std::env::var_os("SPECULA_VSCODE").map(PathBuf::from) else {
        println!("the extension in VS Code is skipped: SPECULA_VSCODE is not set, see scripts/test-vscode");
        return;
    };
    let tree = Tree::new();
    let server = Server::start(&installed, &tree);
    let editor = Editor::open(&server);
    editor.line("float d_ggx(", "true");
    // The extension starts the server for the open file.
    let deadline = Instant::now() + PATIENCE;
    while servers(&tree).is_empty() {
        assert!(Instant::now() < deadline, "no language server was started");
        std::thread::sleep(Duration::from_millis(20));
    }

    // Values at a pixel are those of `specula trace`.
    editor.command("Specula: Show Values at a Pixel");
    editor.sees(".quick-input-widget", "counted from the upper left corner");
    let pin = format!("{},{}", PIN[0], PIN[1]);
    editor.browser.type_text(&pin);
    editor.browser.press(ENTER);
    let hinted = editor.line("float a2 = alpha * alpha;", "line.includes('×')");
    let hint = hinted.split_once(';').unwrap().1.trim();
    let root = tree.root();
    let arguments = ["trace", "--shaders", root.to_str().unwrap(), "--at", &pin, "--file", FILE];
    let traced = run(&root, &[&arguments[..], &OPTIONS].concat()).expect(0, &[]).stdout.clone();
    let row = traced.lines().find(|row| row.contains("float a2 = alpha * alpha;")).expect("a row");
    assert!(hint.starts_with("a2 = 0.") && row.ends_with(hint), "{hint} instead of {row}");
    editor.sees(".statusbar-item", "equal to the picture");

    // Hover over a name of the line.
    let script = "const names = [...document.querySelectorAll('.view-line span')].filter(of => of.textContent === 'd_ggx'); \
        const area = names[0].getBoundingClientRect(); return [area.left + area.width / 2, area.top + area.height / 2];";
    editor.browser.hover(serde_json::from_value(editor.browser.run(script)).unwrap());
    editor.sees(".monaco-hover", "float d_ggx(float n_dot_h, float sin2_h, float alpha)");
    editor.sees(".monaco-hover", "At the pinned pixel");

    // An error as it is typed: the line has no value, the others keep theirs.
    let text = tree.read(FILE);
    editor.go_to(&text, "float a2 = alpha * alpha;", "pha;");
    editor.browser.type_text("x");
    editor.counts_errors(1);
    editor.line("float a2 = alpha * alxpha;", "!line.includes('×')");
    editor.line("float spread = n_dot_h", "line.includes('×')");
    editor.browser.press(F8);
    editor.sees(".marker-widget", "'alxpha' : undeclared identifier");
    editor.browser.press(ESCAPE);
    editor.browser.press_all(&[CONTROL, "z"]);
    editor.counts_errors(0);

    // Completion of a name in scope.
    editor.go_to(&text, "float a2 = alpha * alpha;", ";");
    editor.browser.type_text(" + sin2");
    editor.browser.press_all(&[CONTROL, " "]);
    editor.sees(".suggest-widget .monaco-list-row.focused", "sin2_h");
    editor.browser.press(ENTER);
    editor.line("float a2 = alpha * alpha + sin2_h;", "true");
    editor.counts_errors(0);
    editor.command("Specula: Hide Values");
    editor.until_lines("no values", "!lines.some(line => line.includes('×'))");

    // Other settings: the server of before ends, and what cannot be started is told.
    let before = servers(&tree);
    assert_eq!(before.len(), 1, "{before:?}");
    set(&tree, &json!({ "specula.path": "/nowhere/specula" }));
    editor.sees(".notification-toast", "`/nowhere/specula lsp --env none --size 96x64 --validate` does not start");
    assert_eq!(servers(&tree), [0; 0]);
    editor.command("Specula: Hide Values");
    editor.sees(".notification-toast", "the language server is not running");
    set(&tree, &json!({ "specula.path": PROGRAM }));
    editor.go_to(&text, "float a2 = alpha * alpha;", "pha;");
    editor.browser.type_text("x");
    editor.counts_errors(1);
    let [again] = servers(&tree)[..] else { panic!("{:?}", servers(&tree)) };
    assert_ne!(again, before[0]);
    // A server that is killed is started again.
    send_signal(again, "KILL");
    editor.browser.type_text("y");
    editor.line("alxypha", "true");
    let message = "'alxypha' : undeclared identifier";
    editor.command("Problems: Focus on Problems View");
    editor.sees(".markers-panel", message);
    let [third] = servers(&tree)[..] else { panic!("{:?}", servers(&tree)) };
    assert_ne!(third, again);
}
