//! How far a picture of many frames is, on stderr: in a terminal one line that changes, elsewhere a line every few seconds.

use std::io::{IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

use specula::headless::Step;
use specula::message::{escape, tell};

/// Pictures that are done earlier show no progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two lines in a terminal.
const IN_TERMINAL: Duration = Duration::from_millis(200);
/// Time between two lines in a file or a pipe.
const IN_FILE: Duration = Duration::from_secs(5);

/// The progress of a command that writes one or more pictures.
pub struct Progress {
    is_shown: bool,
    is_terminal: bool,
    start: Instant,
    /// Start of the picture.
    picture_start: Instant,
    last: Option<Instant>,
    /// The picture's name, as `path-traced`, or its number among several.
    what: String,
    /// The picture's number, from 0, and how many there are.
    picture: (usize, usize),
    /// Characters of the line in the terminal.
    width: usize,
}

impl Progress {
    /// The progress of `pictures` pictures. Scripts that read events get none.
    pub fn new(is_shown: bool, pictures: usize) -> Self {
        let (is_terminal, start) = (std::io::stderr().is_terminal(), Instant::now());
        Self {
            is_shown,
            is_terminal,
            start,
            last: None,
            picture_start: start,
            what: String::new(),
            picture: (0, pictures),
            width: 0,
        }
    }

    /// Begins the picture with this number, of the mode `mode`.
    pub fn begin(&mut self, number: usize, mode: &str) {
        (self.picture.0, self.picture_start) = (number, Instant::now());
        let (mode, (number, of)) = (escape(mode), (number + 1, self.picture.1));
        self.what = if of == 1 { mode } else { format!("picture {number} of {of}: {mode}") };
    }

    /// Reports what is drawn of the picture.
    pub fn step(&mut self, step: &Step) {
        let now = Instant::now();
        let elapsed = now.duration_since(self.start);
        let pause = if self.is_terminal { IN_TERMINAL } else { IN_FILE };
        let is_early = self.last.map_or(elapsed < pause.max(PATIENCE), |last| now.duration_since(last) < pause);
        let (number, of) = self.picture;
        if !self.is_shown || is_early || (step.done == step.of && number + 1 == of) {
            return;
        }
        self.last = Some(now);
        let mut line = self.what.clone();
        // How long the other pictures take is not known: modes differ a hundredfold.
        if step.of > 1 {
            let left =
                self.picture_start.elapsed().as_secs_f64() * (step.of - step.done) as f64 / step.done.max(1) as f64;
            let of_it = if of > 1 { " of it" } else { "" };
            line += &format!(", {} of {} {}, about {} left{of_it}", step.done, step.of, step.unit, in_words(left));
        }
        if !self.is_terminal {
            tell(line);
            return;
        }
        let line = format!("specula: {line}");
        let width = line.chars().count();
        eprint!("\r{line}{:1$}", "", self.width.saturating_sub(width));
        let _ = std::io::stderr().flush();
        self.width = width;
    }

    /// Removes the line from the terminal, so that others can be printed.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.width) > 0 {
            eprint!("\r\u{1b}[K");
            let _ = std::io::stderr().flush();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.clear();
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
}
