//! A browser without a window, driven by the WebDriver protocol (W3C) over HTTP.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use image::RgbaImage;
use serde_json::{Value, json};
use tempfile::TempDir;

use super::process::PATIENCE;

/// No window, and no connection but to the page.
const OPTIONS: [&str; 9] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--force-device-scale-factor=1",
];

/// Chromium with a page. Dropping it ends the browser.
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
    /// The profile and everything else that the browser writes.
    _home: TempDir,
}

impl Browser {
    /// Starts the browser with a file.
    pub fn open(page: &Path, size: (u32, u32)) -> Self {
        Self::open_url(&format!("file://{}", page.display()), size)
    }

    /// Starts the browser with a page.
    pub fn open_url(url: &str, (width, height): (u32, u32)) -> Self {
        let home = tempfile::tempdir().unwrap();
        let mut command = Command::new("chromedriver");
        command.arg("--port=0").env("HOME", home.path()).env("TMPDIR", home.path());
        let mut driver =
            command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("chromedriver: scripts/setup --test");
        let mut lines = BufReader::new(driver.stdout.take().unwrap()).lines();
        let port = lines
            .find_map(|line| line.unwrap().split_once("successfully on port ")?.1.trim_end_matches('.').parse().ok());
        // It may print more.
        std::thread::spawn(move || lines.for_each(drop));
        let mut browser = Self { driver, port: port.expect("a port"), session: String::new(), _home: home };
        let profile = format!("--user-data-dir={}", browser._home.path().join("profile").display());
        let window = format!("--window-size={width},{height}");
        let args = [&OPTIONS[..], &[&profile, &window]].concat();
        let always = json!({ "goog:chromeOptions": { "args": args }, "goog:loggingPrefs": { "browser": "ALL" } });
        let options = json!({ "capabilities": { "alwaysMatch": always } });
        browser.session = browser.ask("POST", "/session", &options)["sessionId"].as_str().unwrap().to_owned();
        browser.command("url", &json!({ "url": url }));
        browser
    }

    /// The value of a script, which is the body of a function.
    pub fn run(&self, script: &str) -> Value {
        self.command("execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// The value of a script, which is the body of a function, once it is neither `false` nor `null`.
    #[track_caller]
    pub fn until(&self, what: &str, script: &str) -> Value {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let value = self.run(script);
            if value != json!(false) && !value.is_null() {
                return value;
            }
            if Instant::now() > deadline {
                let (_, path) = tempfile::Builder::new().suffix(".png").tempfile().unwrap().keep().unwrap();
                self.picture().save(&path).unwrap();
                panic!("{what} never appeared; the page is kept as {}", path.display());
            }
        }
    }

    /// Drags the mouse from one place of the window to another, with these keys down.
    pub fn drag(&self, from: [f64; 2], to: [f64; 2]) {
        let at = |[x, y]: [f64; 2]| json!({ "type": "pointerMove", "duration": 0, "x": x.round(), "y": y.round() });
        let button = |kind: &str| json!({ "type": kind, "button": 0 });
        let steps = [at(from), button("pointerDown"), at(to), button("pointerUp")];
        self.command("actions", &json!({ "actions": [{ "type": "pointer", "id": "mouse", "actions": steps }] }));
    }

    /// Clicks, while `key` is down if there is one.
    pub fn click(&self, at: [f64; 2], key: Option<&str>) {
        let keys = |kind: &str| match key {
            Some(key) => json!({ "type": kind, "value": key }),
            None => json!({ "type": "pause" }),
        };
        let pause = json!({ "type": "pause" });
        let keyboard = [keys("keyDown"), pause.clone(), pause.clone(), pause.clone(), keys("keyUp")];
        let [x, y] = at.map(f64::round);
        let button = |kind: &str| json!({ "type": kind, "button": 0 });
        let mouse = [
            pause.clone(),
            json!({ "type": "pointerMove", "duration": 0, "x": x, "y": y }),
            button("pointerDown"),
            button("pointerUp"),
            pause,
        ];
        self.command(
            "actions",
            &json!({ "actions": [{ "type": "key", "id": "keys", "actions": keyboard },
                { "type": "pointer", "id": "mouse", "actions": mouse }] }),
        );
    }

    /// Moves the mouse.
    pub fn hover(&self, [x, y]: [f64; 2]) {
        let step = json!({ "type": "pointerMove", "duration": 0, "x": x.round(), "y": y.round() });
        self.command("actions", &json!({ "actions": [{ "type": "pointer", "id": "mouse", "actions": [step] }] }));
    }

    /// Presses a key.
    pub fn press(&self, key: &str) {
        self.press_all(&[key]);
    }

    /// Presses keys, and releases them in the opposite order.
    pub fn press_all(&self, keys: &[&str]) {
        let down = keys.iter().map(|key| json!({ "type": "keyDown", "value": key }));
        let up = keys.iter().rev().map(|key| json!({ "type": "keyUp", "value": key }));
        self.keys(&down.chain(up).collect());
    }

    /// Types a text, key by key.
    pub fn type_text(&self, text: &str) {
        let of = |letter: char| ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": letter.to_string() }));
        self.keys(&text.chars().flat_map(of).collect());
    }

    fn keys(&self, steps: &Value) {
        self.command("actions", &json!({ "actions": [{ "type": "key", "id": "keys", "actions": steps }] }));
    }

    /// Messages of the page since the last call: errors of scripts, and what its security policy has refused.
    pub fn log(&self) -> Value {
        self.command("se/log", &json!({ "type": "browser" }))
    }

    /// Left, top, width and height of an element, in pixels of the window.
    pub fn area(&self, selector: &str) -> [f64; 4] {
        let script = format!(
            "const r = document.querySelector({}).getBoundingClientRect(); return [r.left, r.top, r.width, r.height];",
            json!(selector)
        );
        serde_json::from_value(self.run(&script)).unwrap()
    }

    /// The pixels of the window.
    pub fn picture(&self) -> RgbaImage {
        let png = self.ask("GET", &format!("/session/{}/screenshot", self.session), &Value::Null);
        let bytes = BASE64_STANDARD.decode(png.as_str().unwrap()).unwrap();
        image::load_from_memory(&bytes).unwrap().to_rgba8()
    }

    fn command(&self, name: &str, fields: &Value) -> Value {
        self.ask("POST", &format!("/session/{}/{name}", self.session), fields)
    }

    #[track_caller]
    fn ask(&self, method: &str, path: &str, fields: &Value) -> Value {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let body = if fields.is_null() { String::new() } else { fields.to_string() };
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n",
            self.port,
            body.len()
        );
        stream.write_all((head + &body).as_bytes()).unwrap();
        let mut answer = BufReader::new(stream);
        let (mut status, mut length) = (String::new(), 0);
        answer.read_line(&mut status).unwrap();
        // The driver keeps the connection open, so the length says where the answer ends.
        loop {
            let mut line = String::new();
            answer.read_line(&mut line).unwrap();
            let Some((name, value)) = line.trim().split_once(':') else { break };
            if name.eq_ignore_ascii_case("content-length") {
                length = value.trim().parse().unwrap();
            }
        }
        let mut body = vec![0; length];
        answer.read_exact(&mut body).unwrap();
        let value: Value = serde_json::from_slice(&body).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(status.starts_with("HTTP/1.1 200"), "{method} {path}: {value}");
        value["value"].clone()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The driver ends the browser with its session; killed, it would leave it.
        let path = format!("/session/{}", self.session);
        if !self.session.is_empty() {
            let _ = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| self.ask("DELETE", &path, &Value::Null)));
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
