//! Traces a pixel of the saved tree on a thread of its own, for the values beside the lines.

use std::path::PathBuf;

use super::event::Event;
use super::traced::{Asked, Traced, TracedFile, TracedLine};
use super::window;
use crate::headless::{Headless, HeadlessError, TraceRequest};
use crate::message::catch_panic;
use crate::shader::{Change, Diagnostic, Mode, Source};
use crossbeam_channel::{Receiver, Sender, unbounded};

/// Opens a tree on the device, with the model and the settings of the command line. Returns the name of the mode that is traced, too.
pub type OpenTree = Box<dyn FnMut(Source) -> Result<(Headless, String), String> + Send>;

/// The thread. It ends with this value.
#[derive(Debug)]
pub struct PixelTrace {
    jobs: Sender<Asked>,
}

impl PixelTrace {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system grants none.
    pub fn start(open: OpenTree, events: Sender<Event>) -> std::io::Result<Self> {
        let (jobs, receiver) = unbounded();
        let work = move || Thread { open, jobs: receiver, tree: None }.run(&events);
        std::thread::Builder::new().name("specula-lsp-trace".to_owned()).stack_size(16 << 20).spawn(work)?;
        Ok(Self { jobs })
    }

    /// Asks for values. They come as an event; questions that wait are answered together.
    pub fn ask(&self, asked: Asked) {
        let _ = self.jobs.send(asked);
    }
}

struct Tree {
    root: PathBuf,
    headless: Headless,
    mode: String,
}

struct Thread {
    open: OpenTree,
    jobs: Receiver<Asked>,
    tree: Option<Tree>,
}

impl Thread {
    fn run(mut self, events: &Sender<Event>) {
        let mut waiting: Vec<Asked> = Vec::new();
        while let Some(first) = waiting.pop().or_else(|| self.jobs.recv().ok()) {
            let asked = newest(first, self.jobs.try_iter(), &mut waiting);
            let result = catch_panic(|| self.trace(&asked)).unwrap_or_else(|panic| {
                self.tree = None;
                Err(format!("the trace failed: {panic}"))
            });
            if events.send(Event::Traced(Traced { asked, result })).is_err() {
                return;
            }
        }
    }

    fn trace(&mut self, asked: &Asked) -> Result<(Vec<TracedFile>, String), String> {
        if let Some(socket) = &asked.window {
            return window::values(socket, asked);
        }
        let (headless, mode) = self.opened(asked)?;
        let shaders = headless.shaders();
        let mode: Mode = shaders
            .modes
            .iter()
            .find(|of| of.slug == *mode)
            .cloned()
            .ok_or_else(|| format!("the shaders have no mode {mode}"))?;
        let (mut files, mut proof, mut problem) = (Vec::new(), String::new(), None);
        for path in &asked.files {
            let Some(text) = shaders.texts.get(path).cloned() else { continue };
            let wanted = [path.as_str()];
            let request = TraceRequest {
                at: asked.at,
                mode: &mode,
                stage: None,
                invocation: None,
                files: &wanted,
                is_interactive: true,
            };
            match headless.trace(&request) {
                Ok(trace) => match trace.visible() {
                    Some(fragment) => {
                        proof = trace.proof_text(fragment);
                        files.push(TracedFile {
                            path: path.clone(),
                            text,
                            lines: trace.lines(fragment).iter().map(TracedLine::from).collect(),
                        });
                    }
                    None => problem = Some("every fragment is discarded at this pixel".to_owned()),
                },
                Err(error) => problem = Some(text_of(&error)),
            }
        }
        match problem {
            Some(problem) if files.is_empty() => Err(problem),
            _ => Ok((files, proof)),
        }
    }

    /// The tree on the device, as it is on disk. While it has an error, its last good version.
    fn opened(&mut self, asked: &Asked) -> Result<(&mut Headless, String), String> {
        if self.tree.as_ref().is_some_and(|tree| tree.root != asked.root) {
            self.tree = None;
        }
        if self.tree.is_none() {
            let (headless, mode) = (self.open)(Source::disk(&asked.root))?;
            self.tree = Some(Tree { root: asked.root.clone(), headless, mode });
        } else if let Some(tree) = self.tree.as_mut().filter(|_| !asked.changed.is_empty()) {
            tree.headless.update(Change::Paths(asked.changed.clone()));
        }
        let tree = self.tree.as_mut().ok_or_else(|| "there is no tree".to_owned())?;
        Ok((&mut tree.headless, tree.mode.clone()))
    }
}

/// The newest question, with the older ones about the same pixel. Of other pixels, those that a request waits for go to `waiting`.
fn newest(first: Asked, more: impl Iterator<Item = Asked>, waiting: &mut Vec<Asked>) -> Asked {
    more.fold(first, |older, mut newer| {
        let place = |of: &Asked| (of.root.clone(), of.at, of.window.clone());
        if place(&older) == place(&newer) {
            return joined(older, newer);
        }
        if older.root == newer.root {
            newer.changed.extend(older.changed.iter().cloned());
        }
        if !older.requests.is_empty() {
            waiting.push(older);
        }
        newer
    })
}

/// Two questions about the same pixel as one, about the files of both.
fn joined(older: Asked, newer: Asked) -> Asked {
    let files = older.files.into_iter().chain(newer.files).collect();
    let changed = older.changed.into_iter().chain(newer.changed).collect();
    Asked { files, changed, requests: older.requests.into_iter().chain(newer.requests).collect(), ..newer }
}

/// An error in words.
pub fn text_of(error: &HeadlessError) -> String {
    match error {
        HeadlessError::Shaders(diagnostics) => {
            diagnostics.first().map_or_else(|| error.to_string(), Diagnostic::one_line)
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_answered_about_its_own_pixel() {
        let asked = |x: u32, file: &str, request: Option<i32>| Asked {
            at: (x, 0),
            files: [file.into()].into(),
            changed: [file.into()].into(),
            requests: request.into_iter().map(Into::into).collect(),
            ..Asked::default()
        };
        let mut waiting = Vec::new();
        let more = [asked(1, "b", Some(7)), asked(2, "c", None), asked(3, "d", None), asked(3, "e", None)];
        let newest = newest(asked(1, "a", None), more.into_iter(), &mut waiting);
        assert_eq!((newest.at, newest.files.len(), newest.changed.len()), ((3, 0), 2, 5));
        let kept: Vec<_> = waiting.iter().map(|of| (of.at, of.files.len(), of.requests.len())).collect();
        assert_eq!(kept, [((1, 0), 2, 1)]);
    }
}
