//! `specula view` on an X server of its own (Xvfb). Keys, the mouse and sizes go through the X server by xdotool. The server gives the
//! pixels of the window, and reports each change of them.

use std::io::{BufRead as _, BufReader, ErrorKind};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use image::RgbaImage;
use serde_json::Value;

use super::process::{Finished, PATIENCE, Running, finish, send_signal, specula};
use super::root_window::RootWindow;
use super::{Tree, open_image};

/// An X server. Dropping this ends it.
pub struct Display {
    server: Child,
    name: String,
    root: RootWindow,
}

impl Display {
    /// Starts a server on a free display. The server prints the display's number once it accepts connections.
    pub fn new() -> Self {
        if let Err(error) = Command::new("xdotool").stdout(Stdio::null()).stderr(Stdio::null()).status() {
            missing::<()>("xdotool", "xdotool", &error);
        }
        let mut command = Command::new("Xvfb");
        command.args(["-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp", "-noreset"]);
        let mut server = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|error| missing("Xvfb", "xvfb", &error));
        let mut line = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert!(!line.trim().is_empty(), "Xvfb ended before it had a display");
        let name = format!(":{}", line.trim());
        let display = Self { server, root: RootWindow::watch(&name), name };
        display.park_mouse();
        display
    }

    /// Its name, as in `DISPLAY`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Moves the mouse to the screen's corner, where it hovers over no control. It starts in the middle.
    #[track_caller]
    pub fn park_mouse(&self) {
        self.xdotool(&["mousemove", "1023", "767"]);
    }

    /// `specula view` on this display, in the folder of `tree`.
    pub fn view(&self, tree: &Tree) -> Command {
        let mut command = specula(&tree.beside(""));
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command.args(["view", "--validate", "--events", "json"]);
        command
    }

    /// Runs xdotool, which must succeed.
    #[track_caller]
    pub fn xdotool(&self, args: &[&str]) -> Finished {
        let mut command = Command::new("xdotool");
        let finished = finish(command.args(args).env("DISPLAY", &self.name));
        assert_eq!(finished.code, Some(0), "xdotool {args:?}: {finished:#?}");
        finished
    }

    /// The whole screen as it is now.
    pub fn screen(&self) -> RgbaImage {
        self.root.pixels()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn missing<T>(program: &str, package: &str, error: &std::io::Error) -> T {
    assert_eq!(error.kind(), ErrorKind::NotFound, "{program}: {error}");
    panic!("{program} is not installed, and the window is not tested without it: apt-get install {package}");
}

/// Makes the hint of the first start a dismissed one.
fn dismiss_hint(tree: &Tree) {
    std::fs::create_dir_all(tree.beside("state/specula")).unwrap();
    std::fs::write(tree.beside("state/specula/hint.json"), "{}").unwrap();
}

/// `specula view` on a tree of its own, under validation. Fields drop in order: the program ends before its display.
pub struct Viewer {
    /// The program.
    pub running: Running,
    /// Its shader tree.
    pub tree: Tree,
    /// Its X server.
    pub display: Display,
    window: String,
}

impl Viewer {
    /// Opens the window, which may still be empty. `more` overrides `--env none` and `--size 640x480`.
    pub fn open(tree: Tree, more: &[&str]) -> Self {
        Self::with_fault(tree, more, "")
    }

    /// [`Self::open`] with a fault in the form of `SPECULA_FAULT`.
    pub fn with_fault(tree: Tree, more: &[&str], fault: &str) -> Self {
        let mut viewer = Self::launch(tree, more, fault);
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    /// [`Self::open`] with an editor in the form of `SPECULA_EDITOR`.
    pub fn with_editor(tree: Tree, more: &[&str], editor: &str) -> Self {
        let mut viewer = Self::start(tree, more, &[("SPECULA_EDITOR", editor)]);
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    /// [`Self::open`] where no editor is installed.
    pub fn without_editor(tree: Tree, more: &[&str]) -> Self {
        let none = ["SPECULA_EDITOR", "VISUAL", "EDITOR", "PATH"].map(|name| (name, ""));
        let mut viewer = Self::start(tree, more, &none);
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    /// [`Self::open`] with a standard input for [`Running::ask`].
    pub fn driven(tree: Tree, more: &[&str]) -> Self {
        Self::driven_with_fault(tree, more, "")
    }

    /// [`Self::driven`] with a fault in the form of `SPECULA_FAULT`.
    pub fn driven_with_fault(tree: Tree, more: &[&str], fault: &str) -> Self {
        dismiss_hint(&tree);
        let mut viewer = Self::spawn(tree, more, &[("SPECULA_FAULT", fault)], Stdio::piped());
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    /// [`Self::driven`] with the lines on stderr that developers read.
    pub fn driven_with_log(tree: Tree, more: &[&str]) -> Self {
        dismiss_hint(&tree);
        let mut viewer = Self::spawn(tree, more, &[("SPECULA_LOG", "debug")], Stdio::piped());
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    /// A window whose picture no option chooses: what `specula` without a model shows, in the folder of the tree.
    pub fn plain(tree: Tree, more: &[&str]) -> Self {
        dismiss_hint(&tree);
        let display = Display::new();
        let mut command = display.view(&tree);
        std::fs::create_dir_all(tree.beside("runtime")).unwrap();
        command.env("XDG_RUNTIME_DIR", tree.beside("runtime")).env("XDG_STATE_HOME", tree.beside("state"));
        command.args(["--size", "640x480"]);
        let mut viewer = Self { running: Running::start(command.args(more)), tree, window: String::new(), display };
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    /// [`Self::with_fault`] without waiting for a window.
    pub fn launch(tree: Tree, more: &[&str], fault: &str) -> Self {
        Self::start(tree, more, &[("SPECULA_FAULT", fault)])
    }

    /// [`Self::open`] with the hint of the first start, which all other windows have dismissed.
    pub fn at_first_start(tree: Tree, more: &[&str]) -> Self {
        let mut viewer = Self::spawn(tree, more, &[], Stdio::null());
        viewer.running.event("window");
        viewer.find_window();
        viewer
    }

    fn start(tree: Tree, more: &[&str], environment: &[(&str, &str)]) -> Self {
        dismiss_hint(&tree);
        Self::spawn(tree, more, environment, Stdio::null())
    }

    fn spawn(tree: Tree, more: &[&str], environment: &[(&str, &str)], stdin: Stdio) -> Self {
        let display = Display::new();
        let mut command = display.view(&tree);
        command.stdin(stdin);
        // Records of the session lie here, so a test can see whether they are removed.
        std::fs::create_dir_all(tree.beside("runtime")).unwrap();
        command.env("XDG_RUNTIME_DIR", tree.beside("runtime"));
        // So does the arrangement of the panels.
        command.env("XDG_STATE_HOME", tree.beside("state"));
        // The window shows the whole picture, however slow the device is.
        command.args(["--set", "view.msaa=1", "--set", "view.adaptive=off"]).envs(environment.iter().copied());
        for (option, value) in [("--shaders", "shaders"), ("--env", "none"), ("--size", "640x480")] {
            if !more.contains(&option) {
                command.args([option, value]);
            }
        }
        Self { running: Running::start(command.args(more)), tree, window: String::new(), display }
    }

    /// Waits until the program has started again after a loss, with a new window. Returns the event about the loss.
    #[track_caller]
    pub fn restarted(&mut self) -> Value {
        let event = self.running.event("restarted");
        self.running.event("window");
        self.find_window();
        event
    }

    #[track_caller]
    fn find_window(&mut self) {
        let found = self.display.xdotool(&["search", "--sync", "--onlyvisible", "--name", "Specula$"]);
        found.stdout.lines().next().unwrap().clone_into(&mut self.window);
        // Without a window manager, nothing else gives the window the keyboard focus.
        self.give_focus();
    }

    /// The number of the window on its X server.
    pub fn window(&self) -> u32 {
        self.window.parse().unwrap()
    }

    /// Gives the window the keyboard focus.
    #[track_caller]
    pub fn give_focus(&self) {
        self.display.xdotool(&["windowfocus", "--sync", &self.window]);
    }

    /// Gives the keyboard focus to the root window.
    #[track_caller]
    pub fn take_focus_away(&self) {
        let root = self.display.xdotool(&["search", "--maxdepth", "0", "--name", ".*"]).stdout;
        self.display.xdotool(&["windowfocus", root.trim()]);
    }

    /// Moves the window.
    #[track_caller]
    pub fn move_window(&self, (x, y): (u32, u32)) {
        self.display.xdotool(&["windowmove", "--sync", &self.window, &x.to_string(), &y.to_string()]);
    }

    /// Size and place of the window, as xdotool tells them.
    #[track_caller]
    pub fn geometry(&self) -> String {
        let geometry = self.display.xdotool(&["getwindowgeometry", "--shell", &self.window]).stdout;
        geometry.lines().filter(|line| !line.starts_with("WINDOW=")).collect::<Vec<_>>().join(" ")
    }

    /// Waits for the model and for the environment, which appear in either order. Returns the event about the environment.
    #[track_caller]
    pub fn ready_and_baked(&mut self) -> Value {
        let (mut ready, mut bake) = (false, Value::Null);
        self.running.until("model and environment", |event| {
            match event["event"].as_str() {
                Some("ready") => ready = true,
                Some("bake") => bake = event.clone(),
                _ => {}
            }
            ready && bake.is_object()
        });
        bake
    }

    /// Presses and releases a key.
    #[track_caller]
    pub fn key(&self, key: &str) {
        self.display.xdotool(&["key", key]);
    }

    /// Moves the mouse to a pixel of the window.
    #[track_caller]
    pub fn move_mouse(&self, (x, y): (u32, u32)) {
        self.display.xdotool(&["mousemove", "--window", &self.window, &x.to_string(), &y.to_string()]);
    }

    /// Moves the mouse to a pixel of the window and clicks.
    #[track_caller]
    pub fn click(&self, at: (u32, u32)) {
        self.move_mouse(at);
        self.display.xdotool(&["click", "1"]);
    }

    /// Drags along pixels of the window, with a frame at each.
    #[track_caller]
    pub fn drag_along(&mut self, places: &[(u32, u32)]) {
        for (index, at) in places.iter().enumerate() {
            self.move_mouse(*at);
            if index == 0 {
                self.screenshot();
                self.display.xdotool(&["mousedown", "1"]);
            }
            self.screenshot();
        }
        self.display.xdotool(&["mouseup", "1"]);
    }

    /// Drags from one pixel of the window to another.
    #[track_caller]
    pub fn drag(&self, from: (u32, u32), to: (u32, u32)) {
        self.move_mouse(from);
        self.display.xdotool(&["mousedown", "1"]);
        self.move_mouse(to);
        self.display.xdotool(&["mouseup", "1"]);
    }

    /// Stops the window's process, and lets it go on after `act`: all keys and movements of `act` are there at once.
    #[track_caller]
    pub fn paused(&self, act: impl FnOnce()) {
        let worker = self.running.worker();
        send_signal(worker, "STOP");
        act();
        // The server passes events on before it answers a later request.
        drop(self.screen());
        send_signal(worker, "CONT");
    }

    /// Takes the window off the screen, as minimizing it does.
    #[track_caller]
    pub fn hide(&self) {
        self.display.xdotool(&["windowunmap", "--sync", &self.window]);
    }

    /// Puts the window back on the screen.
    #[track_caller]
    pub fn unhide(&self) {
        self.display.xdotool(&["windowmap", "--sync", &self.window]);
        self.give_focus();
    }

    /// Resizes the window.
    #[track_caller]
    pub fn resize(&self, width: u32, height: u32) {
        self.display.xdotool(&["windowsize", "--sync", &self.window, &width.to_string(), &height.to_string()]);
    }

    /// The picture on screen, without panels.
    #[track_caller]
    pub fn screenshot(&mut self) -> RgbaImage {
        self.key("F12");
        let event = self.running.event("screenshot");
        let path = self.tree.beside(event["file"].as_str().unwrap());
        let shot = open_image(&path).into_rgba8();
        // The program looks for the first free name, which a thousand screenshots would make slow.
        std::fs::remove_file(&path).unwrap();
        shot
    }

    /// Takes a screenshot, which is the same as `expected`.
    #[track_caller]
    pub fn shows(&mut self, expected: &RgbaImage, why: &str) {
        let shot = self.screenshot();
        if shot != *expected {
            panic!("{why}: {} instead of {}. {}", keep(&shot), keep(expected), self.running.story());
        }
    }

    /// Takes screenshots until `is` accepts one, because new content appears only once it is complete.
    #[track_caller]
    pub fn until(&mut self, what: &str, mut is: impl FnMut(&RgbaImage) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let shot = self.screenshot();
            if is(&shot) {
                return;
            }
            if Instant::now() > deadline {
                let path = keep(&self.screen());
                panic!(
                    "{what} never appeared in the picture, kept as {}; the screen is kept as {}. {}",
                    keep(&shot),
                    path,
                    self.running.story()
                );
            }
        }
    }

    /// The screen with panels and messages as it is now. The window is at its upper left. Looking wakes nothing up.
    pub fn screen(&self) -> RgbaImage {
        self.display.screen()
    }

    /// Looks at the screen, and again whenever it changes, until `is` accepts it. Returns it.
    #[track_caller]
    pub fn until_screen(&self, what: &str, is: impl Fn(&RgbaImage) -> bool) -> RgbaImage {
        let deadline = Instant::now() + PATIENCE;
        loop {
            self.display.root.forget_changes();
            let screen = self.screen();
            if is(&screen) {
                return screen;
            }
            if !self.display.root.changes_before(deadline) {
                panic!("{what} never appeared on the screen, kept as {}. {}", keep(&screen), self.running.story());
            }
        }
    }

    /// Waits for a second in which the program draws nothing and uses less than a tenth of the processor. A program that draws without a
    /// pause has none.
    #[track_caller]
    pub fn rests(&self) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            self.display.root.forget_changes();
            let before = self.running.ticks();
            let is_drawn = self.display.root.changes_before(Instant::now() + Duration::from_secs(1));
            if !is_drawn && self.running.ticks() - before < 10 {
                return;
            }
            assert!(Instant::now() < deadline, "it never rests. {}", self.running.story());
        }
    }

    /// Presses Ctrl+Q. The program must exit with 0, which it does not after a validation message. Returns its stderr.
    #[track_caller]
    pub fn quit(mut self) -> String {
        self.key("ctrl+q");
        let status = self.running.end();
        assert!(status.success(), "it ended with {status}. {}", self.running.story());
        self.running.stderr()
    }
}

/// Stores a picture of a failed test where it stays. Returns the path.
fn keep(picture: &RgbaImage) -> String {
    let (_, path) = tempfile::Builder::new().suffix(".png").tempfile().unwrap().keep().unwrap();
    picture.save(&path).unwrap();
    path.display().to_string()
}
