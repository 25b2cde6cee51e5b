//! The stages that declare a pass: finds them in the tree, tells which are off, and gives each a debug mode.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::beside::{fragment_of, may_be_beside};
use super::slot::StageSlot;
use super::{Change, Library};
use crate::interface;
use crate::shader::annotation::pass::{MODEL, PassDesc, PassTarget};
use crate::shader::annotation::{self, Encode, Mode};
use crate::shader::compile::include::files_of;
use crate::shader::compile::{StageKind, declares_pass};
use crate::shader::diagnostic::Diagnostic;
use crate::shader::expression;
use crate::shader::glsl::{Line, TokenKind, code, find_word, is_name, lines};
use crate::shader::graph::{FULL_SCREEN, Graph, GraphPass, RenderPhase, missing_passes, read_later};
use crate::shader::source::snapshot::Snapshot;
use crate::shader::source::{SourceError, TreePath};

impl Library {
    /// Adds the stages that declare a pass since `change`, and removes those that no longer do.
    pub(super) fn find_passes(&mut self, change: &Change, snapshot: &Snapshot<'_>) {
        let listed;
        let paths: Box<dyn Iterator<Item = &TreePath>> = match change {
            Change::All => {
                listed = self.source.list();
                Box::new(listed.iter())
            }
            Change::Paths(paths) => Box::new(paths.iter()),
        };
        let is_pass = |path: &TreePath| snapshot.read(path).is_ok_and(|text| declares_pass(&text));
        // A file that cannot be read, or is still empty, is a broken pass, not one that was removed.
        let is_no_pass = |path: &TreePath| match snapshot.read(path) {
            Ok(text) => !text.trim().is_empty() && !declares_pass(&text),
            Err(error) => error == SourceError::Missing,
        };
        let is_seen = |path: &TreePath| !path.as_str().split('/').any(|name| name.starts_with('.'));
        for path in paths.filter(|path| is_seen(path)) {
            if may_be_beside(path) {
                let is_there = snapshot.read(path) != Err(SourceError::Missing);
                let changed = if is_there { self.beside.insert(path.clone()) } else { self.beside.remove(path) };
                self.relink |= changed;
                continue;
            }
            if StageKind::of(path).is_none() {
                continue;
            }
            let place = self.slots.iter().position(|slot| slot.path == *path);
            let is_idle = path.as_str().starts_with("passes/") && snapshot.read(path).is_ok() && is_no_pass(path);
            let changed = if is_idle { self.idle.insert(path.clone()) } else { self.idle.remove(path) };
            self.relink |= changed;
            // A vertex stage belongs to the pass beside it.
            if StageKind::of(path) == Some(StageKind::Vertex) {
                continue;
            }
            match place {
                Some(place) if place >= self.fixed && is_no_pass(path) => {
                    self.slots.remove(place);
                    self.relink = true;
                }
                None if is_pass(path) => self.slots.push(StageSlot::new(path.clone())),
                _ => {}
            }
        }
        self.find_stages_beside(snapshot);
    }

    /// The stages that draw the model in debug modes, in place of the picture's.
    pub(super) fn replacing(&self, snapshot: &Snapshot<'_>) -> BTreeSet<TreePath> {
        let stages = self.slots.iter().skip(self.fixed).map(|slot| &slot.path);
        let replaces = |path: &&TreePath| {
            snapshot.read(path).is_ok_and(|text| text.contains("instead"))
                && annotation::passes_of(snapshot, path).any(|desc| desc.instead.is_some())
        };
        stages.filter(replaces).cloned().collect()
    }

    /// An error for each built-in pass that no stage declares, in a tree that draws pictures.
    pub(super) fn missing_passes(&self, snapshot: &Snapshot<'_>) -> Vec<Diagnostic> {
        if self.slots.iter().take(self.fixed).all(|slot| slot.path.as_str() != FULL_SCREEN) {
            return Vec::new();
        }
        let descs: Vec<PassDesc> =
            self.slots.iter().flat_map(|slot| annotation::passes_of(snapshot, &slot.path)).collect();
        missing_passes(&descs, &snapshot.source().name())
    }

