//! The progress of a command that takes long, on stderr: in a terminal one line that changes, elsewhere a line every few seconds.

use std::io::IsTerminal as _;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use specula::headless::Step;
use specula::message::{clear_status, escape, show_status, tell};

/// Commands that end earlier show no progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two lines in a terminal.
const IN_TERMINAL: Duration = Duration::from_millis(200);
/// Time between two lines in a file or a pipe.
const IN_FILE: Duration = Duration::from_secs(5);

/// The progress of a command. A thread prints it, so that it also appears while the device or a compiler works.
pub struct Progress {
    state: Arc<Mutex<ProgressState>>,
    /// Dropping it ends the thread.
    end: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// State shared with the thread that prints.
struct ProgressState {
    is_terminal: bool,
    start: Instant,
    /// Start of the current part.
    part_start: Instant,
    /// The current part, as `path-traced`, or its number among several; empty while nothing is shown.
    what: String,
    /// The progress of the current part.
    step: Option<Step>,
    /// Whether the part is one of several.
    is_one_of_several: bool,
    last_shown: Option<Instant>,
    last_line: String,
}

impl Progress {
    /// Starts to show progress, if `is_shown`. Scripts that read events get none.
    pub fn new(is_shown: bool) -> Self {
        let (is_terminal, start) = (std::io::stderr().is_terminal(), Instant::now());
        let state = Arc::new(Mutex::new(ProgressState {
            is_terminal,
            start,
            part_start: start,
            what: String::new(),
            step: None,
            is_one_of_several: false,
            last_shown: None,
            last_line: String::new(),
        }));
        if !is_shown {
            return Self { state, end: None, thread: None };
        }
        let (end, ended) = channel::<()>();
        let shown = state.clone();
        let tick = if is_terminal { IN_TERMINAL } else { PATIENCE } / 2;
        let show = move || {
            while ended.recv_timeout(tick) == Err(RecvTimeoutError::Timeout) {
                locked(&shown).show();
            }
        };
        // Without a thread, no progress is shown.
        let thread = std::thread::Builder::new().name("specula-progress".to_owned()).spawn(show).ok();
        Self { state, end: Some(end), thread }
    }

    /// Sets what the command is doing now.
    pub fn say(&self, what: &str) {
        self.set(escape(what), false);
    }

    /// Starts part `number`, from 0, of `of`: `picture 3 of 90: roughness`. A single part is shown by its name alone.
    pub fn begin(&self, kind: &str, (number, of): (usize, usize), name: &str) {
        let name = escape(name);
        let what = match (of, name.is_empty()) {
            (1, true) => kind.to_owned(),
            (1, false) => name,
            (_, true) => format!("{kind} {} of {of}", number + 1),
            (_, false) => format!("{kind} {} of {of}: {name}", number + 1),
        };
        self.set(what, of > 1);
    }

    fn set(&self, what: String, is_one_of_several: bool) {
        let mut state = locked(&self.state);
        (state.what, state.is_one_of_several) = (what, is_one_of_several);
        (state.step, state.part_start) = (None, Instant::now());
    }

    /// Reports the progress of the current part.
    pub fn step(&self, step: &Step) {
        locked(&self.state).step = Some(*step);
    }

    /// Shows nothing until the next part begins.
    pub fn pause(&self) {
        locked(&self.state).what.clear();
        clear_status();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.pause();
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn locked(state: &Mutex<ProgressState>) -> MutexGuard<'_, ProgressState> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

impl ProgressState {
    /// Prints the line, if it is due.
    fn show(&mut self) {
        let now = Instant::now();
        let pause = if self.is_terminal { IN_TERMINAL } else { IN_FILE };
        let is_early = match self.last_shown {
            Some(last) => now.duration_since(last) < pause,
            None => now.duration_since(self.start) < pause.max(PATIENCE),
        };
        let line = self.line();
        // In a terminal another message may have replaced the line.
        let is_known = !self.is_terminal && line == self.last_line;
        if is_early || is_known || self.what.is_empty() {
            return;
        }
        if self.is_terminal {
            show_status(&line);
        } else {
            tell(&line);
        }
        (self.last_shown, self.last_line) = (Some(now), line);
    }

    fn line(&self) -> String {
        // The time of the other parts is unknown: modes differ a hundredfold.
        let Some(Step { done, of, unit }) = self.step.filter(|step| step.of > 1) else { return self.what.clone() };
        let left = self.part_start.elapsed().as_secs_f64() * (of - done) as f64 / done.max(1) as f64;
        let of_it = if self.is_one_of_several { " of it" } else { "" };
        format!("{}, {done} of {of} {unit}, about {} left{of_it}", self.what, in_words(left))
    }
}

/// `40 s`, `3 min`
fn in_words(seconds: f64) -> String {
    match seconds {
        few if few < 99.5 => format!("{few:.0} s"),
        many if many < 99.5 * 60.0 => format!("{:.0} min", many / 60.0),
        many => format!("{:.0} h", many / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_two_digits() {
        let words = [0.2, 59.0, 99.9, 600.0, 36_000.0].map(in_words);
        assert_eq!(words, ["0 s", "59 s", "2 min", "10 min", "10 h"]);
    }

    #[test]
    fn a_line_has_the_part_and_how_far_it_is() {
        let progress = Progress::new(false);
        let line = || locked(&progress.state).line();
        progress.say("compiling the shaders");
        assert_eq!(line(), "compiling the shaders");
        progress.begin("picture", (2, 90), "roughness");
        assert_eq!(line(), "picture 3 of 90: roughness");
        progress.step(&Step { done: 8, of: 8, unit: "paths per pixel" });
        assert_eq!(line(), "picture 3 of 90: roughness, 8 of 8 paths per pixel, about 0 s left of it");
        progress.begin("picture", (0, 1), "roughness");
        assert_eq!(line(), "roughness");
        progress.begin("sample", (0, 20), "");
        assert_eq!(line(), "sample 1 of 20");
        progress.begin("sample", (0, 1), "");
        assert_eq!(line(), "sample");
    }
}
