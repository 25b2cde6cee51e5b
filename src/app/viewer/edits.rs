//! Shader edits that the window makes: the watched expression, dragged numbers, and values that become defaults in the files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Instant;

use super::Viewer;
use crate::app::state::shaders::edits::{Draft, NO_FOLDER};
use crate::shader::rewrite::{Edit, applied, defaults};
use crate::shader::source::draft::DraftText;
use crate::shader::values::is_default;
use crate::shader::{Change, Expression, ShaderSet, TreePath};
use crate::threads::Message;
use crate::write_back;

impl Viewer {
    /// Tells the worker of another watched expression. It reads the settings.
    pub(super) fn watch_expression(&mut self) {
        let expression = &self.session.settings.expression;
        if self.edits.watched != *expression {
            self.edits.watched = expression.clone();
            self.threads.worker.change(Change::Paths(BTreeSet::new()), Instant::now());
        }
    }

    /// Shows the picture with these numbers in place of those in the file; no edits go back to the file.
    pub(super) fn draft(&mut self, edits: Vec<Edit>) {
        let Some(shaders) = &self.session.shaders else { return };
        let Some(path) = edits.first().map(|edit| edit.path.clone()) else { return self.end_draft() };
        if let Some(restored) = &self.edits.restored {
            return self
                .say(format!("Version {} is shown; go back to the newest one to drag numbers", restored.number));
        }
        let line = edits.first().map_or(0, |edit| edit.line);
        let base = match &self.edits.draft {
            Some(draft) if draft.is_at(&path, line) => Some(draft.base.clone()),
            Some(_) => {
                self.end_draft();
                None
            }
            None => shaders.texts.get(&path).cloned(),
        };
        let Some(base) = base else { return };
        let text = applied(base.as_bytes(), &edits).ok().and_then(|bytes| String::from_utf8(bytes).ok());
        let Some(text) = text else {
            return self.say(format!("{path} has changed; choose the number again"));
        };
        let texts = BTreeMap::from([(path.clone(), DraftText { base: base.clone(), text: text.into() })]);
        let source = self.source.with_draft(texts);
        self.edits.draft = Some(Draft { edits, path: path.clone(), line, base });
        self.threads.worker.read_from(source, BTreeSet::from([path]));
    }

    /// Goes back to the numbers in the file.
    pub(super) fn end_draft(&mut self) {
        if let Some(draft) = self.edits.draft.take() {
            let source = self.source.without_draft();
            self.threads.worker.read_from(source, BTreeSet::from([draft.path]));
        }
    }

    /// Ends the dragging if the file has changed otherwise. Keeps the line of the watched expression. Drops settings whose values have become defaults.
    pub(super) fn follow_edits(&mut self, shaders: &ShaderSet) {
        let is_other = |draft: &Draft| shaders.texts.get(&draft.path).is_none_or(|text| !draft.is_of(text));
        if self.edits.draft.as_ref().is_some_and(is_other) {
            self.end_draft();
        }
        self.follow_restored(shaders);
        let expression = &mut self.session.settings.expression;
        let watched = Expression::parse(&expression.at, expression.evaluation).ok();
        if let Some((of_set, line)) = shaders.watched.as_ref().filter(|(of_set, _)| Some(of_set) == watched.as_ref()) {
            expression.at = Expression { line: *line, ..of_set.clone() }.to_string();
            self.edits.watched.clone_from(expression);
        }
        let settings = &mut self.session.settings.shader;
        self.edits.written.retain(|name, value| {
            let is_written = is_default(shaders, name, value);
            if is_written && settings.get(name) == Some(value) {
                settings.remove(name);
            }
            !is_written
        });
    }

    /// The edits that would make the values of the settings defaults, or that of `only` one name; or why there are none.
    pub(in crate::app) fn edits_of_defaults(&self, only: Option<&str>) -> Result<Vec<Edit>, String> {
        let Some(shaders) = &self.session.shaders else { return Ok(Vec::new()) };
        let display = |path: &TreePath| self.source.display_path(path);
        defaults(shaders, &self.session.settings.shader, only, display)
    }

    /// Whether the tree is a folder on disk, so that its files can be written.
    pub(in crate::app) fn has_folder(&self) -> bool {
        self.source.root().is_some()
    }

    /// Writes edits into the files of the tree, on a thread of its own.
    pub(super) fn write_edits(&mut self, edits: Vec<Edit>) {
        let Some(root) = self.source.root().map(Path::to_owned) else { return self.say(NO_FOLDER) };
        let values = &self.session.settings.shader;
        let names = edits.iter().filter_map(|edit| Some((edit.name.clone(), values.get(&edit.name)?.clone())));
        self.edits.written.extend(names);
        self.threads.wait(move || {
            let written = write_back::write(&root, &edits);
            Some(Message::Written(written.map(|()| told(&edits))))
        });
    }

    /// Takes the result of writing.
    pub(super) fn on_written(&mut self, written: Result<String, String>) {
        self.answer_edits(written.as_ref().map(|_| ()).map_err(String::as_str));
        match written {
            Ok(text) => {
                // The file has the dragged numbers now, so nothing is compiled.
                if self.edits.draft.is_some() {
                    self.versions.keep_draft();
                }
                self.end_draft();
                self.say(text);
            }
            Err(message) => {
                self.edits.written.clear();
                self.say(message);
            }
        }
    }
}

/// Summarizes the written edits in one line.
fn told(edits: &[Edit]) -> String {
    let change = |edit: &Edit| {
        let new = edit.new.trim_start_matches([' ', '=']);
        // A number has no name.
        match edit.name == edit.old() {
            true => format!("{new} for {} in line {}", edit.old(), edit.line),
            false => format!("{} = {new}", edit.name),
        }
    };
    let changes: Vec<String> = edits.iter().map(change).collect();
    let files: BTreeSet<&str> = edits.iter().map(|edit| edit.path.as_str()).collect();
    format!("Wrote {} to {}", changes.join(", "), files.into_iter().collect::<Vec<_>>().join(", "))
}