    /// The stages of passes that are off unless the user switches them on, and of passes that only these read.
    pub(super) fn passes_off(&self, snapshot: &Snapshot<'_>) -> BTreeSet<TreePath> {
        let stages = self.slots.iter().skip(self.fixed).map(|slot| &slot.path);
        let texts: Vec<(TreePath, Arc<str>)> = self
            .source
            .list()
            .into_iter()
            .filter(is_text)
            .filter_map(|path| {
                let text = snapshot.read(&path).ok()?;
                Some((fragment_of(&path), text))
            })
            .collect();
        let (mut off, mut on) = (BTreeSet::new(), Vec::new());
        for path in stages.clone().map(fragment_of) {
            for desc in annotation::passes_of(snapshot, &path) {
                let is_switched_off = |name: &String| texts.iter().any(|(_, text)| is_zero(text, name));
                let is_off = !desc.on || desc.to == PassTarget::Peel || desc.when.as_ref().is_some_and(is_switched_off);
                match is_off {
                    true => drop(off.insert(path.clone())),
                    false if desc.to != PassTarget::Image => {}
                    false => on.push((path.clone(), desc.images().map(|(name, _)| name.to_owned()).collect())),
                }
            }
        }
        let read: Vec<(&TreePath, BTreeSet<String>)> =
            texts.iter().map(|(path, text)| (path, read_names(text))).collect();
        // Others may share a buffer with a pass that has one.
        on.retain(|(path, _)| snapshot.read(path).is_ok_and(|text| !text.contains("buffer")));
        loop {
            let is_read = |(own, names): &(TreePath, Vec<String>)| {
                let mut others = read.iter().filter(|(path, _)| *path != own && !off.contains(*path));
                others.any(|(_, read)| names.iter().any(|name| read.contains(name)))
            };
            let (kept, unread): (Vec<_>, Vec<_>) = on.into_iter().partition(is_read);
            on = kept;
            if unread.is_empty() {
                break;
            }
            off.extend(unread.into_iter().map(|(path, _)| path));
        }
        stages.filter(|path| off.contains(&fragment_of(path))).cloned().collect()
    }

    /// A warning for each file in `passes/` that could be a stage, but declares no pass, and that no stage includes.
    pub(super) fn idle_warnings(&self, snapshot: &Snapshot<'_>) -> Vec<Diagnostic> {
        if self.idle.is_empty() {
            return Vec::new();
        }
        let mut used = self.dependencies();
        // Includes of a stage that has not been compiled yet are found in its text.
        let unseen = self.slots.iter().filter(|slot| slot.current.is_none() && slot.good.is_none());
        used.extend(unseen.flat_map(|slot| files_of(snapshot, &slot.path)));
        self.idle.iter().filter(|path| !used.contains(*path)).filter_map(|path| idle(path, snapshot)).collect()
    }
}

/// The warning about a file that nothing draws. `None` for a vertex stage beside a file that has the warning.
fn idle(path: &TreePath, snapshot: &Snapshot<'_>) -> Option<Diagnostic> {
    let name = path.stem().rsplit('/').next().unwrap_or_default();
    let warn = |message: &str| Diagnostic::warning(snapshot.display_path(path), message);
    let options = match StageKind::of(path)? {
        StageKind::Fragment => " to=picture",
        StageKind::Compute => "",
        StageKind::Vertex => {
            let fragment = fragment_of(path);
            let message = format!("nothing draws with this file, since there is no {fragment}");
            let help = format!("write that file, with the line `//@pass {name} draw=model to=picture`");
            return (snapshot.read(&fragment) == Err(SourceError::Missing)).then(|| warn(&message).with_help(help));
        }
        _ => return None,
    };
    let text = snapshot.read(path).ok()?;
    // `// @pass` and `//@Pass` are ordinary comments.
    let spaced = lines(&text).into_iter().find_map(|line| {
        let at = line.raw.find("//")?;
        let comment = line.raw[at + 2..].trim_start();
        let length = comment.get(.."@pass".len()).filter(|word| word.eq_ignore_ascii_case("@pass"))?.len();
        let end = line.raw.len() - comment.len() + length;
        let warning = warn("nothing draws this file: this line is a comment, since it does not begin with `//@pass`");
        let warning = warning.on_line(line.number, Some(line.raw)).under(at..end);
        Some(warning.with_help("write `//@pass`, without a space and in small letters"))
    });
    Some(spaced.unwrap_or_else(|| {
        let help = format!("begin it with the line `//@pass {name}{options}`");
        warn("nothing draws this file, since no line of it says //@pass").with_help(help)
    }))
}

/// Whether a text declares the constant `name` as false or 0, or as another constant that is.
fn is_zero(text: &str, name: &str) -> bool {
    let tokens: Vec<&str> = code(text).into_iter().map(|token| token.text).collect();
    let value = tokens.windows(6).find_map(|six| match *six {
        ["const", _, found, "=", value, ";"] if found == name => Some(value),
        _ => None,
    });
    match value {
        Some("false" | "0" | "0u") => true,
        Some(other) => other != name && is_name(other) && is_zero(text, other),
        None => false,
    }
}

fn is_text(path: &TreePath) -> bool {
    path.extension() == Some("glsl") || StageKind::of(path).is_some()
}

/// The names in the lines of a text that declare uniforms, among them the images that it reads, as they are or as they were one frame ago.
/// Declarations of several lines are missed; a pass that only they read is compiled later than it could be.
fn read_names(text: &str) -> BTreeSet<String> {
    if !text.contains("uniform") {
        return BTreeSet::new();
    }
    let lines = lines(text);
    let declared = lines.iter().filter(|line| line.code.contains("uniform"));
    let words = declared.flat_map(Line::tokens).filter(|token| token.kind == TokenKind::Word).map(|token| token.text);
    words.flat_map(|word| [Some(word), read_later(word)]).flatten().map(str::to_owned).collect()
}

/// The comment behind the output with this name, in a stage that draws several images.
fn doc_of_output(stage: &str, name: &str, snapshot: &Snapshot<'_>) -> String {
    let comment = |text: Arc<str>| {
        let line = lines(&text).into_iter().find(|line| {
            find_word(&line.code, "out").is_some()
                && find_word(&line.code, name).is_some_and(|at| line.code[at.end..].starts_with(';'))
        })?;
        Some(line.raw.split_once("//")?.1.trim().to_owned())
    };
    snapshot.read(&TreePath::from(stage)).ok().and_then(comment).unwrap_or_default()
}

/// A debug mode for each image of a pass.
pub(super) fn modes_of<'a>(graph: &'a Graph, snapshot: &'a Snapshot<'_>) -> impl Iterator<Item = Mode> + 'a {
    let shown = graph.passes.iter().filter(|pass| !pass.desc.is_drawn_with_model() && !pass.desc.is_built_in());
    let images = shown.flat_map(|pass| pass.desc.images().map(move |(name, _)| (pass, name)));
    (interface::PASS_MODES..).zip(images).map(|(id, (pass, name))| match pass.desc.watches {
        Some(_) => mode_of_expression(pass, graph),
        None => mode_of_image(id, pass, name, graph, snapshot),
    })
}

fn stage_of_model(graph: &Graph) -> String {
    graph.pass(MODEL).map(|model| model.desc.stage.clone()).unwrap_or_default()
}

/// The mode that shows the image of the pass which computes the watched expression.
fn mode_of_expression(pass: &GraphPass, graph: &Graph) -> Mode {
    Mode {
        id: expression::MODE_ID,
        slug: expression::MODE.to_owned(),
        name: pass.desc.label.clone(),
        group: "Expression".to_owned(),
        encode: Encode::Data,
        stage: stage_of_model(graph),
        pass: Some(pass.name().to_owned()),
        doc: pass.desc.doc.clone(),
        ..Mode::default()
    }
}

fn mode_of_image(id: u32, pass: &GraphPass, name: &str, graph: &Graph, snapshot: &Snapshot<'_>) -> Mode {
    Mode {
        id,
        slug: format!("pass:{name}"),
        // Further images have no label of their own.
        name: if name == pass.name() { pass.desc.label.clone() } else { format!("{}: {name}", pass.desc.label) },
        group: "Passes".to_owned(),
        components: 3,
        // A pass that changes the picture is shown like the picture.
        is_displayed: pass.phase == RenderPhase::Display,
        tonemap: pass.desc.to_picture() || pass.phase == RenderPhase::Display,
        stage: stage_of_model(graph),
        pass: Some(name.to_owned()),
        doc: if name == pass.name() { pass.desc.doc.clone() } else { doc_of_output(&pass.desc.stage, name, snapshot) },
        file: pass.desc.place.file.clone(),
        line: pass.desc.place.line,
        ..Mode::default()
    }
}
